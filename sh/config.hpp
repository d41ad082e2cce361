// Compiler switches that every layer needs. Nothing here has a run-time cost.
#pragma once

#include "halflit/math.hpp"  // HALFLIT_INLINE
#include "sh/value_flags.hpp"

/// Traps on a broken precondition inside the library; never used for user input. Compiled out when NDEBUG is set.
#ifdef NDEBUG
#define HALFLIT_ASSERT(condition) ((void)0)
#else
#define HALFLIT_ASSERT(condition) ((condition) ? (void)0 : __builtin_trap())
#endif
