// Lines of a model's edges in a picture, seen and hidden.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/settings.hpp"
#include "raster/detail/executor.hpp"
#include "raster/geometry/model_edges.hpp"

#include <cstdint>
#include <vector>

namespace halflit::raster {

/// A part of an edge that is seen, or hidden, from end to end. Window coordinates: pixels, y down, (0, 0) the picture's upper left corner.
struct EdgeLine {
    double x0, y0, x1, y1;  ///< the whole edge, so that a crop rounds as the whole picture does
    double t0, t1;          ///< the part, as shares of the edge's length
    double begin_px;        ///< length of the polyline that the edge continues, up to (x0, y0): the phase of its dashes
    bool hidden;
    bool light;  ///< it lies on dark surfaces
};

/// The triangle that each pixel's middle shows, as Target has it, in a part of a picture.
struct PixelTriangles {
    int width, height;  ///< of the whole picture
    Region region;      ///< the part
    const std::uint32_t *instance, *triangle;
};

/// The part of a picture whose seen triangles decide on the lines in `drawn`.
[[nodiscard]] Region seen_region(const Region& drawn, double edge_width, int width, int height);

/// The lines that touch the pixels of `drawn`. A point of an edge is hidden where a triangle lies before it on the viewer's ray, which is
/// computed in double, nearer by more than 1e-5 of the model's size: lines win over surfaces that they lie on. Such triangles are looked
/// for among those that are seen in the point's pixel and in the eight around, and over the surface from these; so what is less than a
/// pixel wide may hide nothing. The triangles of the edge itself never hide it. Where a line begins to be hidden is found to a sixteenth of
/// a pixel. memory: holds what the lines take of the executor's memory; what finding them takes is held until the call ends.
[[nodiscard]] std::vector<EdgeLine> edge_lines(const ModelEdges& edges, const Camera& camera, const PixelTriangles& seen,
                                               const Region& drawn, const Settings& settings, Executor& executor, MemoryShare& memory);

}  // namespace halflit::raster
