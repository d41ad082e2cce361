// Splats of a square of the picture, from the nearest to the farthest, in blocks of its pixels.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "shading/kernels/pow.hpp"
#include "shading/kernels/simd.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

inline constexpr float kSplatBlockHalf = 0.5f * (kSplatBlock - 1);  ///< from the middle of a block to that of its outer pixels

/// Coordinates of the pixels of a block's first two rows, and of the middles of a square's blocks.
struct SplatPlaces {
    alignas(64) float x[2 * kSplatBlock], y[2 * kSplatBlock], middle_x[kSplatBlocks], middle_y[kSplatBlocks];
};
inline constexpr SplatPlaces kSplatPlaces = [] {
    SplatPlaces places{};
    for (int i = 0; i < 2 * kSplatBlock; ++i)
        places.x[i] = static_cast<float>(i % kSplatBlock), places.y[i] = static_cast<float>(i / kSplatBlock);
    for (int b = 0; b < kSplatBlocks; ++b) {
        places.middle_x[b] = static_cast<float>(kSplatBlock * (b % kSplatBlocksAcross)) + kSplatBlockHalf;
        places.middle_y[b] = static_cast<float>(kSplatBlock * (b / kSplatBlocksAcross)) + kSplatBlockHalf;
    }
    return places;
}();
static_assert(SplatTile::at(kSplatBlock + 1, 2) == kSplatBlockPixels + 2 * kSplatBlock + 1);

/// 2^x, or up to 6 % more or .04 % less: the mantissa is the part of x behind the point, to 10 bits. x: at most 0; below -100 as -100.
HALFLIT_INLINE F about_power_of_two(F x) {
    constexpr float kTenBits = 0x1.8p13f;  // floats near it are 2^-10 apart
    return from_bits(shl<13>(bits(vmax(x, F(-100.0f)) + F(kTenBits))) + I(127 << 23));
}

/// 2^x, of relative error 3e-6, and at most kMostSplatAlpha; below -60 as at -60, so that its product with T stays above the denormals. x:
/// at most 0. Three operations less than exp2_floored().
HALFLIT_INLINE F splat_alpha(F x) {
    constexpr float kWholes = 0x1.8p23f;  // floats near it are 1 apart
    const F held = vmax(x, F(-60.0f)), moved = held + F(kWholes), f = held - (moved - F(kWholes)), f2 = f * f;
    const auto& c = kExp2Degree4;
    const F power = mad(mad(F(c[4]), f2, mad(F(c[3]), f, F(c[2]))), f2, mad(F(c[1]), f, F(c[0])));
    return vmin(from_bits(bits(power) + shl<23>(bits(moved))), F(kMostSplatAlpha));
}
/// T is held at this, which no picture shows.
inline constexpr float kLeastSplatPassed = 0x1p-60f;

/// Limits below which a splat is not drawn in a block. It changes a pixel then by at most T alpha times the larger of its colour and the
/// largest one behind it. T is the light that those in front let through: that of the drawn picture, as leaving out only raises it. A splat
/// may cost kShare / count of the block's budget.
struct SplatCuts {
    static constexpr int kAtOnce = 32;  ///< splats that have the same limits
    static constexpr float kShare = 16.0f, kFewest = 520.0f;
    // The budget lasts: limits are whole powers of two, where about_power_of_two() is exact, and rounding of the sums is .05 %. Below
    // 2^-100 splats cost as at 2^-100, which may exceed an empty budget by 1e-30.
    static_assert(1.001f * kShare * kAtOnce < kFewest);
    /// Per block: log2 of the least alpha that is drawn, cost of alpha 1, and costs of the splats that are not drawn.
    alignas(64) float least_log2[kSplatBlocks], per_alpha[kSplatBlocks], spent[kSplatBlocks];
    bool any_live = false;

