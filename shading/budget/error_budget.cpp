#include "shading/budget/error_budget.hpp"

#include "sh/power.hpp"
#include "shading/budget/power_fit.hpp"
#include "shading/budget/texture_bounds.hpp"
#include "shading/model/code_bounds.hpp"
#include "shading/model/scalar.hpp"

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

/// Fewest lights without shadow maps for which light in cells pays.
constexpr int kLeastCellLights = 4;

/// A factor of some light: its error, absolute and as a share of its least value.
struct Factor {
    double absolute = 0, relative = 0;
};
constexpr double kAnyShare = 1e6;  // a relative error that costs 255 codes

Factor factor_of(double error, double least) { return {error, error < least ? std::min(error / (least - error), kAnyShare) : kAnyShare}; }

/// Codes that the factor's error costs: the light is the factor times at most `strength`.
double codes_of(const Factor& factor, double strength) {
    return std::min(codes_of_absolute(factor.absolute * strength), codes_of_relative(factor.relative));
}

/// Upper bounds on what a surface reflects, and the errors of its inputs. Members for which there is no texture have no error.
struct Surface {
    double albedo, reflectance;       ///< largest colour; largest F0
    double metallic;                  ///< largest
    double exponent, normalization;   ///< those of the sharpest highlight
    double least_albedo = 0;          ///< smallest colour that matt light is multiplied by; 0: not known
    double reflectance_at_least = 0;  ///< F0 of that colour
    double normal_error;
    Factor base_color, roughness, matt, shiny, occlusion, emissive;  ///< matt: 1 - metallic; shiny: F0, by the metallic texture's error
    bool specular;

    [[nodiscard]] double cosine_error() const { return normal_error + (kCosineError - kNormalError); }
};

Surface surface_of(const ShadingPlan& plan, const MaterialPlan& material, const SceneFacts& facts) {
    const auto has = [&](Stage stage) { return (material.stages & stage) != 0; };
    Surface s{};
    const auto& [red, green, blue, alpha] = material.base_color;
    s.albedo = std::max({red, green, blue}) * (has(kStageVertexColor) ? facts.vertex_color : 1.0);
    s.specular = has(kStageSpecular) && (has(kStageLights) || has(kStageAmbient));
    s.metallic = material.metallic;
    const auto filtered = [&](const TexturePlan& texture, std::initializer_list<int> channels) {
        double error = 0.0;
        for (const int c : channels) error = std::max(error, filter_error(texture, c, facts.largest_uv));
        return error;
    };
    // A factor times a texture's channels.
    const auto textured = [&](const TexturePlan& texture, std::initializer_list<int> channels, double factor) {
        double least = 1.0;
        for (const int c : channels) least = std::min(least, least_value(texture, c));
        return factor_of(factor * filtered(texture, channels), factor * least);
    };
    double least_color = has(kStageVertexColor) ? 0.0 : std::min({red, green, blue}), least_metallic = s.metallic;
    if (has(kStageBaseColorTexture)) {
        s.base_color = textured(material.base_color_texture, {0, 1, 2}, s.albedo);
        for (const int c : {0, 1, 2})
            least_color = std::min(least_color, material.base_color[c] * least_value(material.base_color_texture, c));
    }
    double roughness = material.roughness;
    if (has(kStageMetallicRoughnessTexture)) {
        const TexturePlan& texture = material.metallic_roughness_texture;
        roughness *= least_value(texture, 1);
        s.roughness = factor_of(filtered(texture, {1}) * material.roughness, std::max(roughness, double{kMinRoughness}));
        least_metallic *= least_value(texture, 2);
        const double error = filtered(texture, {2}) * s.metallic, dielectric = kDielectricReflectance;
        const auto f0 = [&](double metallic) { return dielectric + metallic * (least_color - dielectric); };
        s.matt = factor_of(error, 1.0 - s.metallic);
        s.shiny = factor_of(error * std::max(s.albedo, dielectric), std::min(f0(least_metallic), f0(s.metallic)));
    }
    if (s.metallic == 0.0 || !has(kStageMetallicRoughnessTexture)) {
        const double dielectric = kDielectricReflectance;
        s.least_albedo = least_color * (1.0 - s.metallic) * (1.0 - dielectric);
        s.reflectance_at_least = dielectric + s.metallic * (least_color - dielectric);
    }
    s.reflectance = s.metallic > 0.0 ? std::max(double{kDielectricReflectance}, s.albedo) : double{kDielectricReflectance};
    if (has(kStageOcclusionTexture)) {
        const double strength = material.occlusion_strength;
        s.occlusion = factor_of(strength * filtered(material.occlusion_texture, {0}),
                                1.0 + strength * (least_value(material.occlusion_texture, 0) - 1.0));
    }
    if (has(kStageEmissiveTexture))
        s.emissive = textured(material.emissive_texture, {0, 1, 2}, *std::max_element(material.emissive, material.emissive + 3));
    s.exponent = specular_exponent(roughness);
    s.normalization = plan.normalize_specular ? specular_normalization(0.5 * s.exponent, plan.specular == SpecularModel::phong) : 1.0;
    s.normal_error = kNormalError;
    if (has(kStageNormalMap)) {
        // The three components are in [-1, 1], each off by twice its channel's error. The vector is no shorter than its z. Where z may be 0
        // there is no bound: between texels that point away from each other a normal may be as short as one likes.
        const double z = 2.0 * least_value(material.normal_texture, 2) - 1.0;
        const double error =
            2.0 * 1.7320508 * filtered(material.normal_texture, {0, 1, 2}) * std::max(1.0, std::fabs(double{material.normal_scale}));
        s.normal_error += error < z ? error / (z - error) : 2.0;
    }
    return s;
}

