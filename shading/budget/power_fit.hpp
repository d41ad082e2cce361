// Powers as short polynomials, each made for one exponent. Lobes and highlights are computed with them where an error budget allows it. The
// fits are computed in double and are the same on every machine.
#pragma once

#include "shading/plan/plan.hpp"

#include <deque>

namespace halflit::shading {

/// Fit of t^n, t in [0, 1], as t (c[0] + c[1] u + c[2] u^2 + ..), u = sqrt(t), with kLobeCurveTerms terms. Its largest error in codes is
/// the least possible for light `amplitude` t^n (Remez). n >= 1; below, the derivative at 0 has no bound.
struct LobeFit {
    float c[kLobeCurveTerms];
    /// Bound on the error of lights whose amplitudes sum up to `amplitude`, the kernel's own rounding included.
    double codes;
};
/// `split_wrap`: the wrap w of a lobe whose excess over the core max(0, x), x = N.L, may be drawn alone (ShadowMode::soft_split). The error
/// of the fit is then compared with the excess, which is nearly black where f and the core are close. 0: f is always drawn whole.
[[nodiscard]] LobeFit fit_lobe(double n, double amplitude, double split_wrap = 0.0);

/// Fit of x^h, x in [least, 1], as p(x)^(2^squarings), p of SpecularCurve::terms terms. h is half the exponent of the cosine.
struct SpecularFit {
    SpecularCurve curve;
    double rounding;    ///< relative error of the kernel's rounding, x's own included
    double root_error;  ///< error of p as the 2^squarings-th root of x^h
    double least_root;  ///< least value of this root
    /// Relative error where the highlight is `share` of its peak: largest where it is weakest.
    [[nodiscard]] double relative_error(double share) const;
    /// Error in 8-bit codes for `count` lights of at most `peak`. By concavity it is no more than that of one light of `count` times the
    /// peak.
    [[nodiscard]] double codes(double peak, int count) const;
};
[[nodiscard]] SpecularFit fit_specular(double half_exponent, double least, int terms = SpecularCurve::kFewTerms);

/// Exact without a budget: highlights are 0 below kExactCut of their peak. Curves serve whose bound for the peak kExactPeak, in units of
/// white, is at most kExactCodes; others are computed by log2 and exp2.
inline constexpr double kExactCut = 1e-7, kExactPeak = 30.0, kExactCodes = 0.05;

/// Fits kept from frame to frame: a lobe's takes some 50 us, a highlight's 10 to 30.
class PowerFits {
public:
    /// Fit for lobes of the power n under light of about this amplitude.
    [[nodiscard]] const LobeFit& lobe(double n, double amplitude, double split_wrap);
    [[nodiscard]] const SpecularFit& specular(double half_exponent, double least, int terms);

private:
    struct LobeEntry {
        double n, amplitude, split_wrap;
        LobeFit fit;
    };
    struct SpecularEntry {
        double half_exponent, least;
        int terms;
        SpecularFit fit;
    };
    std::deque<LobeEntry> lobes_;
    std::deque<SpecularEntry> speculars_;
};

}  // namespace halflit::shading
