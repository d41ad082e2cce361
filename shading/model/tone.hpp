// Tone curves: their constants, and how much an error of light may grow by them. Formulas: shading/README.md.
#pragma once

#include "halflit/shading.hpp"

namespace halflit::shading {

/// Luminance of linear light with Rec. 709 primaries; [Rein02] divides light by 1 + luminance.
inline constexpr double kLumaRed = 0.2126, kLumaGreen = 0.7152, kLumaBlue = 0.0722;

/// [Nar16]: x (a x + b) / (x (c x + d) + e).
inline constexpr double kAcesA = 2.51, kAcesB = 0.03, kAcesC = 2.43, kAcesD = 0.59, kAcesE = 0.14;

/// [PBRN]: F90, the reflection that is taken off; the peak from which light is compressed; the speed of desaturation.
inline constexpr double kNeutralF90 = 0.04, kNeutralStart = 0.8 - kNeutralF90, kNeutralDesaturation = 0.15;

/// Light above this counts as this. The kernels' products stay finite.
inline constexpr float kMostTonedLight = 1e18f;

/// Upper bounds on the growth of errors by the curve. Proof: budget/DERIVATION.md.
/// absolute: where each channel of the light is off by at most d, each toned channel is off by at most this times d.
/// relative: where each channel is off by at most a factor 1 + r, each code is off by at most this times 112.1 ln(1 + r).
/// other: where each channel of the light is off by at most b codes without the curve, each code is off by at most this times b. The code
/// of light above 1 is continued by its slope there, as 255 + 112.1 ln v.
[[nodiscard]] constexpr ErrorGrowth tone_growth(ToneCurve curve) {
    switch (curve) {
        case ToneCurve::none:
            break;
        case ToneCurve::reinhard:
            return {.absolute = 2.0, .relative = 2.0, .other = 2.02};
        case ToneCurve::aces:
            return {.absolute = 1.81, .relative = 0.66, .other = 1.6};
        case ToneCurve::neutral:
            return {.absolute = 2.07, .relative = 2.02, .other = 6.2};
    }
    return {};
}

}  // namespace halflit::shading
