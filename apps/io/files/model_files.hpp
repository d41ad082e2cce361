// The files that a model refers to.
#pragma once

#include "halflit/error.hpp"
#include "halflit/model.hpp"

#include <string>
#include <vector>

namespace halflit::io {

/// Paths of all files that the model at `path` names, whether or not they exist and are drawn. Reads the model alone; empty if it cannot be
/// read. Errors: limit (time or work of `options`, or no memory), cancelled.
[[nodiscard]] Result<std::vector<std::string>> files_named_by(const std::string& path, const LoadOptions& options);

}  // namespace halflit::io
