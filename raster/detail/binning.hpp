// Triangle set-up and the tiles' lists: culling, clipping, and which tiles each triangle touches, in submission order.
#pragma once

#include "raster/detail/executor.hpp"
#include "raster/detail/frame.hpp"

namespace halflit::raster {

void bin_triangles(Frame& frame, Executor& executor);

}  // namespace halflit::raster
