#include "lobe_curve.hpp"

#include "shading/kernels/isa_select.hpp"

namespace halflit::testing {

extern const LobeCurve lobe_curve_scalar, lobe_curve_sse2, lobe_curve_sse41, lobe_curve_avx2, lobe_curve_avx512, lobe_curve_neon64;

LobeCurve lobe_curve(shading::Isa isa) {
    HALFLIT_RETURN_TABLE_OF(isa, lobe_curve)
}

}  // namespace halflit::testing
