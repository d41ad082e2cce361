// Measures of a scene for people and scripts.
#pragma once

#include "apps/engine/answers/run_report.hpp"

namespace halflit::engine {

/// {"unit", "min", "max", "size", "area", "volume", "center", "triangles", .., "body_list"}: the measures of all that is drawn, in the unit
/// and along the axes of the file, rounded to seven digits, with those of the first 100 bodies. Null where nothing has triangles, and for
/// scenes that draw more than 2^25 triangles by drawing the same meshes again and again. Fails after the time limit.
[[nodiscard]] Result<Json> measures_json(const RenderJob& job);

/// {"size", "area", "volume", "watertight", "open_edges", "exact"} of a part, drawn or not, in the same unit. Null if it has no triangles.
[[nodiscard]] Result<Json> part_measures_json(const RenderJob& job, const Part& part);

/// Corners of a box in the file's coordinates.
struct FileBox {
    Vec3d min, max;
};
/// That of what is drawn: of its surfaces where the file has exact ones and nothing is cut, or else these corners of the drawn world.
[[nodiscard]] FileBox file_box(const RenderJob& job, Vec3d min, Vec3d max);

/// False where measures_json() is null for the number of triangles.
[[nodiscard]] bool parts_are_soon_measured(const RenderJob& job);

}  // namespace halflit::engine
