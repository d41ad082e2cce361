// Which shadow maps a frame has, and the views that they are drawn from.
#pragma once

#include "raster/scene/bounds.hpp"
#include "raster/settings.hpp"
#include "raster/view/view.hpp"
#include "shading/plan/light_plan.hpp"
#include "shading/plan/shadow_map_plan.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace halflit::raster {

/// One face of a map: what the light sees there, and how its depths become distances.
struct ShadowView {
    View view;
    bool perspective = false;
    float near_z = 0, far_z = 0;  ///< of its camera
    std::size_t first_texel = 0;  ///< of all maps' texels
    bool sees_scene = true;       ///< otherwise nothing stands in it, and nothing is drawn
    friend bool operator==(const ShadowView&, const ShadowView&) = default;
};

struct ShadowViews {
    std::vector<shading::ShadowMapPlan> maps;  ///< their texels' places are not known yet
    std::vector<std::size_t> first_texel;      ///< of each map
    std::vector<std::int32_t> map_of_light;    ///< for each light: its map, or -1
    std::vector<ShadowView> views;             ///< in the order of the maps; a cube has six
    std::size_t texel_count = 0;
    std::string warning;  ///< what had to be made smaller; empty: nothing
};

/// A map for every light that reaches the scene's bounds: directional maps are fitted to the bounds, spots to their cone, points (and spots
/// beyond 75 degrees) get six faces of half the size. All are halved in size until they fit Settings::shadow_memory_limit.
[[nodiscard]] Result<ShadowViews> plan_shadow_views(std::span<const shading::LightPlan> lights, const Bounds& bounds,
                                                    const Settings& settings);

}  // namespace halflit::raster
