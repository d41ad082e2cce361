// Names for the plan's enumerators, in flags and reports.
#pragma once

#include "halflit/splats.hpp"
#include "raster/settings_table.hpp"
#include "shading/plan/plan.hpp"

#include <cstddef>
#include <string_view>

namespace halflit::engine {

constexpr std::string_view alpha_mode_name(AlphaMode mode) {
    constexpr std::string_view kNames[] = {"opaque", "mask", "blend"};
    return kNames[static_cast<std::size_t>(mode)];
}

constexpr std::string_view splat_reference_name(SplatReference reference) {
    constexpr std::string_view kNames[] = {"inria", "inria_aa", "khr", "mip"};
    return kNames[static_cast<std::size_t>(reference)];
}

using raster::kAccuracyNames;
constexpr std::string_view accuracy_name(Accuracy accuracy) { return kAccuracyNames[static_cast<std::size_t>(accuracy)]; }

using raster::kSpecularNames;

constexpr std::string_view tier_name(shading::PowTier tier) {
    constexpr std::string_view kNames[] = {"exact", "degrees 5, 4", "degrees 3, 3"};
    return kNames[static_cast<std::size_t>(tier)];
}

/// Method for a material's highlights: a fitted curve, or a tier of polynomials.
constexpr std::string_view specular_power_name(const shading::MaterialPlan& plan) {
    return plan.specular_curve.squarings >= 0 ? "curve" : tier_name(plan.specular_tier);
}

/// Method for a lobe t^n, t = max(0, (N.L + w) / (1 + w)) with wrap w and power n.
constexpr std::string_view lobe_path_name(shading::LobePath path) {
    constexpr std::string_view kNames[] = {"step", "t", "t*t", "t*sqrt(t)", "t^n, n whole", "t^n", "t^n as a curve"};
    return kNames[static_cast<std::size_t>(path)];
}

using raster::kRateNames;
constexpr std::string_view rate_name(ShadingRate rate) { return kRateNames[static_cast<std::size_t>(rate)]; }

using raster::kToneCurveNames;
constexpr std::string_view tone_curve_name(ToneCurve curve) { return kToneCurveNames[static_cast<std::size_t>(curve)]; }

using raster::kTextureDetailNames;
constexpr std::string_view texture_detail_name(TextureDetail detail) { return kTextureDetailNames[static_cast<std::size_t>(detail)]; }

using raster::kShadowModeNames;
constexpr std::string_view shadow_mode_name(ShadowMode mode) { return kShadowModeNames[static_cast<std::size_t>(mode)]; }

}  // namespace halflit::engine
