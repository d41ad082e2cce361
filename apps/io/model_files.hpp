// The files that a model refers to.
#pragma once

#include "halflit/error.hpp"
#include "halflit/gltf.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace halflit::io {

/// Paths at which the files may lie that the model at `path` refers to, drawn or not, there or not. Reads the model alone; empty if it
/// cannot be read. Errors: limit (the time of `options`). Throws std::bad_alloc.
[[nodiscard]] Result<std::vector<std::string>> files_named_by(const std::string& path, const LoadOptions& options);
/// The same of a glTF file's content. Throws LoadFailure.
[[nodiscard]] std::vector<std::string> files_of_gltf(std::span<const std::byte> bytes, const std::string& base_dir,
                                                     const LoadOptions& options);

/// The folder of a path, "." for a bare name.
[[nodiscard]] std::string folder_of(const std::string& path);

}  // namespace halflit::io
