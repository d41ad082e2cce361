#include "shading/plan/plan.hpp"

#include "sh/power.hpp"
#include "sh/trig.hpp"
#include "shading/environment.hpp"

#include <algorithm>
#include <bit>

namespace halflit::shading {
namespace {

constexpr SlotMask slot(int index) { return 1u << index; }
constexpr SlotMask kNormalAndUv0Slots = slot(0) | slot(1), kTangentSlot = slot(2), kColorSlot = slot(3);

bool finite(float x) { return x - x == 0.0f; }
bool finite(Vec3f v) { return finite(v.x) && finite(v.y) && finite(v.z); }
bool zero(Vec3f v) { return v == Vec3f{0, 0, 0}; }

/// max(lo, min(x, hi)); NaN gives lo.
float clamp_or_low(float x, float lo, float hi) { return x > lo ? (x < hi ? x : hi) : lo; }

// ---- textures ------------------------------------------------------------------------------------------------------

TexturePlan plan_texture(const TextureUse& use, std::span<const Texture> textures, SlotMask available, TextureDetail detail) {
    TexturePlan plan{};
    if (use.texture < 0 || static_cast<std::size_t>(use.texture) >= textures.size()) return plan;
    const Texture& texture = textures[static_cast<std::size_t>(use.texture)];
    if (texture.levels().empty()) return plan;
    plan.data = texture.data().data();
    plan.range = &texture.range();
    plan.level_count = static_cast<std::int32_t>(texture.levels().size());
    for (std::size_t l = 0; l < texture.levels().size(); ++l) {
        plan.width[l] = texture.levels()[l].width;
        plan.height[l] = texture.levels()[l].height;
        plan.offset[l] = texture.levels()[l].offset;
    }
    plan.uv_set = use.uv_set == 1 ? 1 : 0;
    Vec3f row_u = use.row_u, row_v = use.row_v;
    if (plan.uv_set == 1 && (available & slot(4)) == 0) {
        // No primitive brings this set: it reads as (0, 0), which the transform moves.
        plan.uv_set = 0;
        row_u = {0, 0, row_u.z};
        row_v = {0, 0, row_v.z};
    }
    plan.transform = !(row_u == Vec3f{1, 0, 0} && row_v == Vec3f{0, 1, 0});
    plan.row_u[0] = row_u.x, plan.row_u[1] = row_u.y, plan.row_u[2] = row_u.z;
    plan.row_v[0] = row_v.x, plan.row_v[1] = row_v.y, plan.row_v[2] = row_v.z;
    plan.wrap_u = use.sampler.wrap_u;
    plan.wrap_v = use.sampler.wrap_v;
    plan.mag = use.sampler.mag;
    plan.min = use.sampler.min;
    plan.mip = use.sampler.mip;
    if (detail != TextureDetail::full && plan.mip == MipFilter::linear) plan.mip = MipFilter::nearest;
    if (detail == TextureDetail::nearest) plan.mag = plan.min = Filter::nearest;
    plan.needs_lod = (plan.mip != MipFilter::none && plan.level_count > 1) || plan.mag != plan.min;
    return plan;
}

bool same_fetch(const TexturePlan& a, const TexturePlan& b) {
    return a.data == b.data && a.uv_set == b.uv_set && a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v && a.mag == b.mag && a.min == b.min &&
           a.mip == b.mip && std::equal(a.row_u, a.row_u + 3, b.row_u) && std::equal(a.row_v, a.row_v + 3, b.row_v);
}

// ---- lobe ----------------------------------------------------------------------------------------------------------

/// Wrap is held to [0, 1] (beyond 1 the norm is another one) and power to [0, 1e5].
LobePlan plan_lobe(const Lobe& asked, PowTier tier) {
    const Lobe lobe{clamp_or_low(asked.wrap, 0.0f, 1.0f), clamp_or_low(asked.power, 0.0f, 1e5f), asked.normalize};
    LobePlan plan;
    plan.tier = tier;
    plan.wrap = lobe.wrap;
    plan.scale = lobe.scale();
    plan.inv_one_plus_wrap = 1.0f / (1.0f + lobe.wrap);
    if ((1.0f + lobe.wrap) * plan.inv_one_plus_wrap < 1.0f)
        plan.inv_one_plus_wrap = std::bit_cast<float>(std::bit_cast<std::int32_t>(plan.inv_one_plus_wrap) + 1);
    plan.power_minus_one = lobe.power - 1.0f;
    plan.power_minus_one_high = std::bit_cast<float>(std::bit_cast<std::uint32_t>(plan.power_minus_one) & 0xffffffc0u);
    plan.power_minus_one_low = plan.power_minus_one - plan.power_minus_one_high;
    if (lobe.power == 0.0f) {
        plan.path = LobePath::step;
    } else if (lobe.power == 1.0f) {
        plan.path = LobePath::linear;
    } else if (lobe.power == 1.5f) {
        plan.path = LobePath::sqrt_product;
    } else if (lobe.power == 2.0f) {
        plan.path = LobePath::square;
    } else if (lobe.power == 3.0f || lobe.power == 4.0f || lobe.power == 5.0f) {
        // n - 1 roundings of half an ulp: from 6 on the general path is closer.
        plan.path = LobePath::integer;
        plan.integer_power = static_cast<std::int32_t>(lobe.power);
    } else {
        plan.path = LobePath::general;
    }
    return plan;
}

PowTier tier_of(Accuracy accuracy) {
    switch (accuracy) {
        case Accuracy::reference:
        case Accuracy::exact:
            break;
        case Accuracy::display:
            return PowTier::display;
        case Accuracy::fast:
            return PowTier::fast;
    }
    return PowTier::exact;
}

// ---- lights --------------------------------------------------------------------------------------------------------

/// 1 - cos(angle) without cancellation.
double versine(float angle_rad) {
    const double s = sin_cos(0.5 * static_cast<double>(angle_rad)).sin;
    return 2.0 * s * s;
}

bool contributes(const Light& light) {
    if (zero(light.color_linear) || !finite(light.color_linear)) return false;
    if (light.type != LightType::point && (!finite(light.direction_ws) || zero(light.direction_ws))) return false;
    return light.type == LightType::directional || finite(light.position_ws);
}

LightPlan plan_light(const Light& light) {
    LightPlan plan{};
    plan.type = light.type;
    plan.color[0] = light.color_linear.x, plan.color[1] = light.color_linear.y, plan.color[2] = light.color_linear.z;
    plan.position[0] = light.position_ws.x, plan.position[1] = light.position_ws.y, plan.position[2] = light.position_ws.z;
    const Vec3f travel = normalize_or(light.direction_ws, {0, -1, 0});
    plan.to_light[0] = 0.0f - travel.x, plan.to_light[1] = 0.0f - travel.y, plan.to_light[2] = 0.0f - travel.z;
    const double range = light.range > 0.0f && finite(light.range) ? static_cast<double>(light.range) : 0.0;
    plan.inv_range_squared = range > 0.0 ? static_cast<float>(std::min(1.0 / (range * range), 1e38)) : 0.0f;
    const float radius = clamp_or_low(light.source_radius, 1e-4f, 1e18f);
    plan.min_distance_squared = radius * radius;
    const float outer = clamp_or_low(light.outer_cone_rad, 0.0f, static_cast<float>(kPi));
    const float inner = clamp_or_low(light.inner_cone_rad, 0.0f, outer);
    const double cutoff = versine(outer), width = cutoff - versine(inner);
    plan.cone_cutoff = static_cast<float>(cutoff);
    plan.cone_scale = static_cast<float>(1.0 / std::max(width, 1e-30));  // inner = outer: a step
    plan.brightness = std::max({light.color_linear.x, light.color_linear.y, light.color_linear.z});
    plan.half_cone_power = 0.5f * clamp_or_low(light.cone_power, 0.0f, 1e5f);
    return plan;
}

/// A point or spot light so far from the origin that float32 cannot hold the square of its distance, or its inverse, becomes a directional one, with the
/// strength that it has there: to 1e-7 the same for a scene within 1e11 of the origin.
void plan_as_parallel_if_far(const Light& light, LightPlan& plan) {
    constexpr double kFar = 1e18;
    const Vec3d p{light.position_ws.x, light.position_ws.y, light.position_ws.z};
    const double distance_squared = dot(p, p);
    if (plan.type == LightType::directional || distance_squared < kFar * kFar) return;
    const Vec3d to_light = p * (1.0 / __builtin_sqrt(distance_squared));
    double attenuation = 1.0 / distance_squared;
    if (light.range > 0.0f && finite(light.range)) {
        const double in_range = distance_squared / (static_cast<double>(light.range) * static_cast<double>(light.range));
        attenuation *= std::max(0.0, 1.0 - in_range * in_range);
    }
    if (plan.type == LightType::spot) {
        const Vec3d off_axis = to_light - Vec3d{plan.to_light[0], plan.to_light[1], plan.to_light[2]};
        const double off = 0.5 * dot(off_axis, off_axis);  // 1 - cos of the angle to the axis
        const double cone = std::clamp((static_cast<double>(plan.cone_cutoff) - off) * static_cast<double>(plan.cone_scale), 0.0, 1.0);
        attenuation *= cone * cone;
        if (plan.half_cone_power > 0.0f) attenuation *= power_of(1.0 - off, 2.0 * static_cast<double>(plan.half_cone_power));
    }
    plan.type = LightType::directional;
    plan.to_light[0] = static_cast<float>(to_light.x), plan.to_light[1] = static_cast<float>(to_light.y);
    plan.to_light[2] = static_cast<float>(to_light.z);
    const auto arriving = [&](float channel) {
        const double value = static_cast<double>(channel) * attenuation;
        return value > 1e-37 ? static_cast<float>(value) : 0.0f;  // denormals are slow
    };
    for (float& channel : plan.color) channel = arriving(channel);
    plan.brightness = arriving(plan.brightness);
}

// ---- materials -----------------------------------------------------------------------------------------------------

struct FrameFacts {
    bool lights, ambient, specular;
};

SlotMask slots_of(const MaterialPlan& plan, bool lit) {
    SlotMask slots = lit ? kNormalAndUv0Slots : 0u;
    if ((plan.stages & kStageNormalMap) != 0) slots |= kTangentSlot;
    if ((plan.stages & kStageVertexColor) != 0) slots |= kColorSlot;
    const auto add = [&](Stage stage, const TexturePlan& texture) {
        if ((plan.stages & stage) != 0) slots |= texture.uv_set == 1 ? slot(4) : slot(1);
    };
    add(kStageBaseColorTexture, plan.base_color_texture);
    add(kStageMetallicRoughnessTexture, plan.metallic_roughness_texture);
    add(kStageNormalMap, plan.normal_texture);
    add(kStageOcclusionTexture, plan.occlusion_texture);
    add(kStageEmissiveTexture, plan.emissive_texture);
    return slots;
}

MaterialPlan plan_material(const Material& material, std::span<const Texture> textures, SlotMask available, const FrameFacts& frame,
                           const PlanOptions& options) {
    MaterialPlan plan;
    plan.base_color[0] = material.base_color.x, plan.base_color[1] = material.base_color.y;
    plan.base_color[2] = material.base_color.z, plan.base_color[3] = material.base_color.w;
    plan.metallic = clamp_or_low(material.metallic, 0.0f, 1.0f);
    plan.roughness = clamp_or_low(material.roughness, 0.0f, 1.0f);
    plan.emissive[0] = material.emissive.x, plan.emissive[1] = material.emissive.y, plan.emissive[2] = material.emissive.z;
    plan.normal_scale = material.normal_scale;
    plan.occlusion_strength = clamp_or_low(material.occlusion_strength, 0.0f, 1.0f);
    plan.alpha_mode = material.alpha_mode;
    plan.alpha_cutoff = material.alpha_cutoff;
    plan.specular_tier = tier_of(options.accuracy);
    plan.lobe = plan_lobe(lobe_of(material, options), plan.specular_tier);

    const bool lit = !material.unlit && (frame.lights || frame.ambient);
    plan.double_sided = material.double_sided && lit;
    if (material.unlit) plan.stages |= kStageUnlit;
    if (lit && frame.lights) plan.stages |= kStageLights;
    if (lit && frame.ambient) plan.stages |= kStageAmbient;
    if (lit && frame.specular) plan.stages |= kStageSpecular;
    if (lit && options.rate != ShadingRate::pixel) plan.stages |= kStagePrelit;

    bool gradients = false;
    const auto use_texture = [&](bool wanted, Stage stage, const TextureUse& use, TexturePlan& target) {
        if (!wanted) return;
        target = plan_texture(use, textures, available, options.texture_detail);
        if (target.data == nullptr) return;
        plan.stages |= stage;
        gradients = gradients || target.needs_lod;
    };
    const bool base_color_seen = lit || material.unlit || material.alpha_mode != AlphaMode::opaque;
    use_texture(base_color_seen, kStageBaseColorTexture, material.base_color_texture, plan.base_color_texture);
    use_texture(lit && frame.specular, kStageMetallicRoughnessTexture, material.metallic_roughness_texture,
                plan.metallic_roughness_texture);
    use_texture(lit && (available & kTangentSlot) != 0, kStageNormalMap, material.normal_texture, plan.normal_texture);
    use_texture(lit && frame.ambient && plan.occlusion_strength > 0.0f, kStageOcclusionTexture, material.occlusion_texture,
                plan.occlusion_texture);
    use_texture(!material.unlit && !zero(material.emissive), kStageEmissiveTexture, material.emissive_texture, plan.emissive_texture);
    if (gradients) plan.stages |= kStageGradients;
    if (base_color_seen && (available & kColorSlot) != 0) plan.stages |= kStageVertexColor;
    plan.occlusion_is_metallic_roughness = (plan.stages & kStageOcclusionTexture) != 0 &&
                                           (plan.stages & kStageMetallicRoughnessTexture) != 0 &&
                                           same_fetch(plan.occlusion_texture, plan.metallic_roughness_texture);
    plan.slots = slots_of(plan, lit);
    return plan;
}

// ---- environment ----------------------------------------------------------------------------------------------------

/// Distinct lobes of a frame, each convolved once.
class EnvironmentPlanner {
public:
    EnvironmentPlanner(EnvironmentPlans& known, const EnvironmentOrder& order, std::vector<EnvironmentPlan>& plans)
        : known_(known), order_(order), plans_(plans) {}

