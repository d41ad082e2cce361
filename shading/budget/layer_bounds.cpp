#include "shading/budget/layer_bounds.hpp"

#include "sh/power.hpp"
#include "shading/budget/texture_bounds.hpp"
#include "shading/material_properties.hpp"
#include "shading/model/constants.hpp"
#include "shading/model/sheen_table.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::shading {
namespace {

/// Largest slope of a coat's share of mirrored light, 0.04 + 0.96 (1 - N.V)^5.
constexpr double kFresnelSlope = 4.8;
/// Error of H = L + V, absolute.
constexpr double kSheenHalfError = 2.5e-7;

/// Largest changes of kSheenShapes from node to node, and the least height, of roughnesses from `first` rows on.
struct SheenSlopes {
    double albedo = 0, direction = 0, level = 0, least_height = 1, least_level = kReflectionLevels;
};
SheenSlopes sheen_slopes(int first) {
    SheenSlopes out;
    const auto compare = [&](const SheenShape& a, const SheenShape& b) {
        const auto apart = [](float x, float y) { return std::fabs(static_cast<double>(x) - static_cast<double>(y)); };
        out.albedo = std::max(out.albedo, apart(a.albedo, b.albedo));
        // The slopes of sqrt(1 - height^2) and sqrt(1 - turn^2), for heights up to 0.75 and turns up to 0.95, are at most 1.2 and 3.1.
        out.direction = std::max(out.direction, 2.2 * apart(a.height, b.height) + 4.1 * apart(a.turn, b.turn));
        out.level = std::max(out.level, apart(a.level, b.level));
    };
    for (int i = first; i < kReflectionNodes; ++i)
        for (int j = 0; j < kReflectionNodes; ++j) {
            const SheenShape& at = kSheenShapes[i * kReflectionNodes + j];
            out.least_height = std::min(out.least_height, static_cast<double>(at.height));
            out.least_level = std::min(out.least_level, static_cast<double>(at.level));
            if (i + 1 < kReflectionNodes) compare(at, kSheenShapes[(i + 1) * kReflectionNodes + j]);
            if (j + 1 < kReflectionNodes) compare(at, kSheenShapes[i * kReflectionNodes + j + 1]);
        }
    return out;
}
int first_row(double roughness) { return std::clamp(static_cast<int>(roughness * (kReflectionNodes - 1)), 0, kReflectionNodes - 2); }
double least_roughness(const MaterialPlan& material, const SceneFacts& facts) {
    const TexturePlan& texture = material.textures[TextureSlot::sheen_roughness];
    const double least = texture.data != nullptr ? least_value(texture, 3, facts.texels) : 1.0;
    return std::max(static_cast<double>(material.sheen.roughness) * least, double{kMinRoughness});
}

}  // namespace

MaterialPlan coat_as_metal(const MaterialPlan& material) {
    const ClearcoatPlan& coat = material.clearcoat;
    MaterialPlan metal;
    metal.stages = material.stages & (kStageLights | kStageAmbient | kStageEnvironment | kStageSpecular | kStageOcclusionTexture);
    metal.textures[TextureSlot::occlusion] = material.textures[TextureSlot::occlusion],
    metal.occlusion_strength = material.occlusion_strength;
    for (int c = 0; c < 3; ++c) metal.base_color[c] = coat.factor;
    metal.metallic = 1.0f, metal.dielectric = 0.0f, metal.roughness = coat.roughness;
    metal.lobe = material.lobe, metal.ggx = material.ggx;
    metal.environment = material.environment, metal.reflection_lobes = 1;
    metal.normal_scale = coat.normal_scale, metal.normal_roughness = coat.normal_roughness;
    const auto take_texture = [&](TextureSlot from, TextureSlot to) {
        metal.textures[to] = material.textures[from];
        if (metal.textures[to].data != nullptr) metal.stages |= info_of(to).stage;
    };
    take_texture(TextureSlot::clearcoat_normal, TextureSlot::normal);
    take_texture(TextureSlot::clearcoat_roughness, TextureSlot::metallic_roughness);
    return metal;
}

Surface coat_surface(const ShadingPlan& plan, const MaterialPlan& material, const SceneFacts& facts) {
    Surface s = surface_of(plan, coat_as_metal(material), facts);
    const ClearcoatPlan& coat = material.clearcoat;
    const double most = coat.factor;
    s.albedo = 0.0;                  // a coat scatters nothing
    s.diffuse = s.shiny = Factor{};  // the blue channel of its texture of roughness has no meaning
    if (const TexturePlan& texture = material.textures[TextureSlot::clearcoat]; texture.data != nullptr)
        s.base_color = factor_of(most * filter_error(texture, 0, facts.texels), most * least_value(texture, 0, facts.texels));
    return s;
}

Factor passed_by_coat(const MaterialPlan& material, const Surface& coat) {
    const double most = material.clearcoat.factor;
    return factor_of(coat.base_color.absolute + most * kFresnelSlope * coat.cosine_error(), 1.0 - most);
}

