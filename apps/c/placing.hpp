// Matrices of callers that place something: affine and finite.
#pragma once

#include "apps/c/world.hpp"

#include <halflit/error.hpp>

#include <string>

namespace halflit::c {

/// A matrix of 16 floats or doubles, column after column. rest: see halflit_instance. Fails (usage) for a number that is not finite, and
/// for another last row than 0 0 0 1.
template <class Number>
[[nodiscard]] Result<Placing> read_placing(const Number m[16], Vec3d rest = {0, 0, 0}) {
    for (int i = 0; i < 16; ++i)
        if (!(m[i] - m[i] == Number{0})) return fail(ErrorCode::usage, "world_from_object: a number is not finite");
    const auto is = [](Number x, double wanted) { return x > wanted - 1e-5 && x < wanted + 1e-5; };
    if (!is(m[3], 0) || !is(m[7], 0) || !is(m[11], 0) || !is(m[15], 1))
        return fail(ErrorCode::usage, std::string("world_from_object: expected 0 0 0 1 as the last row") +
                                          (is(m[12], 0) && is(m[13], 0) && is(m[14], 0) ? ": is it transposed?" : ""));
    const auto column = [m](int i) { return Vec3d{m[4 * i], m[4 * i + 1], m[4 * i + 2]}; };
    return Placing{{column(0), column(1), column(2)}, column(3), rest};
}

}  // namespace halflit::c
