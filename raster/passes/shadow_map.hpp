// Shadow maps: the scene's depth as seen from its lights, drawn by the same rasterizer as the picture.
#pragma once

#include "raster/passes/executor.hpp"
#include "raster/passes/frame.hpp"
#include "raster/passes/tile_renderer.hpp"
#include "shading/plan/plan.hpp"
#include "shading/shadow.hpp"

#include <string>
#include <vector>

namespace halflit::raster {

/// Over what distance wrapped light fades in a shadow: d0 = 9/8 * 2 w R for a lobe of wrap w on an object of radius R. Materials without
/// wrap get none.
void set_shadow_fades(Frame& frame);

class ShadowMaps {
public:
    /// Draws a map for every light of `plan` that casts, and enters the maps into the plan. Directional maps are fitted to the
    /// scene, spots to their cone, point lights get six faces. All are halved in size until they fit Settings::shadow_memory_limit.
    /// The maps live until the next call.
    Result<void> draw(const Scene& scene, const Settings& settings, Executor& executor, shading::ShadingPlan& plan);

    /// What the last call had to make smaller; empty when nothing.
    [[nodiscard]] const std::string& warning() const { return warning_; }

private:
    Result<void> draw_face(const Scene& scene, const Camera& camera, int size, bool perspective, const Settings& settings,
                           Executor& executor, float* distance);

    Frame frame_;
    Pool<TileScratch> scratch_;
    RawBuffer<float> texels_;
    std::string warning_;
};

}  // namespace halflit::raster
