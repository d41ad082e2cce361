// Light in cells: the value of a fitted polynomial at pixels.
#pragma once

#include "shading/kernels/vector.hpp"
#include "shading/light_cell.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Where a pixel is in its cell: n and p of light_cell.hpp.
struct CellPlace {
    F n[3], p[3];
    bool flat;
};
HALFLIT_INLINE CellPlace cell_place(const shading::LightCell& cell, V3 position, V3 normal) {
    const V3 p = (position - broadcast(cell.position)) * F(cell.inv_position_radius), n = normal - broadcast(cell.normal);
    return {{n.x, n.y, n.z}, {p.x, p.y, p.z}, cell.flat};
}

/// The value of a polynomial, not below 0.
HALFLIT_INLINE V3 cell_sum(const float (&terms)[shading::kCellTerms][3], const CellPlace& at) {
    F light[3];
    for (int c = 0; c < 3; ++c) {
        const auto term = [&](int t) __attribute__((always_inline)) { return F(terms[t][c]); };
        F sum = term(0);
        int pp = shading::kTermPP;
        for (int r = 0; r < 3; ++r) {
            F inner = term(shading::kTermP + r);
            for (int q = r; q < 3; ++q) inner = mad(term(pp++), at.p[q], inner);
            sum = mad(inner, at.p[r], sum);
        }
        if (!at.flat) {
            int nn = shading::kTermNN;
            for (int r = 0; r < 3; ++r) {
                F inner = term(shading::kTermN + r);
                for (int q = r; q < 3; ++q) inner = mad(term(nn++), at.n[q], inner);
                for (int q = 0; q < 3; ++q) inner = mad(term(shading::kTermNP + 3 * r + q), at.p[q], inner);
                sum = mad(inner, at.n[r], sum);
            }
        }
        light[c] = vmax(sum, F(0.0f));
    }
    return {light[0], light[1], light[2]};
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