    /// remaining: splats that the limits are for, and all that follow.
    HALFLIT_INLINE SplatCuts(const SplatTile& tile, std::size_t remaining) {
        constexpr float kNever = 1e9f;
        for (int b = 0; b < kSplatBlocks; ++b) {
            const bool live = tile.most_passed[b] >= tile.least_passed;
            any_live |= live;
            spent[b] = 0.0f;
            per_alpha[b] = live ? tile.most_passed[b] * tile.largest : 0.0f;
            const float each = vmax(static_cast<float>(tile.budget[b]), 0.0f) * kShare / vmax(static_cast<float>(remaining), kFewest);
            const std::int32_t floor_of_log2 = live ? (bits(each / per_alpha[b]) >> 23) - 127 : 0;
            least_log2[b] = live ? static_cast<float>(vmin(vmax(floor_of_log2, -100), 0)) : kNever;
        }
    }
    /// Blocks in which a splat is drawn, as bits. way_x, way_y: from the splat to the first pixel of the square.
    HALFLIT_INLINE std::uint32_t drawn_in(const SplatRecord& s, float way_x, float way_y) {
        // Roundings of products, and of m, which turn the ellipse.
        constexpr float kRounding = 0x1p-21f;
        const float most_x = vabs(way_x) + kSplatTile, most_y = vabs(way_y) + kSplatTile;
        const auto half_of = [&](float m0, float m1) {
            return kSplatBlockHalf * (vabs(m0) + vabs(m1)) + kRounding * (vabs(m0) * most_x + vabs(m1) * most_y);
        };
        const F half_u(half_of(s.m00, s.m01)), half_w(half_of(s.m10, s.m11)), half(kSplatBlockHalf + kRounding * (most_x + most_y));
        const F per_x(1.0f / s.half_x), per_y(1.0f / s.half_y), none(0.0f);
        std::uint32_t out = 0;
        for (int b = 0; b < kSplatBlocks; b += kWidth) {
            const F x = F(way_x) + load(kSplatPlaces.middle_x + b), y = F(way_y) + load(kSplatPlaces.middle_y + b);
            // Least u^2 + w^2 by the sides of the block, and by those of the box around the ellipse.
            const F u = vmax(vabs(mad(F(s.m00), x, F(s.m01) * y)) - half_u, none),
                    w = vmax(vabs(mad(F(s.m10), x, F(s.m11) * y)) - half_w, none);
            const F far = vmax(vmax(vabs(x) - half, none) * per_x, vmax(vabs(y) - half, none) * per_y);
            const F most_log2 = F(s.log2_opacity) - F(0.99999f) * vmax(mad(u, u, w * w), far * far);
            const M drawn = most_log2 >= load(least_log2 + b);
            out |= mask_bits(drawn) << b;
            store(spent + b, load(spent + b) + sel(drawn, none, load(per_alpha + b) * about_power_of_two(most_log2)));
        }
        return out;
    }
    HALFLIT_INLINE void charge(SplatTile& tile) const {
        constexpr double kRounding = 1.0005;  // of about_power_of_two(), and of sums of kAtOnce
        for (int b = 0; b < kSplatBlocks; ++b) tile.budget[b] -= kRounding * static_cast<double>(spent[b]);
    }
};

/// Of the pixels of a block at most.
struct SplatBlockSums {
    float passed;  ///< T
    float hidden;  ///< what T has lost
};
HALFLIT_INLINE float most_of(F v) {
    alignas(64) float lanes[kWidth];
    store(lanes, v);
    float most = lanes[0];
    for (const float lane : lanes) most = vmax(most, lane);
    return most;
}

