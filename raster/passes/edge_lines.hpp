// Lines of a model's edges in a picture, seen and hidden.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/settings.hpp"
#include "raster/detail/executor.hpp"
#include "raster/scene/model_edges.hpp"

#include <cstdint>
#include <vector>

namespace halflit::raster {

/// A part of an edge that is seen, or hidden, from end to end. Window coordinates: pixels, y down, (0, 0) the picture's upper left corner.
struct EdgeLine {
    double x0, y0, x1, y1;
    double begin_px;  ///< length of the polyline that the edge continues, up to (x0, y0): the phase of its dashes
    bool hidden;
};

/// What each pixel's middle shows, of the whole picture, as Target has it.
struct SeenTriangles {
    int width, height;
    const std::uint32_t *instance, *triangle;
};

/// The lines of a view. A point of an edge is hidden where a triangle lies before it on the viewer's ray, which is computed in double,
/// nearer by more than 1e-5 of the model's size: lines win over surfaces that they lie on. Such triangles are looked for among those that
/// are seen in the point's pixel and in the eight around, and over the surface from these; so what is less than a pixel wide may hide
/// nothing. The triangles of the edge itself never hide it. Where a line begins to be hidden is found to a sixteenth of a pixel.
[[nodiscard]] std::vector<EdgeLine> edge_lines(const ModelEdges& edges, const Camera& camera, const SeenTriangles& seen, EdgeChoice choice,
                                               bool hidden_too, Executor& executor);

}  // namespace halflit::raster