/// Upper bounds on the light that reaches a surface, in units of display white.
struct Arriving {
    double sum = 0, largest = 0;  ///< sum and largest of the lights' colours times attenuation
    double cone_error = 0;        ///< largest error of a spot's cosine, as a share of its cone's width
    int count = 0, local = 0;
};

Arriving arriving(const ShadingPlan& plan, double exposure, const SceneFacts& facts) {
    Arriving a;
    for (std::size_t i = 0; i < plan.lights.size(); ++i) {
        const LightPlan& light = plan.lights[i];
        const double most = light.brightness * facts.light_attenuation[i] * exposure;
        a.sum += most;
        a.largest = std::max(a.largest, most);
        ++a.count;
        a.local += light.type != LightType::directional ? 1 : 0;
        if (light.type != LightType::spot) continue;
        a.cone_error = std::max(a.cone_error, 2e-7 * light.cone_scale);
    }
    return a;
}

/// True if a shadow may cut the lobe's core off and leave its excess (ShadowMode::soft_split). The excess is nearly black where lobe and
/// core are close, so an error of the lobe shows most there.
bool may_split(const ShadingPlan& plan, const MaterialPlan& material) {
    return plan.shadow_mode == ShadowMode::soft_split && material.shadow_fade_scale > 0.0f && (material.stages & kStageLights) != 0;
}

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

