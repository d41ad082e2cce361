// Judgements and warnings about a picture that was drawn.
#pragma once

#include "apps/engine/job/render_job.hpp"
#include "halflit/image.hpp"
#include "halflit/report.hpp"

namespace halflit::engine {

/// No fragment was drawn, or all pixels have the same colour, within two codes: the background's.
[[nodiscard]] bool is_blank(const Image& image, const RenderReport& rendered);

/// Adds a warning to the job if the budget of --max-error is not kept.
void warn_of_budget(RenderJob& job, const ErrorBound& error);

}  // namespace halflit::engine
