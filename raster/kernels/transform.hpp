// Vertex kernels: from object space to snapped window coordinates, and the records that shading interpolates.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "sh/mat4.hpp"
#include "shading/kernels/simd_records.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// ((m0 x + m4 y) + m8 z) + m12: row r of a column-major matrix applied to a point.
HALFLIT_INLINE F transform_row(const float* m, int r, F x, F y, F z) {
    return ((F(m[r]) * x + F(m[4 + r]) * y) + F(m[8 + r]) * z) + F(m[12 + r]);
}

HALFLIT_INLINE I outcode_bit(M m, std::int32_t bit) { return sel(m, I(bit), I(0)); }

/// Transforms kWidth vertices from packed xyz at `p` (3 * kWidth floats are read).
/// The window rule is that of the common software rasterizers: inv_w = 1/w by division, ndc = clip * inv_w, window = ndc * half + half with
/// two roundings, snapped to nearest even at 8 sub-pixel bits.
HALFLIT_INLINE void transform_vector(const TransformArgs& args, const float* p, ScreenVertex* screen, std::int32_t* outcode) {
    const I at = iota_i() + iota_i() + iota_i();
    const F x = gather(p, at), y = gather(p + 1, at), z = gather(p + 2, at);
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

inline void vertex_records(const VertexRecordArgs& args) {
    const float* w = args.world_from_object;
    const float* n = args.normal_from_object;
    const Q w0 = q_load(w), w1 = q_load(w + 4), w2 = q_load(w + 8), w3 = q_load(w + 12);
    const Q n0 = q_load(n), n1 = q_load(n + 4), n2 = q_load(n + 8);
    for (std::int64_t v = args.begin; v < args.end; ++v) {
        float* out = args.records + v * args.stride;
        // The position is stored as four floats. The normal's x then replaces the fourth.
        if (args.slots & shading::kPositionSlot) {
            const float* p = args.positions + 3 * v;
            q_store(out, q_add(q_mad(w2, q_set(p[2]), q_mad(w1, q_set(p[1]), q_mul(w0, q_set(p[0])))), w3));
        }
        float normal[4] = {0, 0, 0, 0};
        if (args.normals) {
            const float* p = args.normals + 3 * v;
            q_store(normal, q_mad(n2, q_set(p[2]), q_mad(n1, q_set(p[1]), q_mul(n0, q_set(p[0])))));
        }
        if (args.slots & shading::kPositionSlot) {
            out[3] = normal[0];
            out += 4;
        }
        if (args.slots & shading::kUv0Slot) {
            out[0] = normal[1];
            out[1] = normal[2];
            out[2] = args.uv0 ? args.uv0[2 * v] : 0.0f;
            out[3] = args.uv0 ? args.uv0[2 * v + 1] : 0.0f;
            out += 4;
        }
        if (args.slots & shading::kTangentSlot) {
            if (args.tangents) {
                const float* t = args.tangents + 4 * v;
                q_store(out, q_mad(w2, q_set(t[2]), q_mad(w1, q_set(t[1]), q_mul(w0, q_set(t[0])))));
                out[3] = t[3] * args.tangent_sign;
            } else {
                q_store(out, w0);
                out[3] = 1.0f;
            }
            out += 4;
        }
        if (args.slots & shading::kColorSlot) {
            q_store(out, args.colors ? q_load(args.colors + 4 * v) : q_set(1.0f));
            out += 4;
        }
        if (args.slots & shading::kUv1Slot) {
            out[0] = args.uv1 ? args.uv1[2 * v] : 0.0f;
            out[1] = args.uv1 ? args.uv1[2 * v + 1] : 0.0f;
            out[2] = out[3] = 0.0f;
        }
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
