// The flags that choose parts: --only, --hide, --ghost and --highlight.
#pragma once

#include "apps/halflit/flags/flags.hpp"
#include "apps/halflit/render/render_options.hpp"
#include "halflit/error.hpp"

namespace halflit::cli {

struct RenderJob;

/// `options` must outlive the flags.
[[nodiscard]] FlagGroup part_flags(RenderOptions& options);

/// Finds the parts that the flags name, sets RenderJob::looks and hides instances. A part that several flags name is hidden rather than
/// highlighted, and highlighted rather than a ghost. Fails (usage) for a name that finds no part, and where no part is left.
[[nodiscard]] Result<void> choose_parts(RenderJob& job, const RenderOptions& options);

/// Paints ghosts, highlighted and dimmed parts, caps of sections too. Vertex colours go with the first highlight.
void paint_parts(RenderJob& job, const RenderOptions& options);

}  // namespace halflit::cli
