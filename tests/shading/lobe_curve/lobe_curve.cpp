#include "lobe_curve.hpp"

namespace halflit::testing {

extern const LobeCurve lobe_curve_scalar, lobe_curve_sse2, lobe_curve_sse41, lobe_curve_avx2, lobe_curve_avx512, lobe_curve_neon64;

LobeCurve lobe_curve(shading::Isa isa) {
    switch (isa) {
#if defined(__x86_64__)
        case shading::Isa::sse2:
            return lobe_curve_sse2;
        case shading::Isa::sse41:
            return lobe_curve_sse41;
        case shading::Isa::avx2:
            return lobe_curve_avx2;
        case shading::Isa::avx512:
            return lobe_curve_avx512;
#elif defined(__aarch64__)
        case shading::Isa::neon64:
            return lobe_curve_neon64;
#endif
        default:
            return lobe_curve_scalar;
    }
}

}  // namespace halflit::testing
