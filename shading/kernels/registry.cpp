#include "shading/kernels/isa_select.hpp"
#include "shading/kernels/shade_kernels.hpp"

namespace halflit::shading {

HALFLIT_DECLARE_TABLES(ShadeKernels, shade_kernels)

const ShadeKernels& shade_kernels(Isa isa) {
    HALFLIT_ASSERT(isa_available(isa));
    HALFLIT_RETURN_TABLE_OF(isa, shade_kernels)
}

}  // namespace halflit::shading
