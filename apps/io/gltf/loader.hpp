// The reader of glTF among those of all formats.
#pragma once

#include "halflit/model.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace halflit::io::detail {

/// These throw LoadFailure.
[[nodiscard]] LoadedScene read_gltf(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options);
/// What an importer made: the same without other files, with SceneInfo::exact if it tells that.
[[nodiscard]] LoadedScene read_imported(std::span<const std::byte> bytes, const LoadOptions& options);
/// Paths of all files that the model names, whether or not they exist and are drawn.
[[nodiscard]] std::vector<std::string> files_of_gltf(std::span<const std::byte> bytes, const std::string& base_dir,
                                                     const LoadOptions& options);

}  // namespace halflit::io::detail