namespace {

double coat_codes(const CodeCosts& costs, const MaterialPlan& metal, const ShadingPlan& plan, const Surface& s, const Arriving& light,
                  const ReflectionSteps* reflections, double exposure) {
    double codes = rounding_codes(costs, metal, plan, s, light, reflections, exposure);
    if (!metal.ggx) codes += costs.absolute(s.reflectance * s.normalization * light.sum * kFresnelSlope * s.cosine_error());
    return std::min(codes, 255.0);
}

/// Light of the surroundings that sheen reflects; s: the base.
double around_codes(const CodeCosts& costs, const ShadingPlan& plan, const MaterialPlan& material, const SheenSurface& sheen,
                    const Surface& s, const ReflectionSteps* reflections, double exposure, const SceneFacts& facts, double& most) {
    const SheenSlopes slopes = sheen_slopes(first_row(least_roughness(material, facts)));
    // The viewer's side, x / sqrt(x^2 + 0.01) of x = V - (N.V) N, has a slope of at most 10. Directions are no shorter than their height.
    const double side = 10.0 * (2.0 * s.normal_error + 2e-7);
    const double angle = (4.0 * (s.normal_error + side) + sheen.nodes * slopes.direction) / slopes.least_height + 2e-6;
    const double levels = sheen.nodes * slopes.level + 1e-6;
    double codes = 0.0;
    if ((material.stages & kStageEnvironment) == 0) {
        const Vec3f sky = plan.ambient.sky_linear, ground = plan.ambient.ground_linear;
        most = static_cast<double>(std::max({sky.x, sky.y, sky.z, ground.x, ground.y, ground.z})) * exposure;
        codes += costs.absolute(sheen.color * angle * most);
    } else if (reflections != nullptr) {
        most = reflections->most * exposure;
        const int first = std::clamp(static_cast<int>(slopes.least_level) - 1, 0, kReflectionLevels - 1);
        double steps = 0.0, between = 0.0;
        for (int k = first; k < kReflectionLevels; ++k) steps = std::max(steps, reflections->angle[k].absolute);
        for (int k = first; k + 1 < kReflectionLevels; ++k) between = std::max(between, reflections->level[k].absolute);
        codes += costs.absolute(sheen.color * exposure * (angle * steps + levels * between));
    }
    if (!plan.sky.empty()) codes += sky_share_codes(costs, plan, material, s.normal_error, sheen.color * most);
    codes += costs.absolute(sheen.color * sheen.nodes * slopes.albedo * most);
    most *= sheen.color;
    return codes + codes_of(costs, s.occlusion, most);
}

}  // namespace

SheenSurface sheen_surface(const MaterialPlan& material, double normal_error, const SceneFacts& facts) {
    const SheenPlan& sheen = material.sheen;
    const double least = least_roughness(material, facts), cosine_error = normal_error + 4e-7;
    SheenSurface out{};
    out.color = std::max({sheen.color[0], sheen.color[1], sheen.color[2]});
    out.exponent = 1.0 / (least * least);
    out.most = out.color * (1.0 + 0.5 * out.exponent) * 0.25;  // V2 N.L is at most 1 / 4
    if (const TexturePlan& texture = material.textures[TextureSlot::sheen_roughness]; texture.data != nullptr)
        out.roughness = factor_of(static_cast<double>(sheen.roughness) * filter_error(texture, 3, facts.texels), least);
    out.nodes = (kReflectionNodes - 1) * (out.roughness.absolute + 6.0 * cosine_error) + 1e-5;
    if (const TexturePlan& texture = material.textures[TextureSlot::sheen_color]; texture.data != nullptr) {
        double error = 0.0, least_color = 1.0;
        for (int c = 0; c < 3; ++c) {
            error = std::max(error, filter_error(texture, c, facts.texels));
            least_color = std::min(least_color, least_value(texture, c, facts.texels));
        }
        out.texture = factor_of(error, least_color);
    }
    out.left = factor_of(out.color * (out.texture.absolute + out.nodes * sheen_slopes(first_row(least)).albedo), 1.0 - out.color);
    return out;
}

LayerCosts layer_costs(const CodeCosts& costs, const ShadingPlan& plan, const MaterialPlan& material, const Surface& s,
                       const Arriving& light, const ReflectionSteps* reflections, double exposure, const SceneFacts& facts) {
    LayerCosts out;
    if ((material.stages & kStageSheen) != 0) {
        const SheenSurface sheen = sheen_surface(material, s.normal_error, facts);
        const double strength = sheen.most * light.sum;
        const SheenSlopes slopes = sheen_slopes(first_row(least_roughness(material, facts)));
        // D is A sin^(1/a), whose slope is at most A sqrt(1/a); |1/a ln sin| sin^(1/a) is at most 1/e. N.L + N.V is at least
        // kLeastHalfVector, and so is |L + V|.
        const double direction = s.cosine_error() + kSheenHalfError / double{kLeastHalfVector};
        double codes = costs.relative(1e-5 + 1.5e-7 * light.count);
        codes += costs.absolute(strength * (std::sqrt(sheen.exponent) * direction + s.cosine_error() / double{kLeastHalfVector}));
        codes += costs.relative(exp_of(std::min(2.0 * sheen.roughness.relative + sheen.nodes * slopes.albedo, 13.0)) - 1.0);
        codes += costs.absolute(strength * 0.74 * sheen.roughness.relative);
        double around = 0.0;
        if ((material.stages & kStageAmbient) != 0)
            codes += around_codes(costs, plan, material, sheen, s, reflections, exposure, facts, around);
        codes += codes_of(costs, sheen.texture, strength + around);
        codes += codes_of(costs, s.passed, strength + around);
        out.codes += codes;
        out.reflected += sheen.most;
    }
    if ((material.stages & kStageClearcoat) != 0) {
        const Surface coat = coat_surface(plan, material, facts);
        out.codes += coat_codes(costs, coat_as_metal(material), plan, coat, light, reflections, exposure);
        out.reflected += coat.reflectance * coat.normalization;
    }
    out.codes = std::min(out.codes, 255.0);
    return out;
}

}  // namespace halflit::shading
