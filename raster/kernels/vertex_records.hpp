// The records of vertices that shading interpolates, kWidth vertices at a time.
#pragma once

#include "raster/kernels/transform.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Records of kWidth vertices from v on.
HALFLIT_INLINE void vertex_records_at(const VertexRecordArgs& args, std::int64_t v) {
    const float* const world = args.world_from_object;
    const F none(0.0f), one(1.0f);
    float* out = args.records + v * args.stride;
    const auto put = [&](F a, F b, F c, F d) __attribute__((always_inline)) {
        store4(out, args.stride, a, b, c, d);
        out += 4;
    };
    F normal[3] = {none, none, none};
    if (args.normals) {
        F x, y, z;
        load3(args.normals + 3 * v, x, y, z);
        for (int r = 0; r < 3; ++r) normal[r] = turn_row(args.normal_from_object, r, x, y, z);
    }
    if (args.slots & shading::kPositionSlot) {
        F x, y, z;
        load3(args.positions + 3 * v, x, y, z);
        put(transform_row(world, 0, x, y, z), transform_row(world, 1, x, y, z), transform_row(world, 2, x, y, z), normal[0]);
    }
    if (args.slots & shading::kUv0Slot) {
        F uv[2] = {none, none};
        if (args.uv0) load2(args.uv0 + 2 * v, uv[0], uv[1]);
        put(normal[1], normal[2], uv[0], uv[1]);
    }
    if (args.slots & shading::kTangentSlot) {
        if (args.tangents) {
            F x, y, z, w;
            load4(args.tangents + 4 * v, x, y, z, w);
            // A vertex without a normal has no tangent either: a normal map would make a direction of nothing.
            const auto has_normal = (vabs(normal[0]) + vabs(normal[1])) + vabs(normal[2]) > none;
            const auto tangent = [&](int r) { return sel(has_normal, turn_row(world, r, x, y, z), none); };
            put(tangent(0), tangent(1), tangent(2), w * F(args.tangent_sign));
        } else {
            put(F(world[0]), F(world[1]), F(world[2]), one);
        }
    }
    if (args.slots & shading::kColorSlot) {
        F r = one, g = one, b = one, a = one;
        if (args.colors) load4(args.colors + 4 * v, r, g, b, a);
        put(r, g, b, a);
    }
    if (args.slots & shading::kUv1Slot) {
        F uv[2] = {none, none};
        if (args.uv1) load2(args.uv1 + 2 * v, uv[0], uv[1]);
        put(uv[0], uv[1], none, none);
    }
}

/// At most kWidth records from `begin` on: by way of copies with room for a whole vector.
[[gnu::noinline]] static void copied_vertex_records(const VertexRecordArgs& args, std::int64_t begin, std::int64_t count) {
    float in[6][4 * kWidth] = {}, records[shading::kVertexFloats * kWidth];
    VertexRecordArgs padded = args;
    const auto copy = [&](const float*& from, int size, float* to) {
        if (from == nullptr) return;
        for (std::int64_t i = 0; i < count; ++i) {
            const std::int64_t vertex = args.vertices != nullptr ? args.vertices[(begin + i) << args.vertex_shift] : begin + i;
            for (int k = 0; k < size; ++k) to[size * i + k] = from[size * vertex + k];
        }
        from = to;
    };
    copy(padded.positions, 3, in[0]);
    copy(padded.normals, 3, in[1]);
    copy(padded.tangents, 4, in[2]);
    copy(padded.uv0, 2, in[3]);
    copy(padded.uv1, 2, in[4]);
    copy(padded.colors, 4, in[5]);
    padded.records = records;
    vertex_records_at(padded, 0);
    for (std::int64_t i = 0; i < args.stride * count; ++i) args.records[args.stride * begin + i] = records[i];
}

inline void vertex_records(const VertexRecordArgs& args) {
    if (args.vertices != nullptr) {
        for (std::int64_t v = args.begin; v < args.end; v += kWidth)
            copied_vertex_records(args, v, args.end - v < kWidth ? args.end - v : kWidth);
        return;
    }
    if (args.end - args.begin < kWidth) return copied_vertex_records(args, args.begin, args.end - args.begin);
    for (std::int64_t v = args.begin; v + kWidth <= args.end; v += kWidth) vertex_records_at(args, v);
    vertex_records_at(args, args.end - kWidth);  // the rest, and some that are made already
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
