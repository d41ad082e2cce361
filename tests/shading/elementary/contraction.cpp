// HALFLIT_ISA is `contracted` or `uncontracted` here. The kernels' source takes it for one lane without an architecture.
#include "contraction.hpp"

#include "shading/kernels/pow.hpp"

namespace halflit::testing {

void HALFLIT_CONCAT(power_, HALFLIT_ISA)(const float* t, float* out, int count) {
    constexpr float kPowerMinusOne = 1.3f - 1.0f, kHigh = 0.299999237f;  // kHigh: the upper 18 bits of kPowerMinusOne
    for (int i = 0; i < count; ++i) out[i] = power_of_unit(t[i], kPowerMinusOne, kHigh, kPowerMinusOne - kHigh);
}

}  // namespace halflit::testing
