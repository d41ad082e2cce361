// Included by lobe_curve_<isa>.cpp after HALFLIT_ISA and HALFLIT_ARCH are defined.
#pragma once

#include "lobe_curve.hpp"
#include "shading/kernels/lobe_kernel.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

static void run_lobe(const shading::LobePlan& lobe, const float* x, float* out, int count) {
    for (int i = 0; i < count; i += kWidth) store(out + i, lobe_value(lobe, load(x + i)) * F(lobe.scale));
}

}  // namespace HALFLIT_ISA_NAMESPACE

namespace testing {
#define HALFLIT_LOBE_CURVE HALFLIT_CONCAT(lobe_curve_, HALFLIT_ISA)
extern const LobeCurve HALFLIT_LOBE_CURVE;
const LobeCurve HALFLIT_LOBE_CURVE = run_lobe;
}  // namespace testing
}  // namespace halflit
