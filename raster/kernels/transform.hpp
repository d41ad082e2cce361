// Vertices from object space to snapped window coordinates.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "sh/mat4.hpp"
#include "shading/kernels/simd_records.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// (m0 x + m4 y) + m8 z: row r of a column-major matrix applied to a direction.
HALFLIT_INLINE F turn_row(const float* m, int r, F x, F y, F z) { return (F(m[r]) * x + F(m[4 + r]) * y) + F(m[8 + r]) * z; }
/// The same of a point: + m12.
HALFLIT_INLINE F transform_row(const float* m, int r, F x, F y, F z) { return turn_row(m, r, x, y, z) + F(m[12 + r]); }

HALFLIT_INLINE I outcode_bit(M m, std::int32_t bit) { return sel(m, I(bit), I(0)); }

/// Transforms kWidth vertices from packed xyz at `p` (3 * kWidth floats are read).
/// The window rule is that of the common software rasterizers: inv_w = 1/w by division, ndc = clip * inv_w, window = ndc * half + half with
/// two roundings, snapped to nearest even at 8 sub-pixel bits.
HALFLIT_INLINE void transform_vector(const TransformArgs& args, const float* p, ScreenVertex* screen, std::int32_t* outcode) {
    F x, y, z;
    load3(p, x, y, z);
    const float* m = args.clip_from_object;
    const F cx = transform_row(m, 0, x, y, z), cy = transform_row(m, 1, x, y, z);
    const F cz = transform_row(m, 2, x, y, z), cw = transform_row(m, 3, x, y, z);

    const F huge(3.0e38f);
    const M finite = (vabs(cx) < huge) & (vabs(cy) < huge) & (vabs(cz) < huge) & (vabs(cw) < huge);
    // A w whose inverse is infinite, or nearly so, is left to the clipper, which computes in double.
    const M in_guard = (vabs(cx) <= F(args.viewport.guard_x) * cw) & (vabs(cy) <= F(args.viewport.guard_y) * cw) & (cw > F(kLeastW));
    const M behind = cz > cw;
    I code =
        outcode_bit(cx < vneg(cw), kLeft) | outcode_bit(cx > cw, kRight) | outcode_bit(cy > cw, kTop) | outcode_bit(cy < vneg(cw), kBottom);
    code = code | outcode_bit(cz < F(0.0f), kBeyondFar) | outcode_bit(behind, kNear);
    code = code | sel(in_guard, I(0), I(kGuard));
    code = sel(finite, code, I(kNotFinite));

    // Lanes that will be clipped get 0, so that no conversion is out of range.
    const M plain = finite & in_guard;
    const F inv_w = vdiv(F(1.0f), sel(plain, cw, F(1.0f)));
    const F half_w(args.viewport.half_width), half_h(args.viewport.half_height);
    const F win_x = (cx * inv_w) * half_w + half_w;
    const F win_y = vneg(cy * inv_w) * half_h + half_h;
    const I fx = round_even(sel(plain, (win_x - F(0.5f)) * F(256.0f), F(0.0f)));
    const I fy = round_even(sel(plain, (win_y - F(0.5f)) * F(256.0f), F(0.0f)));
    store(outcode, code);
    store4(reinterpret_cast<float*>(screen), from_bits(fx), from_bits(fy), cz * inv_w, inv_w);
}

inline void transform(const TransformArgs& args) {
    alignas(64) std::int32_t code[kWidth];
    std::int64_t v = args.begin;
    for (; v + kWidth <= args.end; v += kWidth) {
        transform_vector(args, args.positions + 3 * v, args.screen + v, code);
        for (int l = 0; l < kWidth; ++l) args.outcodes[v + l] = static_cast<std::uint8_t>(code[l]);
    }
    if (v == args.end) return;
    float rest[3 * kWidth] = {};
    ScreenVertex screen[kWidth];
    const int left = static_cast<int>(args.end - v);
    for (int i = 0; i < 3 * left; ++i) rest[i] = args.positions[3 * v + i];
    transform_vector(args, rest, screen, code);
    for (int l = 0; l < left; ++l) {
        args.screen[v + l] = screen[l];
        args.outcodes[v + l] = static_cast<std::uint8_t>(code[l]);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
