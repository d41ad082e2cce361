// A scene in words and numbers.
#pragma once

#include "apps/halflit/render_job.hpp"
#include "apps/halflit/run_report.hpp"

#include <string>

namespace halflit::cli {

/// What the file holds, what the scene draws, and for each material the stages of its plan: those it requires and those it does without.
[[nodiscard]] Result<Json> describe_scene(const RenderJob& job);

/// The same for people: indented lines. Names are escaped (see printable).
[[nodiscard]] std::string description_text(const Json& description);

}  // namespace halflit::cli
