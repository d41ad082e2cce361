// Needs -mavx512f -mavx2.
#if !defined(__AVX512F__) || !defined(__AVX2__)
#error "build this file with -mavx512f -mavx2"
#endif
#define HALFLIT_ISA avx512
#define HALFLIT_ARCH avx512f
#include "shading/kernels/shade_kernel.hpp"
