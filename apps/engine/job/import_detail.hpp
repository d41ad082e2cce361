// How fine an importer makes triangles for a picture: values of LoadOptions::detail_px.
#pragma once

#include "apps/engine/job/render_job.hpp"

namespace halflit::engine {

/// Before the scene is loaded: of a model that is framed, at its nearest point.
[[nodiscard]] double framed_detail(const ViewRequest& request);

/// That the job's views need of what they show, of a model whose whole box has this diagonal.
[[nodiscard]] double seen_detail(const RenderJob& job, double diagonal);

}  // namespace halflit::engine
