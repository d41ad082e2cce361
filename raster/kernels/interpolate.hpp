// Interpolation of fragment attributes. The perspective-correct barycentric coordinates b1, b2 of each pixel centre are computed from the
// triangle's snapped vertices. Every vertex attribute is then v0 + b1 (v1 - v0) + b2 (v2 - v0).
//
// The weight of vertex i is E_i / w_i, where E_i is the edge function of the opposite edge. With d_i = vertex_i - pixel (exact integers),
// E_0 = d1 x d2, and so on. A centre outside of the triangle, which samples of the pixel lie in, is moved perpendicularly onto each edge
// that it is beyond. Then all three are clamped at 0, so that an attribute never leaves its triangle's range. The clamping alone moves a
// point towards the opposite corner: in slivers by hundreds of pixels.
//
// First the block's vertices are found, then each vector of lanes is computed. If all of its lanes show one triangle, its values are
// broadcast. Otherwise each lane loads records of its own, and transposes make rows of them. Both ways do the same operations on each lane.
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

HALFLIT_INLINE F cross(F ax, F ay, F bx, F by) { return ax * by - ay * bx; }

/// Moves the centre onto the edges that it is beyond, one after the other. dx, dy: from it to the vertices. Lanes inside keep their bits.
[[gnu::noinline]] static void move_inside(F (&dx)[3], F (&dy)[3]) {
    const F ex[3] = {dx[2] - dx[1], dx[0] - dx[2], dx[1] - dx[0]}, ey[3] = {dy[2] - dy[1], dy[0] - dy[2], dy[1] - dy[0]};
    for (int k = 0; k < 3; ++k) {
        const int p = (k + 1) % 3, q = (k + 2) % 3;
        const F beyond = cross(dx[p], dy[p], dx[q], dy[q]);
        const F part = sel(beyond < F(0.0f), vdiv(beyond, ex[k] * ex[k] + ey[k] * ey[k]), F(0.0f));
        const F move_x = part * ey[k], move_y = part * ex[k];
        for (int i = 0; i < 3; ++i) {
            dx[i] = dx[i] - move_x;
            dy[i] = dy[i] + move_y;
        }
    }
}

HALFLIT_INLINE Barycentrics barycentrics(const TriangleLanes& t, I px, I py, bool gradients, bool extrapolates) {
    const I cx = shl<8>(px), cy = shl<8>(py);
    F dx[3], dy[3];
    for (int k = 0; k < 3; ++k) {
        dx[k] = to_float(t.x[k] - cx);
        dy[k] = to_float(t.y[k] - cy);
    }
    F e[3];
    const auto edges = [&](const F(&x)[3], const F(&y)[3]) __attribute__((always_inline)) {
        for (int k = 0; k < 3; ++k) {
            const int p = (k + 1) % 3, q = (k + 2) % 3;
            e[k] = cross(x[p], y[p], x[q], y[q]);
        }
    };
    edges(dx, dy);
    if (!extrapolates && any(vmin(vmin(e[0], e[1]), e[2]) < F(0.0f))) {
        F moved_x[3] = {dx[0], dx[1], dx[2]}, moved_y[3] = {dy[0], dy[1], dy[2]};
        move_inside(moved_x, moved_y);
        edges(moved_x, moved_y);
    }
    if (!extrapolates)
        for (F& edge : e) edge = vmax(edge, F(0.0f));
    const F w0 = e[0] * t.inv_w[0];
    const F w1 = e[1] * t.inv_w[1];
    const F w2 = e[2] * t.inv_w[2];
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
    const DrawRecords draw = args.draws[record.draw()];
    VertexRecords out;
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = record.vertex[k];
        out.v[k] = (v & kClipVertex) ? args.clip_records[id >> args.triangles.local_bits] +
                                           static_cast<std::int64_t>(v & ~kClipVertex) * shading::kVertexFloats
                                     : draw.of(v, args.stride);
    }
    return out;
}

/// Four floats of vertex k's record, from `offset` on, of kWidth lanes: of one triangle, or of a triangle each.
struct OneTriangle {
    VertexRecords records;
    HALFLIT_INLINE void read(int k, int offset, F (&out)[4]) const {
        for (int j = 0; j < 4; ++j) out[j] = F(records.v[k][offset + j]);
    }
};
struct ManyTriangles {
    const float* const* v[3];
    HALFLIT_INLINE void read(int k, int offset, F (&out)[4]) const {
        const float* at[kWidth];
        for (int l = 0; l < kWidth; ++l) at[l] = v[k][l] + offset;
        load4(at, out[0], out[1], out[2], out[3]);
    }
};

template <class Corners>
HALFLIT_INLINE CornerLanes corner_lanes(const Corners& corners) {
    CornerLanes out;
    for (int k = 0; k < 3; ++k) {
        F low[4], high[4];
        corners.read(k, 0, low);
        corners.read(k, 4, high);
        out.position[k] = {low[0], low[1], low[2]};
        out.normal[k] = {low[3], high[0], high[1]};
    }
    return out;
}

