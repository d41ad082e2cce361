// Poses and views of a moving picture's frames. Each depends on the frame's number alone, so that frames may be drawn in any order and by
// any number of processes.
#pragma once

#include "apps/engine/job/render_job.hpp"

namespace halflit::engine {

/// Poses the scene by its animation at a time. Returns what changed. Fails (usage) where the animation sets materials that --kd, --ks or
/// --shininess replaced.
[[nodiscard]] Result<SceneChanges> pose_job(RenderJob& job, double time_s);

/// A view of the whole scene for all frames. Requires: they move, and `bounds` is not empty. A turntable keeps all that turns in view from
/// all sides: what the scene sweeps in its turn around the vertical axis through the centre of `bounds`. Otherwise an animation keeps
/// `bounds` in view.
[[nodiscard]] Camera film_camera(const Scene& scene, const Bounds& bounds, const FilmOptions& film, float aspect, const ViewSettings& view);

/// The camera after a part of a turn around the vertical axis through the centre of `bounds`, in the sense of --azimuth.
[[nodiscard]] Camera turned_camera(const Camera& camera, const Bounds& bounds, std::int64_t frame, int frames_of_turn);

}  // namespace halflit::engine
