// Views of what the rasterizer decided before any shading: for tests, tools and curious people.
#pragma once

#include "raster/scene/camera.hpp"
#include "raster/scene/scene.hpp"
#include "raster/settings.hpp"

#include <cstdint>
#include <vector>

namespace halflit::raster {

/// What each pixel's first sample shows, row 0 on top.
struct VisibilityView {
    int width = 0, height = 0;
    std::vector<std::uint32_t>
        triangle;              ///< 0: background; i + 1: triangle i in submission order (instances in order, their triangles in order)
    std::vector<float> depth;  ///< reversed: 1 near, 0 far or background
};

[[nodiscard]] Result<VisibilityView> visibility(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height);

/// The triangle numbers alone.
[[nodiscard]] Result<std::vector<std::uint32_t>> triangle_ids(const Scene& scene, const Camera& camera, const Settings& settings, int width,
                                                              int height);

}  // namespace halflit::raster
