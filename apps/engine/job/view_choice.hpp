// Cameras that the flags place.
#pragma once

#include "apps/engine/job/render_job.hpp"

namespace halflit::engine {

/// Perspective camera at a place, as of look_at(), whose near plane the box of the scene decides.
[[nodiscard]] Camera placed_camera(const Mat4& world_from_camera, float fov_y_deg, const Bounds& bounds);

/// The views' sides. Names are relative to the scene's front.
[[nodiscard]] std::vector<ViewSettings> given_sides(const SceneSource& source, const ViewRequest& request,
                                                    const std::vector<GivenView>& views);

}  // namespace halflit::engine
