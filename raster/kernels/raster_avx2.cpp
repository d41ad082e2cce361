#if !defined(__AVX2__) || defined(__AVX512F__)
#error "build with -mavx2 and no wider set"
#endif
#define HALFLIT_ISA avx2
#define HALFLIT_ARCH avx2
#include "raster/kernels/raster_kernel.hpp"

HALFLIT_DEFINE_RASTER_KERNELS(raster_kernels_avx2)
