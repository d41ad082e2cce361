// Needs -mavx2 and nothing above.
#if !defined(__AVX2__) || defined(__AVX512F__) || defined(__FMA__)
#error "build this file with -mavx2"
#endif
#define HALFLIT_ISA avx2
#define HALFLIT_ARCH avx2
#include "shading/kernels/shade_kernel.hpp"
