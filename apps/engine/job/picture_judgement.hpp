// Judgements and warnings about a picture that was drawn.
#pragma once

#include "apps/engine/job/render_job.hpp"
#include "halflit/image.hpp"
#include "halflit/report.hpp"

namespace halflit::engine {

/// No fragment was drawn, or all pixels have the same colour, within two codes: the background's.
[[nodiscard]] bool is_blank(const Image& image, const RenderReport& rendered);

}  // namespace halflit::engine
