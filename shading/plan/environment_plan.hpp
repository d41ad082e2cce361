// Environment light as the planner makes it and the kernels read it.
#pragma once

#include "sh/basis.hpp"

#include <memory>

namespace halflit::shading {

struct IrradianceMap;

/// An environment's light through one lobe: at unit normal N the sum of c[i] Y_i(N), not below 0. c is `red`, `green`, `blue`; Y_i:
/// sh/basis.hpp. Or a map.
struct EnvironmentPlan {
    int bands = 0;             ///< 1..10; 0: the map
    double bound = 0.0;        ///< bound on the error of the bands left out and of the suns: any normal, worst channel, before exposure
    bool within = true;        ///< the bound is within the tolerance asked for
    double bound_codes = 0.0;  ///< bound on the difference from the exact picture's light, in 8-bit sRGB codes
    /// Light at a zero normal, whose N.L is 0 for every direction: f(0) / pi times the integral of the radiance. The series has no meaning
    /// there.
    float at_zero_normal[3]{};
    float red[sh::kMaxCoefficients]{}, green[sh::kMaxCoefficients]{}, blue[sh::kMaxCoefficients]{};

    /// The same sum in the form that the kernels compute. With N = (x, y, z), each of the real and imaginary parts of (x + iy)^m has as its
    /// factor a polynomial in z, of degree bands - 1 - m, in Newton form about kNodes: ((a[k] (z - node[k-1]) + a[k-1]) (z - node[k-2]) +
    /// ..) + a[0]. The coefficients are in the order of use: m ascending, then the degree descending. For each there are red, green, blue
    /// of the real part and then, from m = 1 on, of the imaginary part.
    alignas(64) float newton[3 * sh::kMaxCoefficients]{};

    /// IrradianceMap's values and rows; map_turned: as ReflectionPlan::turned.
    const float* map = nullptr;
    float map_rows = 0, map_turned = 0;
    std::shared_ptr<const IrradianceMap> kept_map;  ///< keeps `map` alive
};

/// Nodes of the Newton form. About 0 alone (Horner's rule) the coefficients of ten bands are hundreds of times larger than the sum, and the
/// digits of that factor are lost. The nodes are therefore spread over [-1, 1], each as far from the ones before as it can be. They have
/// few bits, so that z - node is exact where it is small. The last one is used by the planner only.
inline constexpr float kNodes[sh::kMaxBands] = {0.0f, 0.5f, -0.75f, 1.0f, -1.0f, 0.8125f, -0.4375f, -0.90625f, 0.9375f, 0.234375f};

}  // namespace halflit::shading
