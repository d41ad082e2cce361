#if !defined(__AVX512F__)
#error "build with -mavx512f"
#endif
#define HALFLIT_ISA avx512
#define HALFLIT_ARCH avx512f
#include "raster/kernels/raster_kernel.hpp"

HALFLIT_DEFINE_RASTER_KERNELS(raster_kernels_avx512)
