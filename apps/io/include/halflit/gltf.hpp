// Loader of glTF 2.0 alone: .gltf and .glb files. load_model() reads them too, by their content, and other formats.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/model.hpp"

#include <cstddef>
#include <span>
#include <string>

namespace halflit {

/// Loads the model at `path`; files that it refers to are read from its folder. Error messages begin with `path`. Thread-safe.
[[nodiscard]] HALFLIT_API Result<LoadedScene> load_gltf(const std::string& path, const LoadOptions& options = {});

/// Loads a model from memory, e.g. from standard input. `name` is for messages; an empty `base_dir` means that no other file is read.
[[nodiscard]] HALFLIT_API Result<LoadedScene> load_gltf_bytes(std::span<const std::byte> bytes, const std::string& name,
                                                              const std::string& base_dir, const LoadOptions& options = {});

}  // namespace halflit
