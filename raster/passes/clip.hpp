// Clipping in homogeneous coordinates, for the few triangles that cross the near plane or leave the guard band.
#pragma once

#include "raster/kernels/raster_kernels.hpp"

namespace halflit::raster {

/// A corner of a clipped polygon.
struct PolygonVertex {
    double clip[4];
    double weight[3];  ///< barycentric weights of the triangle's three vertices
    int corner;        ///< 0..2: untouched vertex of the triangle; -1: made by clipping
};

inline constexpr int kMaxPolygon = 3 + 5;

/// Clips a triangle against the near plane and the guard band, as `codes` (the union of its outcodes) asks for. Returns the number of
/// corners, 0 or 3..kMaxPolygon. A new corner depends only on its edge, which is always taken from the inside to the outside. So triangles
/// that share an edge share the corner.
int clip_triangle(const float (&clip)[3][4], unsigned codes, const Viewport& viewport, PolygonVertex (&polygon)[kMaxPolygon]);

/// Window mapping and snapping of a clipped corner, as in the vertex kernel, but in double.
[[nodiscard]] ScreenVertex project(const double (&clip)[4], const Viewport& viewport);

}  // namespace halflit::raster
