// Description of a scene, as JSON or as text.
#pragma once

#include "apps/engine/job/render_job.hpp"

#include <string>

namespace halflit::engine {

/// Describes the file's contents, what is drawn, and for each material the stages of shading that its plan requires and those that it does
/// without. Text is one indented line for each value, with names escaped (see printable). measure_parts: also measures each part.
[[nodiscard]] Result<std::string> describe_scene(const RenderJob& job, bool json, bool measure_parts);

/// --parts, which sets measure_parts.
[[nodiscard]] Flag parts_flag(bool& measure_parts);

/// The plan's part of that, as text: lights, shadow maps, and the stages of each material.
[[nodiscard]] Result<std::string> describe_plan(const RenderJob& job);

}  // namespace halflit::engine