/// Interpolates kWidth lanes; `side`: -1 where the back is seen, else +1.
template <class Corners>
HALFLIT_INLINE void interpolate_lanes(const InterpolateArgs& args, const TriangleLanes& t, const Corners& corners, F side,
                                      shading::FragmentBlock& block, int at) {
    const Barycentrics b = barycentrics(t, load(args.x_px + at), load(args.y_px + at), args.gradients, args.extrapolates);
    int offset = 0;
    for (int q = 0; q < shading::kSlotCount; ++q) {
        if (!(args.slots & (1u << q))) continue;
        F v0[4], d1[4], d2[4];
        corners.read(0, offset, v0);
        corners.read(1, offset, d1);
        corners.read(2, offset, d2);
        for (int j = 0; j < 4; ++j) {
            d1[j] = d1[j] - v0[j], d2[j] = d2[j] - v0[j];
            store(block.lane[4 * q + j] + at, mad(b.b2, d2[j], mad(b.b1, d1[j], v0[j])));
        }
        const int uv_row = q == 1 ? 2 : q == 4 ? 0 : -1;
        if (args.gradients && uv_row >= 0) {
            const int first = q == 1 ? shading::kDu0Dx : shading::kDu1Dx;
            for (int j = 0; j < 2; ++j) {
                const F along1 = uv_row == 2 ? d1[2 + j] : d1[j], along2 = uv_row == 2 ? d2[2 + j] : d2[j];
                store(block.lane[first + j] + at, mad(b.db2_dx, along2, b.db1_dx * along1));
                store(block.lane[first + 2 + j] + at, mad(b.db2_dy, along2, b.db1_dy * along1));
            }
        }
        offset += 4;
    }
    if (args.facing) store(block.lane[shading::kFacing] + at, side);
    if (args.shadow_offset)
        store_terminator_offset(block, at, terminator_offset(corner_lanes(corners), row3(block, shading::kPosX, at), b.b1, b.b2, side));
}

/// Where the vertices of a block's fragments are. Of a vector of one triangle, the first lane alone is set.
struct FragmentCorners {
    const float *screen[3][shading::kBlockSize], *record[3][shading::kBlockSize];
    alignas(64) float side[shading::kBlockSize];
    bool same[shading::kBlockSize / kWidth];
};

HALFLIT_INLINE void find_corners(const InterpolateArgs& args, int at, FragmentCorners& out) {
    const std::uint32_t id = args.ids[at];
    const TriangleRecord& record = record_of(args.triangles, id);
    const TriangleSource& source = source_of(args.triangles, id);
    const VertexRecords records = vertex_records_of(args, id, record);
    for (int k = 0; k < 3; ++k) {
        out.screen[k][at] = reinterpret_cast<const float*>(&vertex_of(source, record.vertex[k]));
        out.record[k][at] = records.v[k];
        prefetch(records.v[k]);
        prefetch(out.screen[k][at]);
    }
    out.side[at] = args.facing && record.is_back() ? -1.0f : 1.0f;
}

/// Interpolates kWidth lanes of one triangle.
HALFLIT_INLINE void interpolate_one(const InterpolateArgs& args, const FragmentCorners& of, shading::FragmentBlock& block, int at) {
    TriangleLanes t;
    OneTriangle corners;
    for (int k = 0; k < 3; ++k) {
        const ScreenVertex& v = *reinterpret_cast<const ScreenVertex*>(of.screen[k][at]);
        t.x[k] = I(v.x);
        t.y[k] = I(v.y);
        t.inv_w[k] = F(v.inv_w);
        corners.records.v[k] = of.record[k][at];
    }
    interpolate_lanes(args, t, corners, F(of.side[at]), block, at);
}

/// Interpolates kWidth lanes of different triangles.
HALFLIT_INLINE void interpolate_many(const InterpolateArgs& args, const FragmentCorners& of, shading::FragmentBlock& block, int at) {
    TriangleLanes t;
    for (int k = 0; k < 3; ++k) {
        F x, y, z;
        load4(of.screen[k] + at, x, y, z, t.inv_w[k]);
        t.x[k] = bits(x);
        t.y[k] = bits(y);
    }
    interpolate_lanes(args, t, ManyTriangles{{of.record[0] + at, of.record[1] + at, of.record[2] + at}}, load(of.side + at), block, at);
}

inline void interpolate(const InterpolateArgs& args, shading::FragmentBlock& block) {
    FragmentCorners corners;
    for (int at = 0; at < args.count; at += kWidth) {
        bool same = true;
        for (int l = 1; l < kWidth; ++l) same &= args.ids[at + l] == args.ids[at];
        corners.same[at / kWidth] = same;
        for (int l = 0; l < (same ? 1 : kWidth); ++l) find_corners(args, at + l, corners);
    }
    for (int at = 0; at < args.count; at += kWidth) {
        if (corners.same[at / kWidth])
            interpolate_one(args, corners, block, at);
        else
            interpolate_many(args, corners, block, at);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
