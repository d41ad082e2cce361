#include "shading/budget/surface_bounds.hpp"

#include "sh/power.hpp"
#include "shading/budget/layer_bounds.hpp"
#include "shading/budget/texture_bounds.hpp"
#include "shading/model/reflection_tables.hpp"
#include "shading/model/scalar.hpp"
#include "shading/model/thin_film.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace halflit::shading {
namespace {

/// Errors of N.L and of N itself, for a normal from three interpolated floats.
constexpr double kCosineError = 4e-7, kNormalError = 1.5e-7;
/// Error of H = L + V, absolute; of the mirrored view direction, besides that of N.
constexpr double kHalfVectorError = 2.5e-7, kMirrorError = 1e-7;
/// Relative error of the products and sums that follow.
constexpr double kProductError = 1e-5;

constexpr double kAnyShare = 1e6;  // a relative error that costs 255 codes

/// Bound on an error of the excess f - x where x = N.L > 0, for an error of N.L and roundings: f is n / (1 + w) times as steep as x at
/// most, for n < 1 times the power of t at x = 0.
double excess_error(const LobePlan& lobe, double cosine_error) {
    const double w = lobe.wrap, n = lobe.power_minus_one + 1.0, start = w / (1.0 + w);
    const double slope = n / (1.0 + w) * (n < 1.0 ? power_of(start, n - 1.0) : 1.0);
    return std::max(1.0, slope) * cosine_error + 1.2e-7 * (n + 4.0);
}

/// Ambient light that reaches a surface: an upper bound, and the error of its sum for a normal or a mirrored direction that is off.
struct Ambience {
    double most = 0, error = 0;
};

/// By the addition theorem a band adds at most its norm times sqrt((2 l + 1) / (4 pi)). Along any great circle the sum is a trigonometric
/// polynomial of degree bands - 1, so its slope is at most that times its largest value (Bernstein).
Ambience ambience_of(const EnvironmentPlan& environment, double exposure, double direction_error) {
    Ambience light;
    for (const float* channel : {environment.red, environment.green, environment.blue}) {
        double most = 0.0;
        for (int l = 0; l < environment.bands; ++l) {
            double squares = 0.0;
            for (int i = l * l; i < (l + 1) * (l + 1); ++i) squares += static_cast<double>(channel[i]) * channel[i];
            most += std::sqrt(squares * (2 * l + 1) * 0.079577471545947668);  // 1 / (4 pi)
        }
        light.most = std::max(light.most, most * exposure);
    }
    light.error = (3e-7 + (environment.bands - 1) * direction_error) * light.most;
    return light;
}

/// Largest changes of the shapes of mirrors from node to node of their table.
struct ShapeSlopes {
    double share = 0, turn = 0, level = 0;
};
ShapeSlopes shape_slopes() {
    ShapeSlopes slopes;
    const auto compare = [&](const ReflectionShape& a, const ReflectionShape& b) {
        const auto apart = [](float x, float y) { return std::fabs(static_cast<double>(x) - static_cast<double>(y)); };
        slopes.share = std::max(slopes.share, apart(a.a, b.a) + apart(a.b, b.b));
        slopes.turn = std::max({slopes.turn, apart(a.turn0, b.turn0), apart(a.turn1, b.turn1) + apart(a.spread, b.spread)});
        slopes.level = std::max({slopes.level, apart(a.level0, b.level0), apart(a.level1, b.level1)});
    };
    for (int i = 0; i < kReflectionNodes; ++i)
        for (int j = 0; j < kReflectionNodes; ++j) {
            const ReflectionShape& at = kReflectionShapes[i * kReflectionNodes + j];
            if (i + 1 < kReflectionNodes) compare(at, kReflectionShapes[(i + 1) * kReflectionNodes + j]);
            if (j + 1 < kReflectionNodes) compare(at, kReflectionShapes[i * kReflectionNodes + j + 1]);
        }
    return slopes;
}

/// Codes of reflections' roundings, and of errors of normals and roughness: what a surface looks at is a little off in direction and width.
double reflection_codes(const CodeCosts& costs, const ReflectionSteps& steps, const Surface& s, double mirror_error, double exposure) {
    constexpr double kNodes = kReflectionNodes - 1, kMostTurn = 4.0, kSteepest = 6.0;  // of the table's column over N.V
    static const ShapeSlopes slopes = shape_slopes();
    const double nodes = kNodes * (s.roughness.absolute + kSteepest * s.cosine_error()) + 1e-5;
    // A lobe's direction is R + turn (N - (N.V) R), which is no shorter than R.
    const double direction = (1.0 + 2.0 * kMostTurn) * mirror_error + nodes * slopes.turn, levels = nodes * slopes.level + 1e-6;
    const double angle = direction + 1e-6;  // arc tangents, and coordinates in rows and columns
    int first = 0;
    while (first + 1 < kReflectionLevels && kReflectionSharpest * (2 << first) < s.least_roughness * s.least_roughness * 0.25) ++first;
    double absolute = 0.0, relative = 0.0;
    for (int k = first; k < kReflectionLevels; ++k) {
        absolute = std::max(absolute, angle * steps.angle[k].absolute);
        relative = std::max(relative, angle * steps.angle[k].relative);
    }
    double between = 0.0, between_relative = 0.0;
    for (int k = first; k + 1 < kReflectionLevels; ++k) {
        between = std::max(between, levels * steps.level[k].absolute);
        between_relative = std::max(between_relative, levels * steps.level[k].relative);
    }
    const double share = std::max(1.0, s.reflectance) * exposure;
    return std::min(costs.absolute(share * absolute), costs.relative(relative)) +
           std::min(costs.absolute(share * between), costs.relative(between_relative)) +
           costs.absolute(nodes * slopes.share * steps.most * share);
}

double held_alpha(double roughness) { return std::max(roughness, double{kMinRoughness}) * std::max(roughness, double{kMinRoughness}); }

/// Largest highlight of GGX: D is at most 1 / a^2, times pi, and (N.L) V at most 1 / (2 a).
double ggx_most(double roughness) {
    const double a = held_alpha(roughness);
    return 0.5 / (a * a * a);
}

/// Largest factor by which light that bounces between facets brightens a highlight: 1 / (A + B).
double most_bounced() {
    static const double most = [] {
        double least = 1.0;
        for (const ReflectionShape& at : kReflectionShapes) least = std::min(least, static_cast<double>(at.a) + static_cast<double>(at.b));
        return 1.0 / least;
    }();
    return most;
}

/// Codes of GGX's highlights (DERIVATION.md). N.(L + V) is at least kLeastHalfVector, and so are N.L + N.V and |L + V|.
double ggx_codes(const CodeCosts& costs, const Surface& s, double light_sum) {
    static const ShapeSlopes slopes = shape_slopes();
    const double a = held_alpha(s.least_roughness), least = kLeastHalfVector, strength = s.reflectance * s.normalization * light_sum;
    const double direction = s.cosine_error() + kHalfVectorError / least;
    const double bounced = 24.0 * (s.roughness.absolute + 6.0 * s.cosine_error()) * slopes.share * most_bounced();
    const double of_roughness = 6.0 * s.roughness.relative;
    constexpr double kSchlickError = 1.5e-6;
    return costs.relative(exp_of(std::min(2.0 / a * direction + of_roughness + bounced, 13.0)) - 1.0) +
           costs.absolute(strength * s.cosine_error() / least) + costs.absolute(strength * kSchlickError);
}

/// Error of F0 below a thin film, for errors of N.V and of the F0 without it. Schlick's curve is turned around at N.V = 0.1 at the most,
/// where a change of the film's reflectance I counts 1 / (1 - 0.9^5) = 2.44 times, and N.V itself at most 20 times. I changes with the way
/// of the light by at most 2 (0.08 + 0.16) per nanometre: the sum of the waves' amplitudes is 5.3, twice for light that went twice.
double film_error(const MaterialPlan& material, double cosine_error, double f0_error, const SceneFacts& facts) {
    constexpr double kTurned = 2.45, kPerNm = 0.5, kWaves = 5.3;
    const IridescencePlan& film = material.iridescence;
    const double ior = film.ior;
    const double most = std::max(film.thickness_nm, film.thickness_nm + film.thickness_range_nm);
    double thickness_error = 2e-7 * most, share_error = 0.0;
    if (const TexturePlan& texture = material.textures[TextureSlot::iridescence_thickness]; texture.data != nullptr)
        thickness_error += std::fabs(double{film.thickness_range_nm}) * filter_error(texture, 1, facts.texels);
    if (const TexturePlan& texture = material.textures[TextureSlot::iridescence]; texture.data != nullptr)
        share_error += static_cast<double>(film.factor) * filter_error(texture, 0, facts.texels);
    if (std::min(film.thickness_nm, film.thickness_nm + film.thickness_range_nm) < 2.0f * kThinFilmNm)
        share_error += thickness_error / double{kThinFilmNm};
    // The waves' turns are rounded: 45 of them at most.
    const double turns = kWaves * 2.0 * (3e-7 * 45.0 * 6.3 * 0.05 + 2e-6);
    // Ways change by at most 2 d with N.V, and Fresnel's shares by at most 60. The amplitude that the inner side reflects changes n times
    // as fast as the one without a film, and its sign within 1 / kFilmSignSlope.
    const double amplitude = std::min(1.0, std::sqrt(f0_error) + 1e-6);
    const double reflectance = (kPerNm * 2.0 * std::min(most, 1e4) + 60.0) * cosine_error + kPerNm * 2.0 * ior * thickness_error + turns +
                               2.0 * kWaves * double{kFilmSignSlope} * ior * amplitude;
    return std::min(1.0, kTurned * reflectance + 20.0 * cosine_error + share_error);
}

}  // namespace

