// The report of `halflit look`: cameras, and what each view shows of each part.
#pragma once

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/look/certificate.hpp"
#include "apps/engine/look/look_sheet.hpp"

#include <span>

namespace halflit::engine {

/// The keys of docs/answers/look.txt. measures: of measures_json().
[[nodiscard]] Json look_json(const RenderJob& job, const Json& measures, std::span<const ViewShot> shots,
                             std::span<const ViewContent> contents);

/// {"pixels", "directions", "complete", counts of triangles by status, parts, lists of triangles that are not seen}: of the schema too.
[[nodiscard]] Json certificate_json(const RenderJob& job, const Certificate& certificate);

/// "Duck.glb: 166 x 154 x 115 mm, 4212 triangles, 1 body, watertight".
[[nodiscard]] std::string look_footer(const RenderJob& job, const Json& measures);

}  // namespace halflit::engine