double rounding_codes(const MaterialPlan& material, const ShadingPlan& plan, const Surface& s, const Arriving& light, double exposure) {
    const auto has = [&](Stage stage) { return (material.stages & stage) != 0; };
    const double n = material.lobe.power_minus_one + 1.0, scale = material.lobe.scale;
    double codes = codes_of_relative(kProductError + 1.5e-7 * (has(kStageLights) ? n + light.count : 0.0));
    double matt = 0.0, shiny = 0.0;  // all light that the albedo reflects; that F0 reflects
    if (has(kStageUnlit)) matt = exposure;
    if (has(kStageAmbient)) {
        Ambience diffuse, mirrored;
        const double mirror_error = 2.0 * s.normal_error + kMirrorError;
        if (has(kStageEnvironment)) {
            const auto ambience = [&](int index, double error) {
                return ambience_of(plan.environments[static_cast<std::size_t>(index)], exposure, error);
            };
            diffuse = ambience(material.environment, s.normal_error);
            if (s.specular) mirrored = ambience(material.specular_environment, mirror_error);
        } else {
            const Vec3f sky = plan.ambient.sky_linear, ground = plan.ambient.ground_linear;
            const double most = std::max({sky.x, sky.y, sky.z, ground.x, ground.y, ground.z}) * exposure;
            diffuse = {most, s.normal_error * most};
            if (s.specular) mirrored = {most, mirror_error * most};
        }
        // The mirrored share is at most 1 or F0, and falls with the roughness and with N.V, no faster than 1 and 5.
        const double share = std::max(1.0, s.reflectance);
        codes += codes_of_absolute(s.albedo * diffuse.error);
        codes += codes_of_absolute(share * mirrored.error + (s.roughness.absolute + 5.0 * s.cosine_error()) * mirrored.most);
        codes += codes_of(s.occlusion, s.albedo * diffuse.most + share * mirrored.most);
        matt += diffuse.most;
        shiny += mirrored.most;
    }
    if (has(kStageLights)) {
        const double amplitude = s.albedo * scale * light.sum;
        codes += codes_of_edge(amplitude, n, s.cosine_error() / (1.0 + material.lobe.wrap));
        if (may_split(plan, material)) codes += codes_of_absolute(amplitude * excess_error(material.lobe, s.cosine_error()));
        if (light.local > 0) codes += codes_of_edge(amplitude, 1.0, 3e-7);  // the end of the range
        if (light.cone_error > 0) codes += codes_of_edge(amplitude, 2.0, light.cone_error);
        matt += light.sum * scale;
    }
    if (s.specular && has(kStageLights)) {
        const double turning = plan.specular == SpecularModel::phong ? 2.0 : 1.0, strength = s.normalization * light.sum;
        const double constant = 4.0 * s.roughness.relative, linear = 3e-7 + constant;  // roughness^4, in exponent and norm
        codes += codes_of_specular(s.reflectance * s.normalization * light.largest, light.count, constant, linear,
                                   turning * std::sqrt(2.0 * s.exponent) * s.cosine_error());
        // Opposite a light at a grazing angle H = L + V is short, and its direction is off by kHalfVectorError / |H|. With N.V >= 0 the
        // highlight is no brighter than |H| of its peak there, and d/dx cos^s x <= 0.61 sqrt(s), so |H| cancels. N.L, a factor of the
        // highlight, is small there too, so its own error is absolute.
        const double short_half = plan.specular == SpecularModel::blinn ? 0.61 * std::sqrt(s.exponent) * kHalfVectorError : 0.0;
        codes += codes_of_absolute(s.reflectance * strength * (short_half + s.cosine_error()));
        shiny += strength;
    }
    codes += codes_of(s.base_color, matt + s.metallic * std::max(0.0, shiny - matt));
    codes += codes_of(s.matt, s.albedo * matt) + codes_of(s.shiny, shiny);
    codes += codes_of(s.emissive, exposure);
    return std::min(codes, 255.0);
}

/// `amplitude`: strength of lights that shadows may split; 0: none.
double lobe_tier_codes(const LobePlan& lobe, PowTier tier, double amplitude) {
    if (lobe.path != LobePath::general || lobe.power_minus_one >= kSharpPowerMinusOne || tier == PowTier::exact) return 0.0;
    const PowErrors errors = pow_errors(tier);
    const double a = std::fabs(static_cast<double>(lobe.power_minus_one));
    const double relative = 0.5 * kLn2 * a * errors.log2 + errors.exp2 + 4e-6;
    return codes_of_relative(relative) + codes_of_absolute(amplitude * relative);
}

double specular_tier_codes(const Surface& s, const Arriving& light, PowTier tier) {
    if (!s.specular || tier == PowTier::exact) return 0.0;
    const PowErrors errors = pow_errors(tier);
    return codes_of_specular(s.reflectance * s.normalization * light.largest, light.count, errors.exp2, errors.log2, 0.0);
}

double environment_codes(const ShadingPlan& plan, const MaterialPlan& material, const Surface& s, double exposure) {
    double codes = 0.0;
    for (const int index : {material.environment, material.specular_environment}) {
        if (index < 0) continue;
        const EnvironmentPlan& environment = plan.environments[static_cast<std::size_t>(index)];
        // Suns may shine where there is no other light.
        codes += environment.bound_codes + codes_of_absolute(s.albedo * environment.sun_bound * exposure);
    }
    return codes;
}

template <class Codes>
PowTier cheapest_tier(double budget, const Codes& codes) {
    for (const PowTier tier : {PowTier::fast, PowTier::display})
        if (codes(tier) <= budget) return tier;
    return PowTier::exact;
}

/// Chooses the cheapest method for t^n within `budget` codes. Returns the codes that it costs.
double spend_on_lobe(MaterialPlan& material, bool split, const Surface& s, const Arriving& light, double budget, PowerFits& fits) {
    LobePlan& lobe = material.lobe;
    if (lobe.path != LobePath::general || lobe.power_minus_one >= kSharpPowerMinusOne) return 0.0;
    const double amplitude = s.albedo * static_cast<double>(lobe.scale) * light.sum;
    const LobeFit& fit =
        fits.lobe(static_cast<double>(lobe.power_minus_one) + 1.0, amplitude, split ? static_cast<double>(lobe.wrap) : 0.0);
    if (fit.codes <= budget) {
        lobe.path = LobePath::curve;
        std::copy_n(fit.c, kLobeCurveTerms, lobe.curve);
        return fit.codes;
    }
    const auto codes = [&](PowTier tier) { return lobe_tier_codes(lobe, tier, split ? amplitude : 0.0); };
    lobe.tier = cheapest_tier(budget, codes);
    return codes(lobe.tier);
}

