#include "raster/kernels/raster_kernels.hpp"

#include "shading/kernels/isa_select.hpp"

namespace halflit::raster {

extern const RasterKernels raster_kernels_scalar, raster_kernels_sse2, raster_kernels_sse41, raster_kernels_avx2, raster_kernels_avx512, raster_kernels_neon64;

const RasterKernels& raster_kernels(shading::Isa isa) {
    HALFLIT_RETURN_TABLE_OF(isa, raster_kernels)
}

}  // namespace halflit::raster
