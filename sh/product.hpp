// Products of expansions, as in triple product integrals: visibility times radiance, or a sky filtered by another sky's colour.
#pragma once

#include "sh/coefficients.hpp"

namespace halflit::sh {

/// Expansion of d -> A(d) B(d), channel by channel. The product of M and N bands has M + N - 1 bands. The first `bands` of them are kept,
/// at most 10, and are exact: the quadrature is exact for Gaunt's integrals.
[[nodiscard]] RadianceSh product(const RadianceSh& a, const RadianceSh& b, int bands);

}  // namespace halflit::sh
