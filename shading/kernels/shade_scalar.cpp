// Needs the compiler's baseline, no instruction set flags.
#if defined(__SSE4_1__) || defined(__AVX__)
#error "build this file without instruction set flags: it is the path for every CPU"
#endif
#define HALFLIT_ISA scalar
#include "shading/kernels/shade_kernel.hpp"
