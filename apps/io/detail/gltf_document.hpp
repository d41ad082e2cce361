// A glTF file while it is loaded: its parsed JSON, its buffers, and the warnings.
#pragma once

#include "apps/io/detail/gltf_file.hpp"
#include "apps/io/detail/load_failure.hpp"
#include "apps/io/file_access.hpp"
#include "halflit/gltf.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

struct Document {
    const LoadOptions& options;
    ModelFolder folder;
    file::File file;
    std::vector<std::span<const std::byte>> buffers;  ///< byteLength bytes each
    std::vector<std::vector<std::byte>> owned_buffers;
    std::vector<std::string> warnings;
    std::size_t warnings_left_out = 0;
    SceneInfo info;
    Budget geometry, encoded_images;

    Document(const LoadOptions& load_options, const std::string& base_dir)
        : options(load_options), folder(base_dir, load_options.allow_external) {}

    /// Adds a warning; the first hundred different ones are kept.
    void warn(std::string what);
    [[nodiscard]] const std::byte* view_data(int buffer_view) const;  ///< requires: check_buffer_views has run
};

/// Parses, checks and fetches buffers; throws LoadFailure. `bytes` must outlive the document.
std::unique_ptr<Document> open_document(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options);

}  // namespace halflit::io::detail
