// Views of the visibility stage, before any shading.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/scene.hpp"
#include "halflit/settings.hpp"

#include <cstdint>
#include <vector>

namespace halflit::raster {

/// Triangle and depth of each pixel's first sample; row 0 is the top row.
struct VisibilityView {
    int width = 0, height = 0;
    /// 0: background; i + 1: triangle i in submission order (instances in scene order, their triangles in index order).
    std::vector<std::uint32_t> triangle;
    std::vector<float> depth;  ///< reversed: 1 at the near plane, 0 at the far plane or background
};

[[nodiscard]] Result<VisibilityView> visibility(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height,
                                                const Execution& execution = {});

/// The triangle numbers alone.
[[nodiscard]] Result<std::vector<std::uint32_t>> triangle_ids(const Scene& scene, const Camera& camera, const Settings& settings, int width,
                                                              int height, const Execution& execution = {});

}  // namespace halflit::raster
