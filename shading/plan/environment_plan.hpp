// What the kernels and the planner need to know of light from all around.
#pragma once

#include "sh/basis.hpp"

namespace halflit::shading {

/// How a lobe takes light from an environment, as the kernels read it: at unit normal N the sum of c[i] Y_i(N), not below 0.
struct EnvironmentPlan {
    int bands = 0;             ///< 1..10
    double bound = 0.0;        ///< of the error of leaving out the others, any normal, worst channel, before exposure
    bool within = true;        ///< whether that is within the tolerance asked for
    double bound_codes = 0.0;  ///< the same error in 8-bit sRGB codes; only where codes were asked for
    float red[sh::kMaxCoefficients]{}, green[sh::kMaxCoefficients]{}, blue[sh::kMaxCoefficients]{};

    /// The same sum as the kernels read it. With N = (x, y, z) it is a polynomial in z for each part of each power (x + iy)^m, of degree
    /// bands - 1 - m, in Newton form about kNodes: ((a[k] (z - node[k-1]) + a[k-1]) (z - node[k-2]) + ..) + a[0]. Coefficients in the order
    /// of use: m ascending, the degree descending; of each, red, green, blue of the real part and then, from m = 1 on, of the imaginary
    /// part.
    alignas(64) float newton[3 * sh::kMaxCoefficients]{};
};

/// About 0 alone (Horner's rule) the coefficients of ten bands are hundreds of times larger than the sum, which costs as many digits. These
/// are spread over [-1, 1] from the first ones on, each as far from the others as it can be, and are short, so that z - node is exact
/// where it is small. The last one is used by the planner only.
inline constexpr float kNodes[sh::kMaxBands] = {0.0f, 0.5f, -0.75f, 1.0f, -1.0f, 0.8125f, -0.4375f, -0.90625f, 0.9375f, 0.234375f};

/// How many bands to use.
struct EnvironmentOrder {
    int fixed = 0;                   ///< 1..10, or 0: the smallest whose bound is within the tolerance
    double tolerance = 1.0 / 510.0;  ///< of display white, in linear light: half an 8-bit code
    double exposure = 1.0;           ///< display white is 1 / exposure
    double codes = 0.0;              ///< when above 0, instead of the tolerance: 8-bit sRGB codes
    bool ten_bands_are_all = false;  ///< the light is defined by ten bands: leaving out none of them is no error
    bool operator==(const EnvironmentOrder&) const = default;
};

}  // namespace halflit::shading
