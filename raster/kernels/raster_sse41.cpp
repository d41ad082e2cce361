#if !defined(__SSE4_1__) || defined(__AVX__)
#error "build with -msse4.1 and no wider set"
#endif
#define HALFLIT_ISA sse41
#define HALFLIT_ARCH sse4_1
#include "raster/kernels/raster_kernel.hpp"

HALFLIT_DEFINE_RASTER_KERNELS(raster_kernels_sse41)