Factor factor_of(double error, double least) { return {error, error < least ? std::min(error / (least - error), kAnyShare) : kAnyShare}; }

double codes_of(const CodeCosts& costs, const Factor& factor, double strength) {
    return std::min(costs.absolute(factor.absolute * strength), costs.relative(factor.relative));
}

double Surface::cosine_error() const { return normal_error + (kCosineError - kNormalError); }

Surface surface_of(const ShadingPlan& plan, const MaterialPlan& material, const SceneFacts& facts) {
    const auto has = [&](Stage stage) { return (material.stages & stage) != 0; };
    Surface s{};
    const auto& [red, green, blue, alpha] = material.base_color;
    s.albedo = std::max({red, green, blue}) * (has(kStageVertexColor) ? facts.vertex_color : 1.0);
    s.specular = has(kStageSpecular) && (has(kStageLights) || has(kStageAmbient));
    s.metallic = material.metallic;
    const double dielectric = material.dielectric;
    const auto filtered = [&](const TexturePlan& texture, std::initializer_list<int> channels) {
        double error = 0.0;
        for (const int c : channels) error = std::max(error, filter_error(texture, c, facts.texels));
        return error;
    };
    // A factor times a texture's channels.
    const auto textured = [&](const TexturePlan& texture, std::initializer_list<int> channels, double factor) {
        double least = 1.0;
        for (const int c : channels) least = std::min(least, least_value(texture, c, facts.texels));
        return factor_of(factor * filtered(texture, channels), factor * least);
    };
    double least_color = has(kStageVertexColor) ? 0.0 : std::min({red, green, blue}), least_metallic = s.metallic;
    if (has(kStageBaseColorTexture)) {
        s.base_color = textured(material.textures[TextureSlot::base_color], {0, 1, 2}, s.albedo);
        for (const int c : {0, 1, 2})
            least_color =
                std::min(least_color, material.base_color[c] * least_value(material.textures[TextureSlot::base_color], c, facts.texels));
    }
    double roughness = material.roughness;
    if (has(kStageMetallicRoughnessTexture)) {
        const TexturePlan& texture = material.textures[TextureSlot::metallic_roughness];
        roughness *= least_value(texture, 1, facts.texels);
        s.roughness = factor_of(filtered(texture, {1}) * material.roughness, std::max(roughness, double{kMinRoughness}));
        least_metallic *= least_value(texture, 2, facts.texels);
        const double error = filtered(texture, {2}) * s.metallic;
        const auto f0 = [&](double metallic) { return dielectric + metallic * (least_color - dielectric); };
        s.diffuse = factor_of(error, 1.0 - s.metallic);
        s.shiny = factor_of(error * std::max(s.albedo, dielectric), std::min(f0(least_metallic), f0(s.metallic)));
    }
    if (s.metallic == 0.0 || !has(kStageMetallicRoughnessTexture)) {
        s.least_albedo = least_color * (1.0 - s.metallic) * (1.0 - dielectric);
        s.reflectance_at_least = dielectric + s.metallic * (least_color - dielectric);
    }
    constexpr double kLeastReflectance = 1e-6;  // costs are divided by it
    s.reflectance = std::max({kLeastReflectance, dielectric, s.metallic > 0.0 ? s.albedo : 0.0});
    s.normal_error = kNormalError;
    if (has(kStageNormalMap)) {
        // The three components are in [-1, 1], each off by twice its channel's error. The vector is no shorter than its z. Where z may be 0
        // there is no bound: between texels that point away from each other a normal may be as short as one likes.
        const double z = 2.0 * least_value(material.textures[TextureSlot::normal], 2, facts.texels) - 1.0;
        const double error = 2.0 * 1.7320508 * filtered(material.textures[TextureSlot::normal], {0, 1, 2}) *
                             std::max(1.0, std::fabs(double{material.normal_scale}));
        s.normal_error += error < z ? error / (z - error) : 2.0;
        if (material.normal_roughness) {
            // (r^4 + u^2)^(1/4), u being what the normals lost, has the slope u / (2 (r^4 + u^2)^(3/4)) in u, which is at most 1 / (2 r).
            const double held = std::max(roughness, double{kMinRoughness});
            const double lost =
                filtered(material.textures[TextureSlot::normal], {3}) * std::fabs(double{material.normal_scale}) / (2.0 * held);
            s.roughness.absolute += lost;
            s.roughness.relative += lost / held;
        }
    }
    if (has(kStageAnisotropy)) {
        // A direction of the length l is off by its error over l. Where l is below 1 / 2 the strength falls with l^2, and the difference of
        // alpha along and across with its square, so that the error counts most where 32 l^4 is alpha. It turns highlights as an error of N
        // does, and the mirrors that lean along it.
        const double width = held_alpha(roughness);
        double direction = 4e-7 + 2.0 * s.normal_error, strength = 8.0 * direction;
        if (const TexturePlan& texture = material.textures[TextureSlot::anisotropy]; texture.data != nullptr) {
            direction += 2.0 * 1.4142136 * filtered(texture, {0, 1});
            strength = 8.0 * direction + filtered(texture, {2});
        }
        const double wider = strength / (2.0 * std::sqrt(width));  // of the root of alpha along
        s.roughness.absolute += wider, s.roughness.relative += wider;
        s.normal_error += 1.1 * power_of(32.0 / width, 0.25) * direction;
    }
    if (has(kStageOcclusionTexture)) {
        const double strength = material.occlusion_strength;
        s.occlusion = factor_of(strength * filtered(material.textures[TextureSlot::occlusion], {0}),
                                1.0 + strength * (least_value(material.textures[TextureSlot::occlusion], 0, facts.texels) - 1.0));
    }
    if (has(kStageSpecularColor)) {
        // F0 and its weight, the latter at grazing views; the diffuse part lacks the largest F0.
        double error = 0.0;
        if (material.textures[TextureSlot::specular_color].data != nullptr)
            error += std::max({material.dielectric_color[0], material.dielectric_color[1], material.dielectric_color[2]}) *
                     filtered(material.textures[TextureSlot::specular_color], {0, 1, 2});
        if (material.textures[TextureSlot::specular].data != nullptr) error += filtered(material.textures[TextureSlot::specular], {3});
        s.dielectric = {error, error > 0.0 ? kAnyShare : 0.0};
        s.least_albedo = 0.0;
    }
    if (has(kStageIridescence)) {
        s.reflectance = 1.0;
        s.shiny = {s.shiny.absolute > 0.0 ? s.diffuse.absolute : 0.0, s.shiny.absolute > 0.0 ? kAnyShare : 0.0};
        const double f0_error = s.dielectric.absolute + (s.metallic > 0.0 ? s.base_color.absolute : 0.0);
        s.dielectric = {film_error(material, s.cosine_error(), f0_error, facts), kAnyShare};
        s.least_albedo = 0.0;
    }
    if (has(kStageTransmission)) {
        const double share = material.transmission.share;
        if (const TexturePlan& texture = material.textures[TextureSlot::transmission]; texture.data != nullptr)
            s.scattered = factor_of(share * filtered(texture, {0}), 1.0 - share);
        s.least_albedo = 0.0;
    }
    if (has(kStageDiffuseTransmission)) {
        // Light of both sides has weights that sum to no more than the brighter of the two colours, and the same errors on either side. An
        // error of the share moves light from one side to the other.
        const DiffuseTransmissionPlan& plan_of = material.diffuse_transmission;
        s.albedo = std::max(s.albedo, static_cast<double>(std::max({plan_of.color[0], plan_of.color[1], plan_of.color[2]})));
        if (const TexturePlan& texture = material.textures[TextureSlot::diffuse_transmission]; texture.data != nullptr)
            s.scattered = {s.scattered.absolute + static_cast<double>(plan_of.share) * filtered(texture, {3}), kAnyShare};
        if (const TexturePlan& texture = material.textures[TextureSlot::diffuse_transmission_color]; texture.data != nullptr)
            s.scattered = {s.scattered.absolute + static_cast<double>(plan_of.share) * filtered(texture, {0, 1, 2}), kAnyShare};
        s.least_albedo = 0.0;
    }
    if (has(kStageClearcoat)) {
        const Surface coat = coat_surface(plan, material, facts);
        s.passed = passed_by_coat(material, coat);
        s.least_albedo = 0.0;
    }
    if (has(kStageSheen)) {
        s.below_sheen = sheen_surface(material, s.normal_error, facts).left;
        s.least_albedo = 0.0;
    }
    if (has(kStageEmissiveTexture))
        s.emissive =
            textured(material.textures[TextureSlot::emissive], {0, 1, 2}, *std::max_element(material.emissive, material.emissive + 3));
    s.least_roughness = roughness;
    s.exponent = specular_exponent(roughness);
    s.normalization = plan.normalize_specular ? specular_normalization(0.5 * s.exponent, plan.specular == SpecularModel::phong) : 1.0;
    if (material.ggx) {
        s.reflectance = std::max(1.0, s.reflectance);  // at grazing views
        s.normalization = ggx_most(roughness) * most_bounced() * s.reflectance;
    }
    return s;
}

