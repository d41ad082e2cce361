// The files that a model refers to.
#pragma once

#include "halflit/gltf.hpp"

#include <string>
#include <vector>

namespace halflit::io {

/// Paths at which the files may lie that the model at `path` refers to, drawn or not, there or not. Reads the model alone; empty if it
/// cannot be read. Throws std::bad_alloc.
[[nodiscard]] std::vector<std::string> files_named_by(const std::string& path, const LoadOptions& options);

}  // namespace halflit::io
