// Interpolation of fragment attributes. The perspective-correct barycentric coordinates b1, b2 of each pixel centre are computed from the
// triangle's snapped vertices. Every vertex attribute is then v0 + b1 (v1 - v0) + b2 (v2 - v0).
//
// The weight of vertex i is E_i / w_i, where E_i is the edge function of the opposite edge. With d_i = vertex_i - pixel (exact integers),
// E_0 = d1 x d2, and so on. All three are clamped at 0, so that an attribute never leaves its triangle's range. If all lanes of a vector
// show one triangle, it is loaded once. Otherwise each lane loads its own triangle, and 4x4 transposes make rows of the attributes. Both
// ways do the same operations on each lane.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "raster/kernels/terminator_offset.hpp"
#include "shading/kernels/simd_records.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Vertex positions and 1/w of kWidth triangles.
struct TriangleLanes {
    I x[3], y[3];
    F inv_w[3];
};

struct Barycentrics {
    F b1, b2;
    F db1_dx, db1_dy, db2_dx, db2_dy;  ///< per pixel; valid if gradients were asked for
};

HALFLIT_INLINE F positive_cross(F ax, F ay, F bx, F by) { return vmax(ax * by - ay * bx, F(0.0f)); }

HALFLIT_INLINE Barycentrics barycentrics(const TriangleLanes& t, I px, I py, bool gradients) {
    const I cx = shl<8>(px), cy = shl<8>(py);
    F dx[3], dy[3];
    for (int k = 0; k < 3; ++k) {
        dx[k] = to_float(t.x[k] - cx);
        dy[k] = to_float(t.y[k] - cy);
    }
    const F w0 = positive_cross(dx[1], dy[1], dx[2], dy[2]) * t.inv_w[0];
    const F w1 = positive_cross(dx[2], dy[2], dx[0], dy[0]) * t.inv_w[1];
    const F w2 = positive_cross(dx[0], dy[0], dx[1], dy[1]) * t.inv_w[2];
    const F sum = (w0 + w1) + w2;
    const F inv = sel(sum > F(0.0f), vdiv(F(1.0f), sum), F(0.0f));
    Barycentrics b;
    b.b1 = w1 * inv;
    b.b2 = w2 * inv;
    if (!gradients) return b;
    // dE_0/dx = 256 (y1 - y2), dE_0/dy = 256 (x2 - x1), and so on around the triangle.
    F gx[3], gy[3];
    for (int k = 0; k < 3; ++k) {
        const int p = (k + 1) % 3, q = (k + 2) % 3;
        gx[k] = ((dy[p] - dy[q]) * F(256.0f)) * t.inv_w[k];
        gy[k] = ((dx[q] - dx[p]) * F(256.0f)) * t.inv_w[k];
    }
    const F sum_dx = (gx[0] + gx[1]) + gx[2], sum_dy = (gy[0] + gy[1]) + gy[2];
    b.db1_dx = (gx[1] - b.b1 * sum_dx) * inv;
    b.db1_dy = (gy[1] - b.b1 * sum_dy) * inv;
    b.db2_dx = (gx[2] - b.b2 * sum_dx) * inv;
    b.db2_dy = (gy[2] - b.b2 * sum_dy) * inv;
    return b;
}

/// Records of a triangle's three vertices.
struct VertexRecords {
    const float* v[3];
};

HALFLIT_INLINE VertexRecords vertex_records_of(const InterpolateArgs& args, std::uint32_t id, const TriangleRecord& record) {
    const float* base = args.draws[record.draw_and_back >> 1].base;
    VertexRecords out;
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = record.vertex[k];
        out.v[k] = (v & kClipVertex) ? args.clip_records[id >> args.triangles.local_bits] +
                                           static_cast<std::int64_t>(v & ~kClipVertex) * shading::kVertexFloats
                                     : base + static_cast<std::int64_t>(v) * args.stride;
    }
    return out;
}

