#if defined(__x86_64__) && defined(__SSE4_1__)
#error "build without -msse4.1"
#endif
#define HALFLIT_ISA sse2
#define HALFLIT_ARCH sse2
#include "raster/kernels/raster_kernel.hpp"

HALFLIT_DEFINE_RASTER_KERNELS(raster_kernels_sse2)
