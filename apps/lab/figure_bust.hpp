// A bust (head and shoulders) made by code: a shape with brow, nose, lips and ears, for figures that a sphere is too simple for.
#pragma once

#include "halflit/mesh.hpp"

namespace halflit::cli {

/// Faces +z, y up; about 3 high and 2.2 wide, the middle of the head at the origin. `cell` is the edge length of the grid cells; 0.03 gives
/// 50,000 triangles. Computed by + - * / and sqrt alone: the same bits on every machine.
[[nodiscard]] Mesh make_bust(double cell = 0.03);

}  // namespace halflit::cli