Arriving arriving(const ShadingPlan& plan, double exposure, const SceneFacts& facts) {
    Arriving a;
    for (std::size_t i = 0; i < plan.lights.size(); ++i) {
        const LightPlan& light = plan.lights[i];
        const double most = light.brightness * facts.light_attenuation[i] * exposure;
        a.sum += most;
        a.largest = std::max(a.largest, most);
        ++a.count;
        a.local += kind_of(light.type).placed ? 1 : 0;
        if (!kind_of(light.type).cone) continue;
        a.cone_error = std::max(a.cone_error, 2e-7 * light.cone_scale);
    }
    return a;
}

bool may_split(const ShadingPlan& plan, const MaterialPlan& material) {
    return plan.shadow_mode == ShadowMode::soft_split && material.shadow_fade_scale > 0.0f && (material.stages & kStageLights) != 0;
}

namespace {

/// Roundings of a share of two sums over the directions of shadow maps.
double sky_sum_error(const ShadingPlan& plan) { return 2.4e-7 * (static_cast<double>(plan.sky.size()) + 8.0); }

}  // namespace

double sky_share_codes(const CodeCosts& costs, const ShadingPlan& plan, const MaterialPlan& material, double normal_error, double most) {
    if (plan.sky_grid.hidden == nullptr) {
        const double slope = 8.0 * (static_cast<double>(material.lobe.power_minus_one) + 1.0);
        return costs.absolute((sky_sum_error(plan) + slope * normal_error) * most);
    }
    // Ten roundings each of H(n) and T(n), whose terms are at most 4 times the sum of L_d. The share is never below kGridBounce, so the
    // error is one of the light.
    const double share_error = (1.0 - double{kGridBounce}) * (5e-5 + kGridSlope * normal_error);
    return costs.relative(share_error / double{kGridBounce});
}

