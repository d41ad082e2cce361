#include "shading/budget/error_budget.hpp"

#include "sh/power.hpp"
#include "shading/budget/power_fit.hpp"
#include "shading/budget/surface_bounds.hpp"
#include "shading/model/scalar.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace halflit::shading {
namespace {

/// Fewest lights without shadow maps for which light in cells pays.
constexpr int kLeastCellLights = 8;

/// `amplitude`: strength of lights that shadows may split; 0: none.
double lobe_tier_codes(const CodeCosts& costs, const LobePlan& lobe, PowTier tier, double amplitude) {
    if (lobe.path != LobePath::general || lobe.power_minus_one >= kSharpPowerMinusOne || tier == PowTier::exact) return 0.0;
    const PowErrors errors = pow_errors(tier);
    const double a = std::fabs(static_cast<double>(lobe.power_minus_one));
    const double relative = 0.5 * kLn2 * a * errors.log2 + errors.exp2 + 4e-6;
    return costs.relative(relative) + costs.absolute(amplitude * relative);
}

double specular_tier_codes(const CodeCosts& costs, const Surface& s, const Arriving& light, PowTier tier) {
    if (!s.specular || tier == PowTier::exact) return 0.0;
    const PowErrors errors = pow_errors(tier);
    return costs.specular(s.reflectance * s.normalization * light.largest, light.count, errors.exp2, errors.log2);
}

/// Two sums of products of the same numbers, added up in float32 and multiplied by the same factors, are apart by no more than this share.
double rounding_codes(const CodeCosts& costs, const MaterialPlan& material, const Arriving& light) {
    return costs.relative(1e-5 + 3e-7 * (material.lobe.power_minus_one + 1.0 + light.count));
}

/// Codes of the bands that the material's environment leaves out.
double environment_codes(const ShadingPlan& plan, const MaterialPlan& material) {
    return material.environment < 0 ? 0.0 : plan.environments[static_cast<std::size_t>(material.environment)].bound_codes;
}

/// True if the bound counts material i: an object is made of it, and it has a colour of its own.
bool counts(const ShadingPlan& plan, const SceneFacts& facts, std::size_t i) {
    return facts.drawn[i] && (plan.materials[i].stages & kStageShadowCatcher) == 0;
}

/// Half the exponent of a curve's cosine; Phong's cosine counts for a quarter of it.
double half_exponent_of(const ShadingPlan& plan, double exponent) {
    return exponent * (plan.specular == SpecularModel::phong ? 0.125 : 0.5);
}

template <class Codes>
PowTier cheapest_tier(double budget, const Codes& codes) {
    for (const PowTier tier : {PowTier::fast, PowTier::display})
        if (codes(tier) <= budget) return tier;
    return PowTier::exact;
}

/// Chooses the cheapest method for t^n within `budget` codes. Returns the codes that it costs.
double spend_on_lobe(const CodeCosts& costs, MaterialPlan& material, bool split, const Surface& s, const Arriving& light, double budget,
                     PowerFits& fits) {
    LobePlan& lobe = material.lobe;
    if (lobe.path != LobePath::general || lobe.power_minus_one >= kSharpPowerMinusOne) return 0.0;
    const double amplitude = s.albedo * static_cast<double>(lobe.scale) * light.sum;
    const LobeFit& fit =
        fits.lobe(static_cast<double>(lobe.power_minus_one) + 1.0, amplitude, split ? static_cast<double>(lobe.wrap) : 0.0);
    if (const double curve_codes = costs.other(fit.codes); curve_codes <= budget) {
        lobe.path = LobePath::curve;
        std::copy_n(fit.c, kLobeCurveTerms, lobe.curve);
        return curve_codes;
    }
    const auto codes = [&](PowTier tier) { return lobe_tier_codes(costs, lobe, tier, split ? amplitude : 0.0); };
    lobe.tier = cheapest_tier(budget, codes);
    return codes(lobe.tier);
}

/// True if light in cells serves the material: many lights without shadow maps, smooth normals, a lobe that has its bounds.
bool may_use_cells(const ShadingPlan& plan, const MaterialPlan& material, const Surface& s) {
    const auto has = [&](Stage stage) { return (material.stages & stage) != 0; };
    const auto casts_none = [](const LightPlan& light) { return light.shadow_map < 0; };
    const double n = static_cast<double>(material.lobe.power_minus_one) + 1.0;
    if (material.ggx || !has(kStageLights) || material.alpha_mode == AlphaMode::blend || (material.stages & kStagesWithoutCells) != 0 ||
        !(n >= 1.0 && n <= 3.0))
        return false;
    if (s.albedo <= 0.0) return false;
    return std::count_if(plan.lights.begin(), plan.lights.end(), casts_none) >= kLeastCellLights;
}

/// Lets the light of a material be fitted over cells, within `budget` codes. Returns the codes that it costs.
double spend_on_cells(const CodeCosts& costs, MaterialPlan& material, const Surface& s, double exposure, double budget) {
    CellTolerance& cells = material.cells;
    const double r = kBudgetShares.cells_relative * budget / costs.at_white(), scale = material.lobe.scale;
    const auto at_most_1e30 = [](double x) { return static_cast<float>(std::min(1e30, x)); };
    double absolute_codes = (1.0 - kBudgetShares.cells_relative) * budget;
    if (s.specular) {
        constexpr double kMostRatio = 100.0;
        const double least = s.least_albedo * scale, ratio = least > 0.0 ? s.reflectance_at_least / least : kMostRatio;
        if (ratio < kMostRatio) {
            cells.specular_ratio = static_cast<float>(std::max(1e-6, 1.001 * ratio));  // 0 has another meaning
            cells.absolute_specular = 3e38f;
        } else {
            absolute_codes *= 0.5;
            cells.absolute_specular = at_most_1e30(0.999 * absolute_codes / (costs.at_black() * exposure * s.reflectance));
        }
        cells.half_exponent = static_cast<float>(0.5 * specular_exponent(material.roughness));
        cells.peak = static_cast<float>(1.001 * s.normalization);
    }
    cells.relative = static_cast<float>(0.999 * r / (1.0 + r));  // the drawn light may be the smaller one
    cells.absolute = at_most_1e30(0.999 * absolute_codes / (costs.at_black() * exposure * s.albedo * scale));
    return budget;
}

/// True if highlights are below the threshold at 45 degrees from their middle. If not, the test costs more than it saves.
bool specular_ends(const ShadingPlan& plan, const Surface& s, double largest, double threshold) {
    const double z = 0.25 * s.exponent * (plan.specular == SpecularModel::phong ? 0.25 : 1.0), z2 = z * z, z4 = z2 * z2;
    return 40320.0 * largest * s.normalization <= threshold * z4 * z4;
}

/// Codes by which the exact picture's curve for highlights, if it has one, differs from the power, what it cuts off included.
double exact_curve_codes(const CodeCosts& costs, const ShadingPlan& plan, const MaterialPlan& material, const Surface& s,
                         const Arriving& light, PowerFits& fits) {
    const SpecularFit* const fit = exact_highlight(plan, material, fits);
    const double peak = s.reflectance * s.normalization * light.largest;
    return fit == nullptr ? 0.0 : costs.other(fit->codes(peak, light.count)) + costs.absolute(kExactCut * peak * light.count);
}

/// Chooses the cheapest method for highlights within `budget` codes. Adds the codes that it costs to the bound.
void spend_on_specular(const CodeCosts& costs, const ShadingPlan& plan, MaterialPlan& material, const Surface& s, const Arriving& light,
                       double exposure, double budget, bool with_cells, PowerFits& fits, ErrorBound& bound) {
    // Highlights below this, before the reflectance, can be left out at a cost of `codes` codes.
    const auto threshold_of = [&](double codes) { return codes / (costs.at_black() * exposure * s.reflectance * light.count); };
    const double peak = s.reflectance * s.normalization * light.largest;
    std::optional<SpecularFit> exact;  // a copy, as further fits may take its place
    if (const SpecularFit* const fit = exact_highlight(plan, material, fits)) exact = *fit;
    const double exact_codes = exact ? costs.other(exact->codes(peak, light.count)) : 0.0;
    if (!roughness_varies(material) && budget > 0.0) {
        const double half_exponent = half_exponent_of(plan, s.exponent);
        // What the exact curve cuts off is not there.
        const double share = std::max(threshold_of(kBudgetShares.specular_cut * budget) / (light.largest / exposure * s.normalization),
                                      exact ? kExactCut : 0.0);
        for (const int terms : {SpecularCurve::kFewTerms, SpecularCurve::kMostTerms}) {
            const SpecularFit& fit = fits.specular(half_exponent, share < 1.0 ? power_of(share, 1.0 / half_exponent) : 1.0, terms);
            const double codes = costs.other(fit.codes(peak, light.count)) + exact_codes;
            if (codes > kBudgetShares.specular_curve * budget) continue;
            material.specular_curve = fit.curve;
            bound.specular = codes;
            bound.left_out += kBudgetShares.specular_cut * budget;
            return;
        }
    }
    if (exact) material.specular_curve = exact->curve;
    if (exact && with_cells) {
        bound.specular = exact_codes;
        bound.left_out += costs.absolute(kExactCut * peak * light.count);
    }
    if (exact || budget <= 0.0) return;
    material.specular_tier =
        cheapest_tier(kBudgetShares.specular_power * budget, [&](PowTier tier) { return specular_tier_codes(costs, s, light, tier); });
    bound.specular = specular_tier_codes(costs, s, light, material.specular_tier);
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

double surfaces_in_a_pixel(const ShadingPlan& plan, const SceneFacts& facts) {
    double surfaces = 1.0;
    for (std::size_t i = 0; i < plan.materials.size(); ++i) {
        if (!facts.drawn[i]) continue;
        const MaterialPlan& material = plan.materials[i];
        const bool transmits = (material.stages & kStageTransmission) != 0;
        if ((material.stages & kStageShadowCatcher) != 0 || (transmits && !material.transmission.looked_through)) return 0.0;
        if (transmits) surfaces = 2.0;
    }
    return surfaces;
}

double texels_of(const ShadingPlan& plan, const SceneFacts& facts) {
    std::set<const Texture*> textures;
    double texels = 0.0;
    for (std::size_t i = 0; i < plan.materials.size(); ++i) {
        if (!counts(plan, facts, i)) continue;
        for (const TexturePlan& texture : plan.materials[i].textures)
            if (texture.data != nullptr && textures.insert(texture.source).second)
                texels += static_cast<double>(texture.width[0]) * texture.height[0];
    }
    return texels;
}

const SpecularFit* exact_highlight(const ShadingPlan& plan, const MaterialPlan& material, PowerFits& fits) {
    constexpr std::uint32_t kNeeded = kStageLights | kStageSpecular;
    if (material.ggx || (material.stages & kNeeded) != kNeeded || roughness_varies(material)) return nullptr;
    const double half_exponent = half_exponent_of(plan, specular_exponent(static_cast<double>(material.roughness)));
    if (!(half_exponent > 1.0)) return nullptr;
    const SpecularFit& fit = fits.specular(half_exponent, power_of(kExactCut, 1.0 / half_exponent), SpecularCurve::kMostTerms);
    return fit.codes(kExactPeak, 1) <= kExactCodes ? &fit : nullptr;
}

bool spend_error_budget(ShadingPlan& plan, double budget_codes, const CodeCosts& costs, double exposure, const SceneFacts& facts,
                        PowerFits& fits) {
    HALFLIT_ASSERT(facts.light_attenuation.size() == plan.lights.size());
    const Arriving light = arriving(plan, exposure, facts);
    // Light from behind glass is a mean of other surfaces' light, times at most 1: it brings the errors of the worst of them.
    const double surfaces_seen = surfaces_in_a_pixel(plan, facts), budget = budget_codes / surfaces_seen;
    HALFLIT_ASSERT(surfaces_seen > 0.0);

    // The codes that the poorest material has left for the cutoff radii, which all materials share.
    std::vector<Surface> surfaces;
    std::vector<double> fixed;
    double poorest = budget, most_reflected = 0.0;
    for (std::size_t i = 0; i < plan.materials.size(); ++i) {
        const MaterialPlan& material = plan.materials[i];
        const Surface& s = surfaces.emplace_back(surface_of(plan, material, facts));
        const double environment = environment_codes(plan, material);
        fixed.push_back(environment + rounding_codes(costs, material, light));
        if (!counts(plan, facts, i)) continue;
        if (environment > 0.0 && fixed[i] > budget) return false;
        // A light's absolute error is taken for colours up to 1, as is that of the light from behind glass.
        if ((environment > 0.0 || surfaces_seen > 1.0) && s.albedo > 1.0) return false;
        poorest = std::min(poorest, budget - fixed[i]);
        most_reflected =
            std::max(most_reflected, s.albedo * material.lobe.scale + (s.specular ? s.reflectance * s.normalization : 0.0) + s.layers);
    }
    double cutoff_codes = 0.0;
    if (light.local > 0 && poorest > 0.0 && most_reflected > 0.0) {
        const double codes = kBudgetShares.cutoff * poorest;
        const double least = codes / (costs.at_black() * exposure * most_reflected * light.local);
        for (std::size_t i = 0; i < plan.lights.size(); ++i) {
            LightPlan& one = plan.lights[i];
            if (!kind_of(one.type).placed) continue;
            const double cutoff = cutoff_squared(one, least);
            // A cutoff beyond all surfaces would cost a comparison per fragment and leave nothing out.
            one.cutoff_squared = cutoff < facts.light_farthest_squared[i] ? static_cast<float>(cutoff) : 0.0f;
            if (one.cutoff_squared > 0.0f) cutoff_codes = codes;
        }
    }

    ErrorBound worst;
    for (std::size_t i = 0; i < plan.materials.size(); ++i) {
        MaterialPlan& material = plan.materials[i];
        if (!counts(plan, facts, i)) continue;
        const Surface& s = surfaces[i];
        ErrorBound bound;
        bound.environment = environment_codes(plan, material);
        bound.rounding = fixed[i] - bound.environment;
        bound.left_out = cutoff_codes;
        double left = budget - fixed[i] - cutoff_codes;
        if (left > 0.0) bound.lobes = spend_on_lobe(costs, material, may_split(plan, material), s, light, kBudgetShares.lobe * left, fits);
        left -= bound.lobes;
        double of_cells = left > 0.0 && may_use_cells(plan, material, s) ? kBudgetShares.cells * left : 0.0;
        // Cells expand highlights themselves, and so differ from the exact curve's by its error, which has to fit into the highlights'
        // share.
        if (of_cells > 0.0 && s.specular && exact_curve_codes(costs, plan, material, s, light, fits) > left - of_cells) of_cells = 0.0;
        if (s.specular && light.count > 0 && !material.ggx)
            spend_on_specular(costs, plan, material, s, light, exposure, left - of_cells, of_cells > 0.0, fits, bound);
        left -= bound.specular + (bound.left_out - cutoff_codes);
        if (of_cells > 0.0 && left > 0.0) bound.cells = spend_on_cells(costs, material, s, exposure, kBudgetShares.cells_of_rest * left);
        const double parts = bound.lobes + bound.specular + bound.environment + bound.cells + bound.left_out;
        if (parts == 0.0) continue;  // the exact picture's own numbers
        bound.codes = bound.rounding + parts;
        if (bound.codes > worst.codes) worst = bound;
    }
    for (double* const part :
         {&worst.codes, &worst.rounding, &worst.lobes, &worst.specular, &worst.environment, &worst.cells, &worst.left_out})
        *part *= surfaces_seen;
    worst.budget = budget_codes;
    worst.tone_growth = costs.growth();
    plan.error = worst;
    return true;
}

}  // namespace halflit::shading
