#include "shading/planner.hpp"

#include "sh/power.hpp"
#include "sh/time_limit.hpp"
#include "shading/model/numbers.hpp"
#include "shading/model/scalar.hpp"
#include "shading/model/tone.hpp"

#include <algorithm>

namespace halflit::shading {
namespace {

/// Plans the distinct lobes of a frame, each convolved once.
class EnvironmentPlanner {
public:
    EnvironmentPlanner(EnvironmentPlans& known, const EnvironmentOrder& order, std::vector<EnvironmentPlan>& plans)
        : known_(known), order_(order), plans_(plans) {}

    int diffuse(const LobePlan& lobe, bool split_shadows) {
        EnvironmentOrder order = order_;
        order.split_shadows = split_shadows && lobe.wrap > 0.0f;
        return find({lobe.wrap, static_cast<double>(lobe.power_minus_one) + 1.0, lobe.scale}, order);
    }

private:
    int find(const sh::WrapLobe& lobe, const EnvironmentOrder& order) {
        const auto planned = std::find(lobes_.begin(), lobes_.end(), lobe);
        if (planned != lobes_.end()) return static_cast<int>(planned - lobes_.begin());
        lobes_.push_back(lobe);
        plans_.push_back(known_.plan(lobe, order));
        return static_cast<int>(lobes_.size()) - 1;
    }