/// Lets the light of a material be fitted over cells, within `budget` codes. Returns the codes that it costs.
double spend_on_cells(const ShadingPlan& plan, MaterialPlan& material, const Surface& s, double exposure, double budget) {
    const auto has = [&](Stage stage) { return (material.stages & stage) != 0; };
    const auto casts_none = [](const LightPlan& light) { return light.shadow_map < 0; };
    const double n = static_cast<double>(material.lobe.power_minus_one) + 1.0;
    if (!has(kStageLights) || has(kStageNormalMap) || material.alpha_mode == AlphaMode::blend || !(n >= 1.0 && n <= 3.0)) return 0.0;
    if (material.lobe.path == LobePath::step || s.albedo <= 0.0) return 0.0;
    if (std::count_if(plan.lights.begin(), plan.lights.end(), casts_none) < kLeastCellLights) return 0.0;
    CellTolerance& cells = material.cells;
    const double r = kBudgetShares.cells_relative * budget / kSlopeAtWhite, scale = material.lobe.scale;
    double absolute_codes = (1.0 - kBudgetShares.cells_relative) * budget;
    if (s.specular) {
        const double albedo = s.least_albedo;
        const double ratio = albedo > 0.0 ? s.reflectance_at_least / (albedo * scale) : kAnyShare;
        if (ratio < 100.0) {
            cells.specular_ratio = static_cast<float>(1.001 * ratio);
            cells.absolute_specular = 3e38f;
        } else {
            absolute_codes *= 0.5;
            cells.absolute_specular = static_cast<float>(0.999 * absolute_codes / (kSlopeAtBlack * exposure * s.reflectance));
        }
        cells.half_exponent = static_cast<float>(0.5 * specular_exponent(material.roughness));
        cells.peak = static_cast<float>(1.001 * s.normalization);
    }
    cells.relative = static_cast<float>(0.999 * r / (1.0 + r));  // the drawn light may be the smaller one
    cells.absolute = static_cast<float>(0.999 * absolute_codes / (kSlopeAtBlack * exposure * s.albedo * scale));
    return budget;
}

/// True if highlights are below the threshold at 45 degrees from their middle. If not, the test costs more than it saves.
bool specular_ends(const ShadingPlan& plan, const Surface& s, double largest, double threshold) {
    const double z = 0.25 * s.exponent * (plan.specular == SpecularModel::phong ? 0.25 : 1.0), z2 = z * z, z4 = z2 * z2;
    return 40320.0 * largest * s.normalization <= threshold * z4 * z4;
}

/// Chooses the cheapest method for highlights within `budget` codes. Adds the codes that it costs to the bound.
void spend_on_specular(const ShadingPlan& plan, MaterialPlan& material, const Surface& s, const Arriving& light, double exposure,
                       double budget, PowerFits& fits, ErrorBound& bound) {
    // Highlights below this, before the reflectance, can be left out at a cost of `codes` codes.
    const auto threshold_of = [&](double codes) { return codes / (kSlopeAtBlack * exposure * s.reflectance * light.count); };
    if ((material.stages & kStageMetallicRoughnessTexture) == 0) {
        const double half_exponent = s.exponent * (plan.specular == SpecularModel::phong ? 0.125 : 0.5);
        const double share = threshold_of(kBudgetShares.specular_cut * budget) / (light.largest / exposure * s.normalization);
        const SpecularFit& fit = fits.specular(half_exponent, share < 1.0 ? power_of(share, 1.0 / half_exponent) : 1.0);
        const double codes = fit.codes(s.reflectance * s.normalization * light.largest, light.count);
        if (codes <= kBudgetShares.specular_curve * budget) {
            material.specular_curve = fit.curve;
            bound.specular = codes;
            bound.left_out += kBudgetShares.specular_cut * budget;
            return;
        }
    }
    material.specular_tier =
        cheapest_tier(kBudgetShares.specular_power * budget, [&](PowTier tier) { return specular_tier_codes(s, light, tier); });
    bound.specular = specular_tier_codes(s, light, material.specular_tier);
    const double spent = kBudgetShares.specular_left_out * (budget - bound.specular), threshold = threshold_of(spent);
    if (specular_ends(plan, s, light.largest / exposure, threshold)) {
        material.specular_threshold = static_cast<float>(std::min(1e30, threshold));
        bound.left_out += spent;
    }
}

