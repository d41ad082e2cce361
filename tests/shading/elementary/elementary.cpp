#include "elementary.hpp"

namespace halflit::testing {

extern const Elementary elementary_scalar, elementary_sse2, elementary_sse41, elementary_avx2, elementary_avx512, elementary_neon64;

const Elementary& elementary(shading::Isa isa) {
    switch (isa) {
#ifdef HALFLIT_HAVE_SSE2
        case shading::Isa::sse2:
            return elementary_sse2;
#endif
#ifdef HALFLIT_HAVE_SSE41
        case shading::Isa::sse41:
            return elementary_sse41;
#endif
#ifdef HALFLIT_HAVE_AVX2
        case shading::Isa::avx2:
            return elementary_avx2;
#endif
#ifdef HALFLIT_HAVE_AVX512
        case shading::Isa::avx512:
            return elementary_avx512;
#endif
#ifdef HALFLIT_HAVE_NEON64
        case shading::Isa::neon64:
            return elementary_neon64;
#endif
        default:
            return elementary_scalar;
    }
}

}  // namespace halflit::testing
