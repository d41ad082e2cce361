// The plan of a frame's shading, as plain data that the kernels read. What the scene does not need is not in the plan, and what is not in
// the plan is not computed. planner.hpp makes it.
#pragma once

#include "shading/plan/environment_plan.hpp"
#include "shading/plan/light_plan.hpp"
#include "shading/plan/material_plan.hpp"
#include "shading/plan/shadow_map_plan.hpp"

#include <vector>

namespace halflit::shading {

/// Everything about the frame that shading needs, the same for all fragments.
struct ShadingPlan {
    std::vector<MaterialPlan> materials;  ///< index = index of Scene material; one more at the end for "no material"
    std::vector<LightPlan> lights;        ///< in list order: sums keep it; black lights and those not finite are left out
    std::vector<ShadowMapPlan> shadow_maps;
    std::vector<EnvironmentPlan> environments;  ///< one for each lobe that meets the environment
    ShadowMode shadow_mode = ShadowMode::off;
    bool shadow_offset = false;  ///< shadows are looked up off the position: raster fills the kShadowX.. rows
    SpecularModel specular = SpecularModel::blinn;
    bool normalize_specular = true;
    Ambient ambient;
    Vec3f eye_ws{0, 0, 0};              ///< perspective: camera position
    Vec3f view_direction_ws{0, 0, -1};  ///< orthographic: the way the camera looks, unit
    bool orthographic = false;
    ErrorBound error;
};

}  // namespace halflit::shading
