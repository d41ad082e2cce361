// The vertex side of a frame: what is drawn, transformed vertices, and vertex records for shading.
#pragma once

#include "raster/passes/executor.hpp"
#include "raster/passes/frame.hpp"

namespace halflit::raster {

/// Draw list, frame plan and viewport. Fails on broken scenes (an index out of range) and on limits.
Result<void> prepare_frame(Frame& frame, const Scene& scene, const Camera& camera, const Settings& settings, const FramebufferView& target);

/// Screen positions and outcodes of all vertices.
void transform_vertices(Frame& frame, Executor& executor);

/// Vertex records of the groups that binning marked as used.
void make_vertex_records(Frame& frame, Executor& executor);

/// Records of vertices that clipping made, from those of their triangles.
void make_clip_records(Frame& frame, Executor& executor);

}  // namespace halflit::raster
