#include "lobe_curve.hpp"

#include "shading/kernels/isa_select.hpp"

namespace halflit::testing {

HALFLIT_DECLARE_TABLES(LobeCurve, lobe_curve)

LobeCurve lobe_curve(Isa isa) { HALFLIT_RETURN_TABLE_OF(isa, lobe_curve) }

}  // namespace halflit::testing
