// Shadow maps of lights that have a size: one for each of a few points of the light.
#pragma once

#include "raster/view/shadow_views.hpp"

namespace halflit::raster {

/// `n` lights without size that stand for a light of LightPlan::shadow_radius. Directional: directions spread evenly over the disc that is
/// seen in the light's direction. Point and spot: points in a ball whose density is that which makes an even disc of it from every side.
[[nodiscard]] std::vector<shading::LightPlan> light_points(const shading::LightPlan& light, int n);

/// plan_shadow_views for all lights. A light with a size gets Settings::soft_shadow_maps maps of half the side, or cascades or cubes of
/// them, chained by ShadowMapPlan::next, and fewer points where the maps do not fit the limit of memory, of which the maps of lights
/// without size leave a half. Sets LightPlan::shadow_points.
[[nodiscard]] Result<ShadowViews> plan_light_shadows(std::vector<shading::LightPlan>& lights, const PreparedData& scene,
                                                     const SeenVolume* seen, const Settings& settings, const ShadowSizes& sizes);

}  // namespace halflit::raster
