// Picks one of a family of tables that exist once for each instruction set that is built: NAME_scalar, NAME_sse2, NAME_avx2 and so on,
// whatever their type. A target that uses it is compiled with HALFLIT_HAVE_<SET> for each of its sets.
#pragma once

#include "shading/kernels/isa.hpp"

#ifdef HALFLIT_HAVE_SSE2
#define HALFLIT_CASE_SSE2(name)          \
    case ::halflit::shading::Isa::sse2: \
        return name##_sse2;
#else
#define HALFLIT_CASE_SSE2(name)
#endif
#ifdef HALFLIT_HAVE_SSE41
#define HALFLIT_CASE_SSE41(name)          \
    case ::halflit::shading::Isa::sse41: \
        return name##_sse41;
#else
#define HALFLIT_CASE_SSE41(name)
#endif
#ifdef HALFLIT_HAVE_AVX2
#define HALFLIT_CASE_AVX2(name)          \
    case ::halflit::shading::Isa::avx2: \
        return name##_avx2;
#else
#define HALFLIT_CASE_AVX2(name)
#endif
#ifdef HALFLIT_HAVE_AVX512
#define HALFLIT_CASE_AVX512(name)          \
    case ::halflit::shading::Isa::avx512: \
        return name##_avx512;
#else
#define HALFLIT_CASE_AVX512(name)
#endif
#ifdef HALFLIT_HAVE_NEON64
#define HALFLIT_CASE_NEON64(name)          \
    case ::halflit::shading::Isa::neon64: \
        return name##_neon64;
#else
#define HALFLIT_CASE_NEON64(name)
#endif

/// The body of a function that returns the table of `isa`; of scalar when that set is not built.
#define HALFLIT_RETURN_TABLE_OF(isa, name) \
    switch (isa) {                         \
        HALFLIT_CASE_SSE2(name)            \
        HALFLIT_CASE_SSE41(name)           \
        HALFLIT_CASE_AVX2(name)            \
        HALFLIT_CASE_AVX512(name)          \
        HALFLIT_CASE_NEON64(name)          \
        default:                           \
            return name##_scalar;          \
    }
