// Lines for people about what was chosen for a job.
#pragma once

#include "apps/engine/job/render_job.hpp"

namespace halflit::engine {

/// Adds lines of camera, lights, exposure and background. given: the flags as they were given.
void tell_choices(RenderJob& job, const RenderOptions& given);

/// Warns of what a view of the whole leaves out. Grounds are not named: they are seen to be cut off.
void warn_of_left_out(RenderJob& job);

}  // namespace halflit::engine
