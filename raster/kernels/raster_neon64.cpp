#if !defined(__aarch64__)
#error "build for aarch64"
#endif
#define HALFLIT_ISA neon64
#define HALFLIT_ARCH neon64
#include "raster/kernels/raster_kernel.hpp"

HALFLIT_DEFINE_RASTER_KERNELS(raster_kernels_neon64)
