// The view of a job: the camera that the flags place or choose, or what the library is asked for.
#pragma once

#include "apps/engine/job/render_job.hpp"

namespace halflit::engine {

/// Perspective camera at a place, whose near plane the box of the scene decides.
[[nodiscard]] Camera placed_camera(const Mat4& world_from_camera, float fov_y_deg, const Bounds& bounds);

/// Perspective camera at `eye` that looks at `target`, with +y up.
[[nodiscard]] Camera placed_camera(Vec3f eye, Vec3f target, float fov_y_deg, const Bounds& bounds);

/// The views' sides. Names are relative to the scene's front.
[[nodiscard]] std::vector<ViewSettings> given_sides(const SceneSource& source, const ViewRequest& request,
                                                    const std::vector<GivenView>& views);

/// The view that the flags ask for, and the light that was begun. Sets the views and bounds of RenderJob::film. frame: a view of the whole
/// scene or of its parts is asked for.
[[nodiscard]] Result<PictureRequest> picture_request(RenderJob& job, const ViewRequest& request, const FilmOptions& film, bool frame);

/// Keeps what was chosen for people to read, and warns where the usual side shows nothing.
void tell_view(RenderJob& job, const ViewSettings& drawn, ViewReason reason);

}  // namespace halflit::engine
