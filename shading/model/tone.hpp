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

/// Upper bound on the growth of errors by the curve, at least 1: where each channel of the light is off by at most b codes without the
/// curve, each channel is off by at most this times b codes with it. The code of light above 1 is continued by its slope there, as
/// 255 + 112.1 ln v. Proof: budget/DERIVATION.md.
[[nodiscard]] constexpr double tone_growth(ToneCurve curve) {
    switch (curve) {
        case ToneCurve::none:
            break;
        case ToneCurve::reinhard:
            return 2.02;
        case ToneCurve::aces:
            return 1.6;
        case ToneCurve::neutral:
            return 6.2;
    }
    return 1.0;
}

}  // namespace halflit::shading
