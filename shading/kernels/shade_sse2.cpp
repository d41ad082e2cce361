// Needs x86-64's baseline.
#if !defined(__SSE2__) || defined(__SSE4_1__)
#error "build this file for plain x86-64"
#endif
#define HALFLIT_ISA sse2
#define HALFLIT_ARCH sse2
#include "shading/kernels/shade_kernel.hpp"
