// The planner: makes a ShadingPlan, with all data that the kernels read, from the user's data, the viewer and the shadow maps. It also
// spends an error budget. Only the alpha tests of shadow maps are planned elsewhere (raster/frame_plan.cpp).
#pragma once

#include "halflit/texture.hpp"
#include "shading/budget/error_budget.hpp"
#include "shading/environment.hpp"
#include "shading/plan/environment_plans.hpp"
#include "shading/plan/plan.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace halflit::shading {

/// Point or direction that a picture is seen from.
struct Viewer {
    Vec3f eye_ws{0, 0, 0};              ///< perspective
    Vec3f view_direction_ws{0, 0, -1};  ///< direction that the camera looks in, unit; always set, needed for orthographic cameras
    bool orthographic = false;
};

/// Shadow maps to be drawn, and facts about what casts and receives shadows.
struct ShadowInputs {
    ShadowMode mode = ShadowMode::off;
    bool terminator_offset = false;
    std::vector<ShadowMapPlan> maps;
    std::vector<std::int32_t> map_of_light;  ///< index into `maps` for each of plan_lights(), or -1; empty: no light casts shadows
    std::span<const double> object_radius;   ///< radius of the largest object made of each material, world units
    std::vector<LightPlan> sky;              ///< of sky_lights(), with their maps; empty: no sky shadows
    int sky_directions = 0;                  ///< that they are made for; black ones are left out
    SkyGridPlan sky_grid;                    ///< hides them, in place of maps
    double fade_distance = 0;                ///< distance behind a blocker where wrapped light is gone; 0: from object size and wrap
};

/// Data that planning keeps from frame to frame.
struct PlanMemory {
    EnvironmentPlans environments;
    PowerFits fits;
};

struct PlanInputs {
    std::span<const Material> materials;
    std::span<const Texture> textures;
    /// Attribute slots that the meshes of each material have: of `materials`, of "no material", and of `looks`. The plan leaves out texture
    /// coordinates, colours and tangents that the meshes lack.
    std::span<const SlotMask> available_slots;
    std::vector<LightPlan> lights;  ///< of plan_lights()
    Ambient ambient;
    ShadingSettings options;
    std::shared_ptr<const Environment> environment = nullptr;
    double exposure = 1.0;  ///< display white is 1 / exposure
    ToneCurve tone_curve = ToneCurve::none;
    Viewer viewer = {};
    ShadowInputs shadows = {};
    const SceneFacts* facts = nullptr;         ///< needed for an error budget only
    const std::vector<bool>* drawn = nullptr;  ///< for each planned material, whether an object is made of it; null: all
    ForEachRow for_each_row = in_turn;
    std::span<const Material> looks{};  ///< further materials: those of the scene in the colours of instances
};

/// Fails (usage) for a lobe that check_lobe refuses, and for an error budget with options whose error has no bound. Ranges of single
/// options are raster/settings_table.def's.
[[nodiscard]] Result<void> check_options(const ShadingSettings& options);

[[nodiscard]] ShadingPlan plan_shading(const PlanInputs& inputs, PlanMemory& memory);
[[nodiscard]] ShadingPlan plan_shading(const PlanInputs& inputs);

}  // namespace halflit::shading
