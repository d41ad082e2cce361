#include "elementary.hpp"

#include "shading/kernels/isa_select.hpp"

namespace halflit::testing {

extern const Elementary elementary_scalar, elementary_sse2, elementary_sse41, elementary_avx2, elementary_avx512, elementary_neon64;

const Elementary& elementary(shading::Isa isa) {
    HALFLIT_RETURN_TABLE_OF(isa, elementary)
}

}  // namespace halflit::testing
