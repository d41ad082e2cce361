// Points and lines as quads that face the screen. Each has four of the view's vertices:
//
//     0 --- 1        a point: the corners of a square around it
//     |   / |        a line: corners 0 and 1 at its first end, 3 and 2 at its second one
//     | /   |
//     3 --- 2        two triangles, front faces whatever the transform: 0 2 1 and 0 3 2
//
// Sizes are in pixels of the window, so expansion follows the transform; no later pass knows of it but bin, where lines are clipped.
#pragma once

#include "raster/passes/view_geometry.hpp"

namespace halflit::raster {

/// Width of lines or largest side of points in a view, in 1/256 pixel.
[[nodiscard]] inline int size_of(const View& view, Topology topology) {
    return topology == Topology::lines ? view.line_width : topology == Topology::points ? view.point_size : 0;
}

/// Transforms vertices [args.begin, args.end) of a draw of lines or points, and writes their quads to args.screen and args.outcodes: those
/// of the draw's first quad. args.begin: a multiple of kVertexGroup.
void transform_quads(const RasterKernels& kernels, const TransformArgs& args, const Draw& draw, const View& view);

/// Indices of the triangles of kQuadsAtOnce quads, relative to the first of their vertices.
inline constexpr int kQuadsAtOnce = kBinnedAtOnce / 2;
[[nodiscard]] const std::uint32_t* quad_indices();

/// A line cut to the view's near plane and guard band.
struct ClippedLine {
    ScreenVertex corner[4];
    double weight[2];  ///< of the line's second end, at corners 0 and 1, and at 2 and 3
};
/// Returns false if nothing of it is left. clip: clip coordinates of its ends.
bool clip_line(const double (&clip)[2][4], const View& view, ClippedLine& out);

}  // namespace halflit::raster