/// Interpolates kWidth lanes of one triangle.
HALFLIT_INLINE void interpolate_one(const InterpolateArgs& args, shading::FragmentBlock& block, int at) {
    const std::uint32_t id = args.ids[at];
    const TriangleRecord& record = record_of(args.triangles, id);
    const TriangleSource& source = args.triangles.chunks[id >> args.triangles.local_bits];
    TriangleLanes t;
    for (int k = 0; k < 3; ++k) {
        const ScreenVertex& v = vertex_of(source, record.vertex[k]);
        t.x[k] = I(v.x);
        t.y[k] = I(v.y);
        t.inv_w[k] = F(v.inv_w);
    }
    const Barycentrics b = barycentrics(t, load(args.x_px + at), load(args.y_px + at), args.gradients);
    const VertexRecords records = vertex_records_of(args, id, record);
    int offset = 0;
    for (int q = 0; q < shading::kSlotCount; ++q) {
        if (!(args.slots & (1u << q))) continue;
        for (int j = 0; j < 4; ++j) {
            const float v0 = records.v[0][offset + j];
            const F d1(records.v[1][offset + j] - v0), d2(records.v[2][offset + j] - v0);
            store(block.lane[4 * q + j] + at, mad(b.b2, d2, mad(b.b1, d1, F(v0))));
        }
        const int uv_row = q == 1 ? 2 : q == 4 ? 0 : -1;
        if (args.gradients && uv_row >= 0) {
            const int first = q == 1 ? shading::kDu0Dx : shading::kDu1Dx;
            for (int j = 0; j < 2; ++j) {
                const float v0 = records.v[0][offset + uv_row + j];
                const F d1(records.v[1][offset + uv_row + j] - v0), d2(records.v[2][offset + uv_row + j] - v0);
                store(block.lane[first + j] + at, mad(b.db2_dx, d2, b.db1_dx * d1));
                store(block.lane[first + 2 + j] + at, mad(b.db2_dy, d2, b.db1_dy * d1));
            }
        }
        offset += 4;
    }
    const F side(args.facing && (record.draw_and_back & 1u) ? -1.0f : 1.0f);
    if (args.facing) store(block.lane[shading::kFacing] + at, side);
    if (args.shadow_offset) {
        CornerLanes corners;
        for (int k = 0; k < 3; ++k) {
            const float* v = records.v[k];
            corners.position[k] = {F(v[0]), F(v[1]), F(v[2])};
            corners.normal[k] = {F(v[3]), F(v[4]), F(v[5])};
        }
        store_terminator_offset(block, at, terminator_offset(corners, row3(block, shading::kPosX, at), b.b1, b.b2, side));
    }
}

/// Stores the terminator offsets of kWidth lanes of different triangles.
HALFLIT_INLINE void offset_many(const InterpolateArgs& args, const VertexRecords* records, const Barycentrics& b,
                                shading::FragmentBlock& block, int at) {
    alignas(64) float values[6][kWidth < 4 ? 4 : kWidth];
    CornerLanes corners;
    for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < kWidth; ++l)
            for (int j = 0; j < 6; ++j) values[j][l] = records[l].v[k][j];
        corners.position[k] = {load(values[0]), load(values[1]), load(values[2])};
        corners.normal[k] = {load(values[3]), load(values[4]), load(values[5])};
    }
    const F side = args.facing ? row(block, shading::kFacing, at) : F(1.0f);
    store_terminator_offset(block, at, terminator_offset(corners, row3(block, shading::kPosX, at), b.b1, b.b2, side));
}

