// The plan of a frame's shading, as plain data that the kernels read. It holds only what the scene needs, and only what it holds is
// computed. planner.hpp makes it.
#pragma once

#include "shading/plan/environment_plan.hpp"
#include "shading/plan/light_plan.hpp"
#include "shading/plan/material_plan.hpp"
#include "shading/plan/reflection_plan.hpp"
#include "shading/plan/shadow_map_plan.hpp"

#include <vector>

namespace halflit::shading {

/// Everything about the frame that shading needs, the same for all fragments.
struct ShadingPlan {
    std::vector<MaterialPlan> materials;  ///< index = index of Scene material; one more at the end for "no material"
    std::vector<LightPlan> lights;        ///< in list order, which sums keep; black lights and those not finite are left out
    std::vector<ShadowMapPlan> shadow_maps;
    std::vector<EnvironmentPlan> environments;  ///< one for each lobe that the environment is convolved with
    ReflectionPlan reflections;
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