/// Blends splats over a block, whose first pixel is at x_px, y_px. at: its index in the arrays of SplatTile. Each pixel goes through the
/// same splats by the same operations, whatever the instruction set: u and w are evaluated in the block's first two rows, and grow by twice
/// the slope from there to every second row, by three roundings at most.
template <bool kHidden, bool kPlanes>
inline SplatBlockSums blend_splat_block(const SplatRecord* records, const std::uint32_t* list, int count, int x_px, int y_px,
                                        SplatTile& tile, int at) {
    constexpr int kVectors = kSplatBlockPixels / kWidth, kTwoRows = 2 * kSplatBlock / kWidth;
    static_assert(kTwoRows > 0);
    // Sums of these splats alone, which are small where the splats are faint, so that their roundings are.
    const F none(0.0f), one(1.0f);
    F hidden[kVectors], red[kVectors], green[kVectors], blue[kVectors];
    for (int v = 0; v < kVectors; ++v) hidden[v] = red[v] = green[v] = blue[v] = none;
    for (int n = 0; n < count; ++n) {
        const SplatRecord& s = records[list[n]];
        const float way_x = s.way_x(x_px), way_y = s.way_y(y_px);
        const F u_first(mad(s.m00, way_x, s.m01 * way_y)), w_first(mad(s.m10, way_x, s.m11 * way_y));
        F u[kTwoRows], w[kTwoRows];
        for (int k = 0; k < kTwoRows; ++k) {
            const F x = load(kSplatPlaces.x + k * kWidth), y = load(kSplatPlaces.y + k * kWidth);
            u[k] = mad(F(s.m01), y, mad(F(s.m00), x, u_first)), w[k] = mad(F(s.m11), y, mad(F(s.m10), x, w_first));
        }
        const F u_down(s.m01 + s.m01), w_down(s.m11 + s.m11);
        const F log2_opacity(s.log2_opacity), s_red(s.color[0]), s_green(s.color[1]), s_blue(s.color[2]);
        for (int first_of_two = 0; first_of_two < kVectors; first_of_two += kTwoRows)
            for (int k = 0; k < kTwoRows; ++k) {
                const int v = first_of_two + k;
                [[maybe_unused]] const int p = at + v * kWidth;
                F alpha = splat_alpha(log2_opacity - u[k] * u[k] - w[k] * w[k]);
                u[k] = u[k] + u_down, w[k] = w[k] + w_down;
                if constexpr (kHidden) alpha = sel(F(s.z) < load(tile.limit + p), alpha, none);
                const F share = (one - hidden[v]) * alpha;
                if constexpr (kPlanes) {
                    const F half(0.5f), before = load(tile.passed + p), most_share = load(tile.most_share + p);
                    const F passed = before * (one - hidden[v]), behind = before * (one - (hidden[v] + share)), shown = passed * alpha;
                    store(tile.median + p, sel((passed >= half) & (behind < half), F(s.z), load(tile.median + p)));
                    store(tile.most_shown + p, sel(shown > most_share, I(static_cast<std::int32_t>(list[n])), load(tile.most_shown + p)));
                    store(tile.most_share + p, vmax(shown, most_share));
                }
                red[v] = mad(share, s_red, red[v]), green[v] = mad(share, s_green, green[v]), blue[v] = mad(share, s_blue, blue[v]);
                hidden[v] = hidden[v] + share;
            }
    }
    F most_passed(0.0f), most_hidden(0.0f);
    for (int v = 0; v < kVectors; ++v) {
        const int p = at + v * kWidth;
        const F before = load(tile.passed + p), passed = vmax(before * (one - hidden[v]), F(kLeastSplatPassed));
        store(tile.passed + p, passed);
        store(tile.color[0] + p, mad(before, red[v], load(tile.color[0] + p)));
        store(tile.color[1] + p, mad(before, green[v], load(tile.color[1] + p)));
        store(tile.color[2] + p, mad(before, blue[v], load(tile.color[2] + p)));
        most_passed = vmax(most_passed, passed), most_hidden = vmax(most_hidden, before * hidden[v]);
    }
    return {most_of(most_passed), most_of(most_hidden)};
}

inline bool blend_splats(const SplatRecord* records, const std::uint32_t* list, int count, std::size_t remaining, int x_px, int y_px,
                         SplatTile& tile) {
    const auto blend = tile.planes ? (tile.hides ? blend_splat_block<true, true> : blend_splat_block<false, true>)
                                   : (tile.hides ? blend_splat_block<true, false> : blend_splat_block<false, false>);
    for (int first = 0; first < count; first += SplatCuts::kAtOnce) {
        SplatCuts cuts(tile, static_cast<std::size_t>(count - first) + remaining);
        if (!cuts.any_live) return false;
        std::uint32_t in_block[kSplatBlocks][SplatCuts::kAtOnce];
        int counts[kSplatBlocks] = {};
        for (int n = first; n < vmin(first + SplatCuts::kAtOnce, count); ++n) {
            constexpr int kAhead = 16;
            if (n + kAhead < count) prefetch(records + list[n + kAhead]);
            const SplatRecord& s = records[list[n]];
            for (std::uint32_t blocks = cuts.drawn_in(s, s.way_x(x_px), s.way_y(y_px)); blocks != 0; blocks &= blocks - 1) {
                const int b = __builtin_ctz(blocks);
                in_block[b][counts[b]++] = list[n];
            }
        }
        cuts.charge(tile);
        for (int b = 0; b < kSplatBlocks; ++b) {
            if (counts[b] == 0) continue;
            const SplatBlockSums sums = blend(records, in_block[b], counts[b], x_px + b % kSplatBlocksAcross * kSplatBlock,
                                              y_px + b / kSplatBlocksAcross * kSplatBlock, tile, b * kSplatBlockPixels);
            // An ulp of `hidden` a splat, and few when the sums are added to those before.
            const float ulps = static_cast<float>(counts[b]) * sums.hidden + 4.0f * tile.most_passed[b];
            tile.rounding[b] += static_cast<double>(0x1p-24f * tile.largest * ulps);
            tile.most_passed[b] = sums.passed;
        }
    }
    return true;
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
