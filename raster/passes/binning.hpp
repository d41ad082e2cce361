// Triangle set-up and the tiles' lists: culling, clipping, and which tiles each triangle touches, in submission order.
#pragma once

#include "raster/passes/executor.hpp"
#include "raster/passes/frame.hpp"

namespace halflit::raster {

void bin_triangles(Frame& frame, Executor& executor);

}  // namespace halflit::raster
