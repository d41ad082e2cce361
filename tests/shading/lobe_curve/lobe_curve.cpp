#include "lobe_curve.hpp"

namespace halflit::testing {

extern const LobeCurve lobe_curve_scalar, lobe_curve_sse2, lobe_curve_sse41, lobe_curve_avx2, lobe_curve_avx512, lobe_curve_neon64;

LobeCurve lobe_curve(shading::Isa isa) {
    switch (isa) {
#ifdef HALFLIT_HAVE_SSE2
        case shading::Isa::sse2:
            return lobe_curve_sse2;
#endif
#ifdef HALFLIT_HAVE_SSE41
        case shading::Isa::sse41:
            return lobe_curve_sse41;
#endif
#ifdef HALFLIT_HAVE_AVX2
        case shading::Isa::avx2:
            return lobe_curve_avx2;
#endif
#ifdef HALFLIT_HAVE_AVX512
        case shading::Isa::avx512:
            return lobe_curve_avx512;
#endif
#ifdef HALFLIT_HAVE_NEON64
        case shading::Isa::neon64:
            return lobe_curve_neon64;
#endif
        default:
            return lobe_curve_scalar;
    }
}

}  // namespace halflit::testing