    int diffuse(const LobePlan& lobe) {
        return find({lobe.wrap, static_cast<double>(lobe.power_minus_one) + 1.0, lobe.scale}, order_);
    }

    /// A stand-in for reflections, so twice the error is allowed.
    int specular(float roughness) {
        EnvironmentOrder order = order_;
        order.tolerance *= 2.0;
        order.codes *= 0.5;
        order.ten_bands_are_all = true;
        return find(specular_environment_lobe(roughness), order);
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

}  // namespace

ShadingPlan plan_shading(std::span<const Material> materials, std::span<const Texture> textures, std::span<const SlotMask> available_slots,
                          std::span<const Light> lights, const Ambient& ambient, const PlanOptions& options,
                          EnvironmentPlans* environment) {
    HALFLIT_ASSERT(available_slots.size() == materials.size() + 1);
    ShadingPlan plan;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (!contributes(lights[i])) continue;
        plan.lights.push_back(plan_light(lights[i]));
        plan.lights.back().source = static_cast<std::int32_t>(i);
        plan_as_parallel_if_far(lights[i], plan.lights.back());
    }
    plan.ambient = ambient;
    const FrameFacts facts{!plan.lights.empty(), environment != nullptr || !zero(ambient.sky_linear) || !zero(ambient.ground_linear),
                           options.specular != SpecularModel::none};
    plan.specular = options.specular;
    plan.normalize_specular = options.normalize_specular;
    plan.materials.reserve(materials.size() + 1);
    for (std::size_t i = 0; i <= materials.size(); ++i)
        plan.materials.push_back(
            plan_material(i < materials.size() ? materials[i] : Material{}, textures, available_slots[i], facts, options));
    if (environment == nullptr) return plan;
    EnvironmentPlanner planner(*environment, options.environment_order, plan.environments);
    for (MaterialPlan& material : plan.materials) {
        if ((material.stages & kStageAmbient) == 0) continue;
        material.stages |= kStageEnvironment;
        material.environment = planner.diffuse(material.lobe);
    }
    // Last: roughness 1 mirrors with Lambert's lobe, and a Lambert surface must not get the larger error that mirrors are allowed.
    for (MaterialPlan& material : plan.materials)
        if ((material.stages & kStageEnvironment) != 0 && (material.stages & kStageSpecular) != 0)
            material.specular_environment = planner.specular(material.roughness);
    return plan;
}

}  // namespace halflit::shading
