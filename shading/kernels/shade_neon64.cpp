// Needs AArch64, where Neon is part of the baseline.
#if !defined(__aarch64__)
#error "build this file for AArch64"
#endif
#define HALFLIT_ISA neon64
#define HALFLIT_ARCH neon64
#include "shading/kernels/shade_kernel.hpp"
