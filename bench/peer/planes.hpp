// Planes of a view, as a data set has them, and how those of two renderers differ.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/mesh.hpp"
#include "halflit/target.hpp"

#include <cstdint>
#include <vector>

namespace halflit::peer {

/// Values as in Target, row after row: four codes, a depth, a triangle's number, and two weights for each pixel.
struct Planes {
    int width = 0, height = 0;  ///< pixels
    std::vector<std::uint8_t> rgba8;
    std::vector<float> depth;
    std::vector<std::uint32_t> triangle;
    std::vector<float> barycentric;

    [[nodiscard]] static Planes make(int width, int height);
    [[nodiscard]] Target target();
};

/// Distance of points up to which they count as the same, pixels. With several samples they are points of different places in the pixel.
[[nodiscard]] constexpr double point_tolerance(int samples) { return samples == 1 ? 1.0 / 32 : 0.5; }

/// Pixels that differ. Inner ones show the same triangle as the eight pixels around them, in both renderers; the others are edges.
struct Differing {
    std::int64_t all = 0, inner = 0;
};

/// Differences over some views, of pixels where a renderer shows something. Depths and points are compared where both show one triangle.
struct PlanesDifference {
    std::int64_t pixels = 0;
    Differing triangles;
    Differing depths;  ///< by more than a ten-thousandth
    Differing points;  ///< the points that the weights name, seen in the picture, are further apart than the tolerance

    /// Adds a view of a mesh in world space. point_tolerance: pixels.
    void add(const Planes& a, const Planes& b, const Mesh& mesh, const Camera& camera, double point_tolerance);
};

}  // namespace halflit::peer
