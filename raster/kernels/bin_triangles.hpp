// Culling of triangles before they are listed: kWidth small triangles side by side. Those that are clipped or large are left to the caller.
#pragma once

#include "raster/kernels/triangle_setup.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Lanes whose triangle covers a sample of its box, for boxes up to kTinyBox; other lanes may have any bit.
HALFLIT_INLINE std::uint32_t tiny_covered(const BinArgs& args, const TriangleCorners& t, I x0, I y0, I width, I height,
                                          std::uint32_t tiny) {
    I a[3], b[3], e[3];
    for (int k = 0; k < 3; ++k) {
        I not_top_left;
        make_edge(t, k, a[k], b[k], not_top_left);
        // Held near the triangle's box, so that no product overflows; only lanes without a pixel are moved.
        const I px = vmin(shl<8>(x0), t.most_x + I(256)), py = vmin(shl<8>(y0), t.most_y + I(256));
        e[k] = a[k] * (px - t.x[k]) + b[k] * (py - t.y[k]) - not_top_left;
    }
    const I second_column = width - I(2), second_row = height - I(2);
    std::uint32_t missed = tiny;
    for (int s = 0; s < args.samples.count && missed != 0; ++s) {
        I at[3];
        for (int k = 0; k < 3; ++k) at[k] = shr<8>(e[k] + a[k] * I(args.samples.x[s]) + b[k] * I(args.samples.y[s]));
        const I here = at[0] | at[1] | at[2];
        const I right = (at[0] + a[0]) | (at[1] + a[1]) | (at[2] + a[2]) | second_column;
        const I below = (at[0] + b[0]) | (at[1] + b[1]) | (at[2] + b[2]) | second_row;
        const I both = (at[0] + a[0] + b[0]) | (at[1] + a[1] + b[1]) | (at[2] + a[2] + b[2]) | second_column | second_row;
        missed &= sign_bits(here & right & below & both);
    }
    return ~missed;
}

template <int kShift>
HALFLIT_INLINE void store_tiles(const BinArgs& args, int i, I x0, I y0, I x1, I y1, BinnedTriangles& out) {
    store(out.tile_x0 + i, shr<kShift>(x0 - I(args.region_x)));
    store(out.tile_y0 + i, shr<kShift>(y0 - I(args.region_y)));
    store(out.tile_x1 + i, shr<kShift>(x1 - I(args.region_x)));
    store(out.tile_y1 + i, shr<kShift>(y1 - I(args.region_y)));
}

inline void bin_triangles(const BinArgs& args, const std::uint32_t* index, int count, BinnedTriangles& out) {
    out.keep = out.other = out.back = out.swap = 0;
    for (int i = 0; i < count; i += kWidth) {
        const int n = count - i < kWidth ? count - i : kWidth;
        const float* corner[3][kWidth];
        unsigned any = 0;
        for (int l = 0; l < kWidth; ++l) {
            const std::uint32_t* v = index + 3 * (i + (l < n ? l : n - 1));
            for (int k = 0; k < 3; ++k) {
                corner[k][l] = reinterpret_cast<const float*>(args.screen + v[k]);
                any |= args.outcodes[v[k]];
            }
        }
        std::uint32_t seen = static_cast<std::uint32_t>((std::uint64_t{1} << n) - 1u), odd = 0;
        if (any != 0) {
            for (int l = 0; l < n; ++l) {
                const std::uint32_t* v = index + 3 * (i + l);
                const unsigned c0 = args.outcodes[v[0]], c1 = args.outcodes[v[1]], c2 = args.outcodes[v[2]];
                if ((c0 & c1 & c2 & kRejectWhenAll) != 0) seen &= ~(1u << l);
                if (((c0 | c1 | c2) & (kNear | kGuard | kNotFinite)) != 0) odd |= 1u << l;
            }
        }
        if (seen == 0) continue;
        TriangleCorners t = corners_at(corner);
        const std::uint32_t other = seen & (odd | ~t.small);
        out.other |= static_cast<std::uint64_t>(other) << i;
        const I x0 = vmax(shr<8>(t.least_x - I(args.sample_max_x - 255)), I(args.region_x));
        const I x1 = vmin(shr<8>(t.most_x - I(args.sample_min_x)), I(args.region_x + args.region_width - 1));
        const I y0 = vmax(shr<8>(t.least_y - I(args.sample_max_y - 255)), I(args.region_y));
        const I y1 = vmin(shr<8>(t.most_y - I(args.sample_min_y)), I(args.region_y + args.region_height - 1));
        const I area = (t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - (t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
        const M negative = less(area, I(0));
        const std::uint32_t swap = mask_bits(negative), positive = mask_bits(less(I(0), area));
        // y points down here: a counter-clockwise triangle has negative area.
        const std::uint32_t back = args.mirrored ? ~positive : positive;
        std::uint32_t keep = seen & ~other & (swap | positive) & ~mask_bits(less(x1, x0) | less(y1, y0));
        if (args.cull_back) keep &= ~back;
        if (keep == 0) continue;
        const I width = x1 - x0 + I(1), height = y1 - y0 + I(1);
        const std::uint32_t tiny = args.round ? 0 : mask_bits(less(width, I(kTinyBox + 1)) & less(height, I(kTinyBox + 1))) & keep;
        if (tiny != 0) {
            const I x = t.x[1], y = t.y[1];
            t.x[1] = sel(negative, t.x[2], x);
            t.y[1] = sel(negative, t.y[2], y);
            t.x[2] = sel(negative, x, t.x[2]);
            t.y[2] = sel(negative, y, t.y[2]);
            keep &= ~tiny | tiny_covered(args, t, x0, y0, width, height, tiny);
        }
        out.keep |= static_cast<std::uint64_t>(keep) << i;
        out.back |= static_cast<std::uint64_t>(back & keep) << i;
        out.swap |= static_cast<std::uint64_t>(swap & keep) << i;
        switch (args.tile_shift) {
            case 4:
                store_tiles<4>(args, i, x0, y0, x1, y1, out);
                break;
            case 5:
                store_tiles<5>(args, i, x0, y0, x1, y1, out);
                break;
            default:
                store_tiles<6>(args, i, x0, y0, x1, y1, out);
        }
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
