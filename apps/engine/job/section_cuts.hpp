// What reports say of the planes of --section.
#pragma once

#include "apps/engine/job/render_job.hpp"

#include <string>

namespace halflit::engine {

/// Area of a section in square units of the file.
[[nodiscard]] double file_area(const RenderJob& job, const SectionCut& cut);

/// Name of the object that was cut: that of its mesh; may be empty.
[[nodiscard]] const std::string& cut_name(const RenderJob& job, const SectionCut& cut);

}  // namespace halflit::engine
