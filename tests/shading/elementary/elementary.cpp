#include "elementary.hpp"

#include "shading/kernels/isa_select.hpp"

namespace halflit::testing {

HALFLIT_DECLARE_TABLES(Elementary, elementary)

const Elementary& elementary(Isa isa) { HALFLIT_RETURN_TABLE_OF(isa, elementary) }

}  // namespace halflit::testing
