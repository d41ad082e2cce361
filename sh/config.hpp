// Compiler switches that every layer needs. Nothing here has a run-time cost.
#pragma once

/// Forces inlining, also at -O0, so that a function shared by code built for different instruction sets
/// leaves no symbol behind that the linker could merge (see shading/kernels/README.md).
#define HALFLIT_INLINE inline __attribute__((always_inline))

/// Traps on a broken precondition inside the library; never used for user input. Compiled out when NDEBUG is set.
#ifdef NDEBUG
#define HALFLIT_ASSERT(condition) ((void)0)
#else
#define HALFLIT_ASSERT(condition) ((condition) ? (void)0 : __builtin_trap())
#endif
