// The light of a job: the scene's, the flags', and what the library adds.
#pragma once

#include "apps/engine/job/render_job.hpp"

namespace halflit::engine {

/// Sets the light to begin with, and what the flags say of the rest: RenderJob::film. Settings of the job decide what an environment keeps.
[[nodiscard]] Result<void> begin_light(RenderJob& job, const LightRequest& request);

/// Gives a light the size that the flags say, unless it has one.
void soften(Light& light, const Film& film);

/// Turns the light that was chosen for the viewer, such as the studio, with another camera. The exposure stays. False: there is none.
bool relight(RenderJob& job, const Camera& camera);

/// Moves the file's lights in the job's light to where they are in the scene.
void follow_lights(RenderJob& job);

}  // namespace halflit::engine