/// The squared distance from which on `brightness` times attenuation is below `least`; 0: there is none, or it is beyond the range.
double cutoff_squared(const LightPlan& light, double least) {
    const double range = light.inv_range_squared > 0.0f ? 1.0 / light.inv_range_squared : 0.0;
    double low = light.min_distance_squared, high = std::max(low, light.brightness / least);
    if (range > 0.0) high = std::min(high, range);
    const auto arriving = [&](double d2) {
        return light.brightness * range_window(d2 * static_cast<double>(light.inv_range_squared)) / d2;
    };
    if (range == 0.0) return high < 1e36 ? high * 1.001 : 0.0;
    if (arriving(low) <= least) return low;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (arriving(middle) > least ? low : high) = middle;
    }
    return high * 1.001 < range ? high * 1.001 : 0.0;
}

}  // namespace

void spend_error_budget(ShadingPlan& plan, double budget_codes, double exposure, const SceneFacts& facts, PowerFits& fits) {
    HALFLIT_ASSERT(facts.light_attenuation.size() == plan.lights.size());
    const Arriving light = arriving(plan, exposure, facts);
    ErrorBound worst;

    // The parts that cannot be changed, and the codes that the poorest material has left for the cutoff radii, which all materials share.
    std::vector<Surface> surfaces;
    std::vector<double> rounding, fixed;
    double poorest = budget_codes, most_reflected = 0.0;
    for (const MaterialPlan& material : plan.materials) {
        const Surface& s = surfaces.emplace_back(surface_of(plan, material, facts));
        rounding.push_back(rounding_codes(material, plan, s, light, exposure));
        fixed.push_back(rounding.back() + environment_codes(plan, material, s, exposure));
        if (!facts.drawn[rounding.size() - 1]) continue;
        poorest = std::min(poorest, budget_codes - fixed.back());
        most_reflected = std::max(most_reflected, s.albedo * material.lobe.scale + (s.specular ? s.reflectance * s.normalization : 0.0));
    }
    double cutoff_codes = 0.0;
    if (light.local > 0 && poorest > 0.0 && most_reflected > 0.0) {
        const double codes = kBudgetShares.cutoff * poorest, least = codes / (kSlopeAtBlack * exposure * most_reflected * light.local);
        for (std::size_t i = 0; i < plan.lights.size(); ++i) {
            LightPlan& one = plan.lights[i];
            if (one.type == LightType::directional) continue;
            const double cutoff = cutoff_squared(one, least);
            // A cutoff beyond all surfaces would cost a comparison per fragment and leave nothing out.
            one.cutoff_squared = cutoff < facts.light_farthest_squared[i] ? static_cast<float>(cutoff) : 0.0f;
            if (one.cutoff_squared > 0.0f) cutoff_codes = codes;
        }
    }

    for (std::size_t i = 0; i < plan.materials.size(); ++i) {
        if (!facts.drawn[i]) continue;
        MaterialPlan& material = plan.materials[i];
        const Surface& s = surfaces[i];
        ErrorBound bound;
        bound.rounding = rounding[i];
        bound.environment = fixed[i] - rounding[i];
        bound.left_out = cutoff_codes;
        double left = budget_codes - fixed[i] - cutoff_codes;
        if (left > 0.0) {
            bound.lobes = spend_on_lobe(material, may_split(plan, material), s, light, kBudgetShares.lobe * left, fits);
            left -= bound.lobes;
            bound.cells = spend_on_cells(plan, material, s, exposure, kBudgetShares.cells * left);
            left -= bound.cells;
            if (s.specular && light.count > 0) spend_on_specular(plan, material, s, light, exposure, left, fits, bound);
        }
        bound.codes = bound.rounding + bound.lobes + bound.specular + bound.environment + bound.cells + bound.left_out;
        if (bound.codes > worst.codes) worst = bound;
    }
    worst.codes = std::min(worst.codes, 255.0);
    worst.budget = budget_codes;
    worst.within = worst.codes <= budget_codes;
    plan.error = worst;
}

}  // namespace halflit::shading