/// Interpolates kWidth lanes of different triangles.
HALFLIT_INLINE void interpolate_many(const InterpolateArgs& args, shading::FragmentBlock& block, int at) {
    constexpr int kLanes = kWidth < 4 ? 4 : kWidth;
    const float* corner[3][kWidth];
    VertexRecords records[kWidth];
    for (int l = 0; l < kWidth; ++l) {
        const std::uint32_t id = args.ids[at + l];
        const TriangleRecord& record = record_of(args.triangles, id);
        const TriangleSource& source = source_of(args.triangles, id);
        for (int k = 0; k < 3; ++k) corner[k][l] = reinterpret_cast<const float*>(&vertex_of(source, record.vertex[k]));
        records[l] = vertex_records_of(args, id, record);
        if (args.facing) block.lane[shading::kFacing][at + l] = (record.draw_and_back & 1u) ? -1.0f : 1.0f;
    }
    TriangleLanes t;
    for (int k = 0; k < 3; ++k) {
        F x, y, z;
        load4(corner[k], x, y, z, t.inv_w[k]);
        t.x[k] = bits(x);
        t.y[k] = bits(y);
    }
    const Barycentrics b = barycentrics(t, load(args.x_px + at), load(args.y_px + at), args.gradients);
    alignas(64) float b1[kLanes], b2[kLanes], db1_dx[kLanes], db1_dy[kLanes], db2_dx[kLanes], db2_dy[kLanes];
    store(b1, b.b1);
    store(b2, b.b2);
    if (args.gradients) {
        store(db1_dx, b.db1_dx);
        store(db1_dy, b.db1_dy);
        store(db2_dx, b.db2_dx);
        store(db2_dy, b.db2_dy);
    }
    constexpr int kGroup = kWidth < 4 ? kWidth : 4;
    int offset = 0;
    for (int q = 0; q < shading::kSlotCount; ++q) {
        if (!(args.slots & (1u << q))) continue;
        const int uv_row = q == 1 ? 2 : q == 4 ? 0 : -1;
        for (int g = 0; g < kWidth; g += kGroup) {
            Q value[4], slope[4] = {};
            for (int l = 0; l < kGroup; ++l) {
                const VertexRecords& r = records[g + l];
                const Q v0 = q_load(r.v[0] + offset);
                const Q d1 = q_sub(q_load(r.v[1] + offset), v0), d2 = q_sub(q_load(r.v[2] + offset), v0);
                value[l] = q_mad(q_set(b2[g + l]), d2, q_mad(q_set(b1[g + l]), d1, v0));
                if (args.gradients && uv_row >= 0) {
                    const Q sx = q_mad(q_set(db2_dx[g + l]), d2, q_mul(q_set(db1_dx[g + l]), d1));
                    const Q sy = q_mad(q_set(db2_dy[g + l]), d2, q_mul(q_set(db1_dy[g + l]), d1));
                    slope[l] = uv_row == 2 ? q_high_pair(sx, sy) : q_low_pair(sx, sy);
                }
            }
            const int to = at + g;
            if constexpr (kGroup == 4) {
                q_transpose(value[0], value[1], value[2], value[3]);
                for (int j = 0; j < 4; ++j) q_store(block.lane[4 * q + j] + to, value[j]);
                if (args.gradients && uv_row >= 0) {
                    q_transpose(slope[0], slope[1], slope[2], slope[3]);
                    const int first = q == 1 ? shading::kDu0Dx : shading::kDu1Dx;
                    for (int j = 0; j < 4; ++j) q_store(block.lane[first + j] + to, slope[j]);
                }
            } else {
                alignas(16) float row[4];
                q_store(row, value[0]);
                for (int j = 0; j < 4; ++j) block.lane[4 * q + j][to] = row[j];
                if (args.gradients && uv_row >= 0) {
                    q_store(row, slope[0]);
                    const int first = q == 1 ? shading::kDu0Dx : shading::kDu1Dx;
                    for (int j = 0; j < 4; ++j) block.lane[first + j][to] = row[j];
                }
            }
        }
        offset += 4;
    }
    if (args.shadow_offset) offset_many(args, records, b, block, at);
}

inline void interpolate(const InterpolateArgs& args, shading::FragmentBlock& block) {
    for (int at = 0; at < args.count; at += kWidth) {
        bool same = true;
        for (int l = 1; l < kWidth; ++l) same &= args.ids[at + l] == args.ids[at];
        if (same)
            interpolate_one(args, block, at);
        else
            interpolate_many(args, block, at);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
