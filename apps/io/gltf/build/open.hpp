// The way from a file's bytes to a document whose buffers are there.
#pragma once

#include "apps/io/gltf/file/document.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace halflit::io::detail {

/// Sets the geometry that the file may have, by its size and that of the buffers read so far.
/// Compressed bytes count twice: they hold as much as several others, and their decoded form is in memory too.
void set_geometry_limit(Document& document);

/// Parses the text; throws LoadFailure. `bytes` must outlive the document.
std::unique_ptr<Document> open_document(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options);

/// Refuses the file for the first fault of an element that the drawn nodes use, and warns of all else that was noted.
/// parents: of all nodes, -1 for none.
void settle(Document& document, std::span<const int> drawn_nodes, std::span<const int> parents);

/// Fetches the buffers that are used, checks the bufferViews, and decodes what is compressed. Throws LoadFailure.
void load_buffers(Document& document);

}  // namespace halflit::io::detail
