// The one way to a ShadingPlan: from what users give, the viewer and the shadow maps to all that the kernels read, an error budget
// included.
#pragma once

#include "shading/budget/error_budget.hpp"
#include "shading/environment.hpp"
#include "shading/plan/environment_plans.hpp"
#include "shading/plan/plan.hpp"
#include "shading/texture.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace halflit::shading {

/// Where pictures are seen from.
struct Viewer {
    Vec3f eye_ws{0, 0, 0};              ///< perspective
    Vec3f view_direction_ws{0, 0, -1};  ///< orthographic, and for whoever asks: the way the camera looks, unit
    bool orthographic = false;
};

/// The shadow maps that are to be drawn, and what is known of those that cast and receive.
struct ShadowInputs {
    ShadowMode mode = ShadowMode::off;
    bool terminator_offset = false;
    std::vector<ShadowMapPlan> maps;
    std::vector<std::int32_t> map_of_light;  ///< for each of plan_lights(): index into `maps`, or -1; empty: none casts
    std::span<const double> object_radius;   ///< for each material: of the largest object made of it, world units
    double fade_distance = 0;                ///< where wrapped light is gone behind a blocker; 0: from object size and wrap
};

/// What planning keeps from frame to frame.
struct PlanMemory {
    EnvironmentPlans environments;
    PowerFits fits;
};

struct PlanInputs {
    std::span<const Material> materials;
    std::span<const Texture> textures;
    /// materials.size() + 1 entries, the last for "no material": the vertex data that the meshes of each bring. What they do not bring
    /// (texture coordinates, colours, tangents) is planned without.
    std::span<const SlotMask> available_slots;
    std::span<const Light> lights;
    Ambient ambient;
    PlanOptions options;
    std::shared_ptr<const Environment> environment = nullptr;
    double exposure = 1.0;  ///< display white is 1 / exposure
    Viewer viewer = {};
    ShadowInputs shadows = {};
    const SceneFacts* facts = nullptr;  ///< needed by an error budget, and by nothing else
};

/// Fails, as usage, for options that exclude each other: a budget without facts, or one of an error that has no bound.
[[nodiscard]] Result<void> check_options(const PlanOptions& options);

[[nodiscard]] ShadingPlan plan_shading(const PlanInputs& inputs, PlanMemory& memory);
[[nodiscard]] ShadingPlan plan_shading(const PlanInputs& inputs);

}  // namespace halflit::shading
