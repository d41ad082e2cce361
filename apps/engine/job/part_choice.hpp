// The parts that --only, --hide, --ghost and --highlight choose.
#pragma once

#include "apps/engine/request/render_options.hpp"
#include "halflit/error.hpp"

namespace halflit::engine {

struct RenderJob;

/// Finds the parts that the flags name, sets RenderJob::looks and hides instances. A part that several flags name is hidden rather than
/// highlighted, and highlighted rather than a ghost. Fails (usage) for a name that finds no part, and where no part is left.
[[nodiscard]] Result<void> choose_parts(RenderJob& job, const PartFlags& flags);

/// Paints ghosts, highlighted and dimmed parts, caps of sections too. Vertex colours go with the first highlight.
void paint_parts(RenderJob& job, const PartFlags& flags);

}  // namespace halflit::engine
