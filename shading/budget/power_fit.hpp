// Powers as short polynomials made for one exponent: what a lobe and a highlight are computed with where an error budget allows it.
// Everything in double, and the same on every machine.
#pragma once

#include "shading/plan/plan.hpp"

#include <deque>

namespace halflit::shading {

/// t^n in [0, 1] as t (c[0] + c[1] u + c[2] u^2 + ..), u = sqrt(t), kLobeCurveTerms terms: the polynomial that keeps the largest error in
/// codes least, for light that is `amplitude` t^n (Remez). n >= 1; below, the derivative at 0 has no bound.
struct LobeFit {
    float c[kLobeCurveTerms];
    /// No sum of lights whose amplitudes sum up to `amplitude` is off by more; the kernel's own rounding included.
    double codes;
};
[[nodiscard]] LobeFit fit_lobe(double n, double amplitude);

/// x^h for x in [least, 1] as p(x)^(2^squarings), p of degree three.
struct SpecularFit {
    SpecularCurve curve;
    double rounding;    ///< relative error of the kernel's rounding, x's own included
    double root_error;  ///< of p as the 2^squarings-th root of x^h
    double least_root;  ///< the least that this root is
    /// Relative error where the highlight is `share` of its peak: largest where it is weakest.
    [[nodiscard]] double relative_error(double share) const;
    /// In 8-bit codes, for `count` lights that are `peak` at most: by concavity no more than one of `count` times the peak.
    [[nodiscard]] double codes(double peak, int count) const;
};
[[nodiscard]] SpecularFit fit_specular(double half_exponent, double least);

/// Fits kept from frame to frame: a lobe's takes some 50 us, a highlight's 10.
class PowerFits {
public:
    /// For lobes of one power under about as much light.
    [[nodiscard]] const LobeFit& lobe(double n, double amplitude);
    [[nodiscard]] const SpecularFit& specular(double half_exponent, double least);

private:
    struct LobeEntry {
        double n, amplitude;
        LobeFit fit;
    };
    struct SpecularEntry {
        double half_exponent, least;
        SpecularFit fit;
    };
    std::deque<LobeEntry> lobes_;
    std::deque<SpecularEntry> speculars_;
};

}  // namespace halflit::shading
