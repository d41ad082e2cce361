// Refuses compiler flags that change values: pixels would no longer be the same everywhere. The build includes this file ahead of each of
// our sources (cmake/libraries.cmake). Public headers do not include it, so a host may use any flags.
#pragma once

#include <cfloat>

#if defined(__FAST_MATH__)
#error "halflit: compile without -ffast-math and -Ofast, which change pixels"
#elif defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0
#error "halflit: compile without -ffinite-math-only, which changes pixels"
#elif defined(__RECIPROCAL_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__NO_SIGNED_ZEROS__)
#error "halflit: compile without -funsafe-math-optimizations and its parts, which change pixels"
#elif !defined(FLT_EVAL_METHOD) || FLT_EVAL_METHOD != 0
#error "halflit: floats have excess precision, which changes pixels; on 32-bit x86 compile with -msse2 -mfpmath=sse"
#endif
