#define HALFLIT_ISA scalar
#include "raster/kernels/raster_kernel.hpp"

HALFLIT_DEFINE_RASTER_KERNELS(raster_kernels_scalar)
