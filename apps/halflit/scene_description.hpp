// Description of a scene, as JSON and as text.
#pragma once

#include "apps/halflit/render_job.hpp"
#include "apps/halflit/run_report.hpp"

#include <string>

namespace halflit::cli {

/// Describes the file's contents, what is drawn, and for each material the stages of shading that its plan requires and those that it does
/// without.
[[nodiscard]] Result<Json> describe_scene(const RenderJob& job);

/// The same as indented lines of text. Names are escaped (see printable).
[[nodiscard]] std::string description_text(const Json& description);

}  // namespace halflit::cli
