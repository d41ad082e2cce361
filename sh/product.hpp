// Products of expansions, as in triple product integrals: visibility times radiance, or one sky through another's colour.
#pragma once

#include "sh/coefficients.hpp"

namespace halflit::sh {

/// The expansion of d -> A(d) B(d), channel by channel. The product of M and N bands has M + N - 1 bands; those from `bands` on (at most
/// 10 are kept) are dropped, the others are exact: Gaunt's integrals are taken by a quadrature that is exact for them.
[[nodiscard]] RadianceSh product(const RadianceSh& a, const RadianceSh& b, int bands);

}  // namespace halflit::sh
