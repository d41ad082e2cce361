// The planes of --section, and what the report says of them.
#pragma once

#include "apps/engine/job/render_job.hpp"

#include <string>

namespace halflit::engine {

/// Cuts the job's scene by the flags' planes, and adds lines of choices and warnings. Nodes of a file are parts.
[[nodiscard]] Result<void> cut_job(RenderJob& job, const ContentRequest& request);

/// Area of a section in square units of the file.
[[nodiscard]] double file_area(const RenderJob& job, const SectionCut& cut);

/// Name of the object that was cut: that of its mesh; may be empty.
[[nodiscard]] const std::string& cut_name(const RenderJob& job, const SectionCut& cut);

}  // namespace halflit::engine