    EnvironmentPlans& known_;
    EnvironmentOrder order_;
    std::vector<EnvironmentPlan>& plans_;
    std::vector<sh::WrapLobe> lobes_;
};

/// Reflections of surfaces that mirror no more than this, seen straight on, are taken by one lobe.
constexpr float kFaintReflectance = 0.2f;

/// budget_codes: 0: none, the environment is as exact as without one.
void plan_environments(const PlanInputs& inputs, double budget_codes, PlanMemory& memory, ShadingPlan& plan) {
    if (inputs.environment == nullptr) return;
    plan.environments.clear();
    EnvironmentOrder order;
    order.fixed = inputs.options.environment_bands;
    order.tolerance = inputs.options.environment_tolerance;
    order.exposure = inputs.exposure;
    order.codes = budget_codes * (plan.lights.empty() ? kBudgetShares.environment_alone : kBudgetShares.environment);
    if (order.codes > 0.0) order.costs = CodeCosts(tone_growth(inputs.tone_curve));
    memory.environments.use(inputs.environment);
    const bool split_shadows = inputs.shadows.mode == ShadowMode::soft_split && !plan.shadow_maps.empty();
    EnvironmentPlanner planner(memory.environments, order, plan.environments);
    for (MaterialPlan& material : plan.materials) {
        if ((material.stages & kStageAmbient) == 0) continue;
        check_time();
        material.stages |= kStageEnvironment;
        material.environment = planner.diffuse(material.lobe, split_shadows);
    }
    for (std::size_t i = 0; i < plan.materials.size(); ++i) {
        MaterialPlan& material = plan.materials[i];
        if ((material.stages & kStageEnvironment) == 0 || (material.stages & kStageSpecular) == 0) continue;
        if (!roughness_varies(material)) material.mirror = mirror_row(std::max(material.roughness, kMinRoughness));
        material.reflection_lobes = material.metallic > 0.0f || material.dielectric > kFaintReflectance ? 2 : 1;
        if (plan.reflections.rgba == nullptr && (inputs.drawn == nullptr || (*inputs.drawn)[i]))
            plan.reflections = memory.environments.reflections(inputs.for_each_row);
    }
}

/// Light from all directions that the grid has.
void plan_sky_grid(ShadingPlan& plan) {
    double all = 0.0, total[kGridTerms] = {};
    for (const LightPlan& light : plan.sky) {
        const double to_light[3] = {light.to_light[0], light.to_light[1], light.to_light[2]};
        add_grid_light(double{light.brightness}, to_light, total);
        all += double{light.brightness};
    }
    for (int k = 0; k < kGridTerms; ++k) plan.sky_grid.total[k] = static_cast<float>(total[k]);
    plan.sky_grid.least_total = std::max(static_cast<float>(kLeastGridTotal * all), 1e-30f);
}

/// Plans shadows, and the distance over which wrapped light fades in them: d0 = 9/8 * 2 w R for a lobe of wrap w on an object of radius R.
/// Materials without wrap get none.
void plan_shadows(const ShadowInputs& shadows, ShadingPlan& plan) {
    plan.shadow_maps = shadows.maps;
    plan.sky = shadows.sky;
    if (!plan.sky.empty()) plan.sky_focus = narrowest_sky_focus(shadows.sky_directions);
    plan.sky_grid = shadows.sky_grid;
    if (plan.sky_grid.hidden != nullptr) plan_sky_grid(plan);
    for (std::size_t i = 0; i < std::min(plan.lights.size(), shadows.map_of_light.size()); ++i)
        plan.lights[i].shadow_map = shadows.map_of_light[i];
    plan.shadow_mode = plan.shadow_maps.empty() ? ShadowMode::off : shadows.mode;
    plan.shadow_offset = plan.shadow_mode != ShadowMode::off && shadows.terminator_offset;
    if (plan.shadow_mode != ShadowMode::soft_split) return;
    constexpr double kOwn = kOwnThickness;
    for (std::size_t i = 0; i < plan.materials.size(); ++i) {
        MaterialPlan& material = plan.materials[i];
        const double wrap = material.lobe.wrap, radius = i < shadows.object_radius.size() ? shadows.object_radius[i] : 0.0;
        if (!(wrap > 0.0)) continue;
        const double fade = shadows.fade_distance > 0.0 ? shadows.fade_distance : 2.0 / kOwn * wrap * radius;
        material.shadow_fade_scale = fade > 1e-30 ? static_cast<float>(1.0 / fade) : 0.0f;
        material.shadow_turn_scale = static_cast<float>(kOwn / wrap);
    }
}

/// Lets the highlights of materials without a texture of roughness be curves, where that is as good as exact.
void plan_highlights(ShadingPlan& plan, PowerFits& fits) {
    for (MaterialPlan& material : plan.materials) {
        check_time();
        if (const SpecularFit* const fit = exact_highlight(plan, material, fits)) material.specular_curve = fit->curve;
    }
}

/// Spends an error budget.
void spend_budget(const PlanInputs& inputs, PlanMemory& memory, ShadingPlan& plan) {
    const double budget = inputs.options.max_error_codes;
    const CodeCosts costs(tone_growth(inputs.tone_curve));
    const ShadingPlan before = plan;
    SceneFacts facts = *inputs.facts;
    facts.read_texels = !plan.lights.empty() && texels_of(plan, facts) <= facts.worth_texels;
    const double surfaces = surfaces_in_a_pixel(plan, facts);
    if (surfaces > 0.0) plan_environments(inputs, budget / surfaces, memory, plan);
    if (surfaces > 0.0 && spend_error_budget(plan, budget, costs, inputs.exposure, facts, memory.fits)) return;
    plan = before;
    plan_environments(inputs, 0.0, memory, plan);
    plan_highlights(plan, memory.fits);
    plan.error = {};
    plan.error.budget = budget;
    plan.error.tone_growth = costs.growth();
}

}  // namespace

Result<void> check_options(const ShadingSettings& options) {
    if (options.lobe)
        if (const auto lobe = check_lobe(*options.lobe); !lobe) return fail(ErrorCode::usage, "lobe: " + lobe.error().message);
    if (options.max_error_codes == 0.0) return {};
    if (options.accuracy != Accuracy::exact)
        return fail(ErrorCode::usage, "max-error: cannot be combined with an accuracy other than exact");
    if (options.rate != ShadingRate::pixel)
        return fail(ErrorCode::usage, "max-error: expected shading pixel; the error of other rates has no bound");
    if (options.texture_detail != TextureDetail::full)
        return fail(ErrorCode::usage, "max-error: expected texture-filter full; the error of other filters has no bound");
    return {};
}

ShadingPlan plan_shading(const PlanInputs& inputs, PlanMemory& memory) {
    const std::size_t count = inputs.materials.size();
    HALFLIT_ASSERT(inputs.available_slots.size() == count + 1 + inputs.looks.size());
    const ShadingSettings& options = inputs.options;
    ShadingPlan plan;
    plan.lights = inputs.lights;
    plan.ambient = inputs.ambient;
    plan.specular = options.specular;
    plan.normalize_specular = options.normalize_specular;
    plan.eye_ws = inputs.viewer.eye_ws;
    plan.view_direction_ws = inputs.viewer.view_direction_ws;
    plan.orthographic = inputs.viewer.orthographic;

    const bool ambient = inputs.environment != nullptr || !zero(inputs.ambient.sky_linear) || !zero(inputs.ambient.ground_linear);
    const LightKinds kinds{!plan.lights.empty(), ambient, options.specular != SpecularModel::none};
    const Material no_material;
    plan.materials.reserve(inputs.available_slots.size());
    for (std::size_t i = 0; i < inputs.available_slots.size(); ++i)
        plan.materials.push_back(plan_material(i < count    ? inputs.materials[i]
                                               : i == count ? no_material
                                                            : inputs.looks[i - count - 1],
                                               inputs.textures, inputs.available_slots[i], kinds, options));
    plan_shadows(inputs.shadows, plan);
    HALFLIT_ASSERT((options.max_error_codes > 0.0) == (inputs.facts != nullptr));
    if (inputs.facts != nullptr) {
        spend_budget(inputs, memory, plan);
        return plan;
    }
    plan_environments(inputs, 0.0, memory, plan);
    if (options.accuracy == Accuracy::exact) plan_highlights(plan, memory.fits);
    return plan;
}

ShadingPlan plan_shading(const PlanInputs& inputs) {
    PlanMemory memory;
    return plan_shading(inputs, memory);
}

}  // namespace halflit::shading
