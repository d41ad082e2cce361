// The list of a scene's parts, for people and scripts.
#pragma once

#include "apps/engine/answers/run_report.hpp"

namespace halflit::engine {

/// [{"number", "name", "instances", "triangles", "drawn"}, ..] of all parts, hidden ones too. measured: with "measures", as
/// part_measures_json() has them. Fails after the time limit.
[[nodiscard]] Result<Json> parts_json(const RenderJob& job, bool measured);

/// The same for people: {"count", "1": "NAME, ..", ..}, of the first hundred parts.
[[nodiscard]] Result<Json> parts_text(const RenderJob& job, bool measured);

}  // namespace halflit::engine
