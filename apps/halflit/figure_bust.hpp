// A head and shoulders made by code: a form with brow, nose, lips and ears, for figures whose point a sphere does not show.
#pragma once

#include "raster/scene/mesh.hpp"

namespace halflit::cli {

/// Looks along +z, y up; about 3 high and 2.2 wide, the head's middle at the origin. `cell` is the edge of the grid that it is cut from,
/// 0.03 gives 50,000 triangles. Only + - * / and sqrt make it: the same bits on every machine.
[[nodiscard]] raster::Mesh make_bust(double cell = 0.03);

}  // namespace halflit::cli
