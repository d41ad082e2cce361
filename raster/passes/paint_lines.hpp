// Lines painted over a finished picture.
#pragma once

#include "raster/passes/edge_lines.hpp"
#include "raster/passes/output.hpp"
#include "shading/kernels/shade_kernels.hpp"

#include <span>

namespace halflit::raster {

/// Paints lines with round ends, of Settings::edge_width; hidden ones are thinner, paler and dashed. A pixel's share of a line is
/// by its middle's distance from it, whatever the number of samples; where lines meet, the largest counts, and light ones lie over others.
/// region: the pixels that are written.
void paint_lines(std::span<const EdgeLine> lines, const Settings& settings, const Region& region, const Output& output,
                 const shading::ShadeKernels& shade, Executor& executor);

}  // namespace halflit::raster
