#include "raster/kernels/raster_kernels.hpp"

namespace halflit::raster {

extern const RasterKernels raster_kernels_scalar, raster_kernels_sse2, raster_kernels_sse41, raster_kernels_avx2, raster_kernels_avx512, raster_kernels_neon64;

const RasterKernels& raster_kernels(shading::Isa isa) {
    switch (isa) {
#ifdef HALFLIT_HAVE_SSE2
        case shading::Isa::sse2: return raster_kernels_sse2;
        case shading::Isa::sse41: return raster_kernels_sse41;
        case shading::Isa::avx2: return raster_kernels_avx2;
        case shading::Isa::avx512: return raster_kernels_avx512;
#endif
#ifdef HALFLIT_HAVE_NEON64
        case shading::Isa::neon64: return raster_kernels_neon64;
#endif
        default: return raster_kernels_scalar;
    }
}

}  // namespace halflit::raster
