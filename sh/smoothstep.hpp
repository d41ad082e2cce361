// The cubic step between 0 and 1.
#pragma once

#include "sh/config.hpp"

namespace halflit {

/// 0 for t <= 0, 1 for t >= 1, and 3 t^2 - 2 t^3 between them; 0 for NaN.
[[nodiscard]] HALFLIT_INLINE constexpr double smoothstep(double t) {
    const double x = t > 0.0 ? t < 1.0 ? t : 1.0 : 0.0;
    return x * x * (3.0 - 2.0 * x);
}

}  // namespace halflit
