// Picks one of a family of tables that exist once for each instruction set that is built: NAME_scalar, NAME_sse2, NAME_avx2 and so on.
#pragma once

#include "halflit/isa.hpp"
#include "shading/kernels/built_isas.hpp"

/// Declares NAME_scalar and the tables of the other built sets, which the kernels' objects define.
#define HALFLIT_DECLARE_TABLE(set, type, name) extern const type name##_##set;
#define HALFLIT_DECLARE_TABLES(type, name) HALFLIT_FOR_BUILT_ISAS(HALFLIT_DECLARE_TABLE, type, name)

/// The body of a function that returns the table of `isa`, or that of scalar if the set is not built.
#define HALFLIT_TABLE_CASE(set, name) \
    case ::halflit::Isa::set:         \
        return name##_##set;
#define HALFLIT_RETURN_TABLE_OF(isa, name)               \
    switch (isa) {                                       \
        HALFLIT_FOR_BUILT_ISAS(HALFLIT_TABLE_CASE, name) \
        default:                                         \
            return name##_scalar;                        \
    }
