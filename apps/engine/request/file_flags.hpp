// Flags of what a file may cost, and of what it may refer to.
#pragma once

#include "apps/engine/request/render_options.hpp"

#include <string>

namespace halflit::engine {

/// --timeout. `seconds` must outlive what this returns.
[[nodiscard]] Flag timeout_flag(double& seconds, std::string help);

/// `options` must outlive what this returns.
[[nodiscard]] FlagGroup untrusted_file_flags(RenderOptions& options);

}  // namespace halflit::engine
