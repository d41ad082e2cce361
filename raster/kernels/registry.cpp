#include "raster/kernels/raster_kernels.hpp"

#include "shading/kernels/isa_select.hpp"

namespace halflit::raster {

HALFLIT_DECLARE_TABLES(RasterKernels, raster_kernels)

const RasterKernels& raster_kernels(Isa isa) { HALFLIT_RETURN_TABLE_OF(isa, raster_kernels) }

}  // namespace halflit::raster
