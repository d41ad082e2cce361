// The plan of a frame's shading, as plain data that the kernels read. It holds only what the scene needs, and only what it holds is
// computed. planner.hpp makes it.
#pragma once

#include "shading/plan/behind_plan.hpp"
#include "shading/plan/environment_plan.hpp"
#include "shading/plan/light_plan.hpp"
#include "shading/plan/material_plan.hpp"
#include "shading/plan/reflection_plan.hpp"
#include "shading/plan/shadow_map_plan.hpp"
#include "shading/plan/sky_grid_plan.hpp"

#include <vector>

namespace halflit::shading {

/// A reflection is seen as much as the lights of ShadingPlan::sky about the mirrored direction are, weighted by max(0, cosine - c)^2 with
/// c = min(sky_focus, 1 - kSkyFocusByAlpha roughness^2): about four lights or more.
constexpr float narrowest_sky_focus(int directions) { return 1.0f - 8.0f / static_cast<float>(directions); }
inline constexpr float kSkyFocusByAlpha = 1.5f;

/// Everything about the frame that shading needs, the same for all fragments.
struct ShadingPlan {
    std::vector<MaterialPlan> materials;  ///< those of the scene, "no material", and PlanInputs::looks
    std::vector<LightPlan> lights;        ///< in list order, which sums keep; black lights and those not finite are left out
    std::vector<ShadowMapPlan> shadow_maps;
    std::vector<LightPlan> sky;                 ///< what sky shadows take the surroundings for (sky_lights.hpp); empty: there are none
    float sky_focus = 0;                        ///< narrowest_sky_focus() of their number
    SkyGridPlan sky_grid;                       ///< hides them, in place of maps
    std::vector<EnvironmentPlan> environments;  ///< one for each lobe that the environment is convolved with
    ReflectionPlan reflections;
    BehindPlan behind;  ///< set by the renderer when it is drawn, if some material is looked through
    ShadowMode shadow_mode = ShadowMode::off;
    bool shadow_offset = false;  ///< shadows are looked up at an offset from the position: raster fills the kShadowX.. rows
    SpecularModel specular = SpecularModel::blinn;
    bool normalize_specular = true;
    Ambient ambient;
    Vec3f eye_ws{0, 0, 0};              ///< perspective: camera position
    Vec3f view_direction_ws{0, 0, -1};  ///< orthographic: the way the camera looks, unit
    bool orthographic = false;
    ErrorBound error;
};

}  // namespace halflit::shading