double rounding_codes(const CodeCosts& costs, const MaterialPlan& material, const ShadingPlan& plan, const Surface& s,
                      const Arriving& light, const ReflectionSteps* reflections, double exposure) {
    const auto has = [&](Stage stage) { return (material.stages & stage) != 0; };
    const double n = material.lobe.power_minus_one + 1.0, scale = material.lobe.scale;
    double codes = costs.relative(kProductError + 1.5e-7 * (has(kStageLights) ? n + light.count : 0.0));
    double diffuse_light = 0.0, shiny = 0.0;       // all light that the albedo reflects; that F0 reflects
    double mirrored_most = 0.0, highlights = 0.0;  // that is mirrored at most, of the surroundings and of lights
    if (has(kStageUnlit)) diffuse_light = 1.0;
    if (has(kStageAmbient)) {
        Ambience diffuse, mirrored;
        const double mirror_error = 2.0 * s.normal_error + kMirrorError;
        if (has(kStageEnvironment)) {
            const auto ambience = [&](int index, double error) {
                return ambience_of(plan.environments[static_cast<std::size_t>(index)], exposure, error);
            };
            diffuse = ambience(material.environment, s.normal_error);
            if (s.specular && reflections != nullptr) {
                mirrored.most = reflections->most * exposure;
                codes += reflection_codes(costs, *reflections, s, mirror_error, exposure);
            }
        } else {
            const Vec3f sky = plan.ambient.sky_linear, ground = plan.ambient.ground_linear;
            const double most = std::max({sky.x, sky.y, sky.z, ground.x, ground.y, ground.z}) * exposure;
            diffuse = {most, s.normal_error * most};
            if (s.specular) mirrored = {most, mirror_error * most};
        }
        // The mirrored share is at most 1 or F0, and falls with the roughness and with N.V, no faster than 1 and 5.
        const double share = std::max(1.0, s.reflectance);
        codes += costs.absolute(s.albedo * diffuse.error);
        codes += costs.absolute(share * mirrored.error + (s.roughness.absolute + 5.0 * s.cosine_error()) * mirrored.most);
        codes += codes_of(costs, s.occlusion, s.albedo * diffuse.most + share * mirrored.most);
        if (!plan.sky.empty()) {
            // The weights of mirrored light change no faster than twice the inverse width of the narrowest focus, by a factor of the lights
            // in reach.
            codes += sky_share_codes(costs, plan, material, s.normal_error, s.albedo * diffuse.most);
            const double focused = 16.0 / (1.0 - static_cast<double>(plan.sky_focus)) * mirror_error;
            if (plan.sky_grid.hidden == nullptr) codes += costs.absolute(share * (sky_sum_error(plan) + focused) * mirrored.most);
        }
        diffuse_light += diffuse.most;
        shiny += mirrored.most;
        mirrored_most = share * mirrored.most;
    }
    if (has(kStageLights)) {
        const double amplitude = s.albedo * scale * light.sum;
        codes += costs.edge(amplitude, n, s.cosine_error() / (1.0 + material.lobe.wrap));
        if (may_split(plan, material)) codes += costs.absolute(amplitude * excess_error(material.lobe, s.cosine_error()));
        if (light.local > 0) codes += costs.edge(amplitude, 1.0, 3e-7);  // the end of the range
        if (light.cone_error > 0) codes += costs.edge(amplitude, 2.0, light.cone_error);
        diffuse_light += light.sum * scale;
    }
    if (s.specular && material.ggx) {
        codes += ggx_codes(costs, s, light.sum);
        shiny += s.reflectance * s.normalization * light.sum;
        highlights = s.normalization * light.sum;
    } else if (s.specular && has(kStageLights)) {
        const double turning = plan.specular == SpecularModel::phong ? 2.0 : 1.0, strength = s.normalization * light.sum;
        const double constant = 4.0 * s.roughness.relative, linear = 3e-7 + constant;  // roughness^4, in exponent and norm
        codes += costs.specular(s.reflectance * s.normalization * light.largest, light.count, constant, linear,
                                turning * std::sqrt(2.0 * s.exponent) * s.cosine_error());
        // Opposite a light at a grazing angle H = L + V is short, and its direction is off by kHalfVectorError / |H|. With N.V >= 0 the
        // highlight is no brighter than |H| of its peak there, and d/dx cos^s x <= 0.61 sqrt(s), so |H| cancels. N.L, a factor of the
        // highlight, is small there too, so its own error is absolute.
        const double short_half = plan.specular == SpecularModel::blinn ? 0.61 * std::sqrt(s.exponent) * kHalfVectorError : 0.0;
        codes += costs.absolute(s.reflectance * strength * (short_half + s.cosine_error()));
        shiny += strength;
        highlights = s.reflectance * strength;
    }
    codes += codes_of(costs, s.base_color, diffuse_light + s.metallic * std::max(0.0, shiny - diffuse_light));
    codes += codes_of(costs, s.scattered, s.albedo * diffuse_light);
    codes += codes_of(costs, s.dielectric, s.albedo * diffuse_light + shiny);
    codes += codes_of(costs, s.diffuse, s.albedo * diffuse_light) + codes_of(costs, s.shiny, shiny);
    codes += codes_of(costs, s.emissive, exposure);
    const double glow = std::max({material.emissive[0], material.emissive[1], material.emissive[2]}) * exposure;
    codes += codes_of(costs, s.below_sheen, s.albedo * diffuse_light + mirrored_most + highlights);
    codes += codes_of(costs, s.passed, s.albedo * diffuse_light + mirrored_most + highlights + glow);
    return std::min(codes, 255.0);
}

}  // namespace halflit::shading
