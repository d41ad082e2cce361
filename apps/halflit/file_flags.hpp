// Flags of what a file may cost, and of what it may refer to.
#pragma once

#include "apps/halflit/render_options.hpp"

namespace halflit::cli {

/// `options` must outlive what this returns.
[[nodiscard]] FlagGroup untrusted_file_flags(RenderOptions& options);

}  // namespace halflit::cli
