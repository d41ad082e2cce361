// Needs -msse4.1 and nothing above.
#if !defined(__SSE4_1__) || defined(__AVX__)
#error "build this file with -msse4.1"
#endif
#define HALFLIT_ISA sse41
#define HALFLIT_ARCH sse4_1
#include "shading/kernels/shade_kernel.hpp"
