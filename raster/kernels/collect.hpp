// From the numbers that the samples of a row of pixels show to its fragments: each triangle that a pixel shows, once, with its samples.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "shading/kernels/simd_pack.hpp"
#include "shading/kernels/simd_records.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

HALFLIT_INLINE void append(PixelFragments& out, I id, I x_px, I samples, std::uint32_t lanes) {
    store_packed(reinterpret_cast<std::int32_t*>(out.id) + out.count, id, lanes);
    store_packed(out.x_px + out.count, x_px, lanes);
    store_packed(out.samples + out.count, samples, lanes);
    out.count += __builtin_popcount(lanes);
}

/// Pixels of four samples. lanes: those that show something.
HALFLIT_INLINE void append_four(PixelFragments& out, const I (&id)[4], int x_px, std::uint32_t lanes) {
    // own[s]: the samples that show what sample s does, if s is the first of them.
    const I none(0);
    I own[4];
    for (int s = 0; s < 4; ++s) {
        own[s] = I(1 << s);
        for (int later = s + 1; later < 4; ++later) own[s] = own[s] | sel(equal(id[s], id[later]), I(1 << later), none);
        for (int before = 0; before < s; ++before) own[s] = sel(equal(id[s], id[before]), none, own[s]);
        own[s] = sel(equal(id[s], I(-1)), none, own[s]);
    }
    // Pixel by pixel, as other numbers of lanes do it.
    alignas(64) float ids[4 * kWidth], samples[4 * kWidth];
    store4(ids, from_bits(id[0]), from_bits(id[1]), from_bits(id[2]), from_bits(id[3]));
    store4(samples, from_bits(own[0]), from_bits(own[1]), from_bits(own[2]), from_bits(own[3]));
    constexpr int kStep = kWidth < 4 ? 4 : kWidth;
    for (int i = 0; i < 4 * kWidth; i += kStep) {
        if ((lanes >> (i / 4) & ((1u << (kStep / 4)) - 1u)) == 0) continue;
        for (int j = i; j < i + kStep; j += kWidth) {
            const I of = bits(load(samples + j));
            append(out, bits(load(ids + j)), I(x_px) + shr<2>(I(j) + iota_i()), of, mask_bits(less(none, of)));
        }
    }
}

/// One pixel with any number of samples.
HALFLIT_INLINE void append_pixel(PixelFragments& out, const TileBuffers& buffers, int samples, int at, int x_px) {
    for (unsigned left = (1u << samples) - 1u; left != 0;) {
        const std::uint32_t id = buffers.triangle[__builtin_ctz(left)][at];
        unsigned own = 0;
        for (int s = 0; s < samples; ++s) own |= buffers.triangle[s][at] == id ? 1u << s : 0u;
        left &= ~own;
        if (id == kNoTriangle) continue;
        out.id[out.count] = id;
        out.x_px[out.count] = x_px;
        out.samples[out.count] = static_cast<std::int32_t>(own);
        ++out.count;
    }
}

inline void collect(const TileBuffers& buffers, int samples, int at, int x_px, int count, PixelFragments& out) {
    out.count = 0;
    out.pixels = 0;
    const I none(-1);
    for (int i = 0; i < count; i += kWidth) {
        const auto load_ids = [&](int s) __attribute__((always_inline)) {
            return load(reinterpret_cast<const std::int32_t*>(buffers.triangle[s]) + at + i);
        };
        const std::uint32_t inside =
            count - i < kWidth ? (1u << (count - i)) - 1u : static_cast<std::uint32_t>((std::uint64_t{1} << kWidth) - 1u);
        const I first = load_ids(0);
        I mixed(0), seen = none;
        for (int s = 1; s < samples; ++s) {
            const I id = load_ids(s);
            mixed = mixed | (id ^ first);
            seen = seen & id;
        }
        seen = seen & first;
        const std::uint32_t some = ~mask_bits(equal(seen, none)) & inside;
        out.pixels += __builtin_popcount(some);
        if (some == 0) continue;
        const std::uint32_t several = ~mask_bits(equal(mixed, I(0))) & some;
        if (several == 0) {
            append(out, first, I(x_px + i) + iota_i(), I((1 << samples) - 1), some);
        } else if (samples == 4) {
            const M in_row = less(iota_i(), I(count - i));
            const I id[4] = {sel(in_row, first, none), sel(in_row, load_ids(1), none), sel(in_row, load_ids(2), none),
                             sel(in_row, load_ids(3), none)};
            append_four(out, id, x_px + i, some);
        } else {
            for (std::uint32_t left = some; left != 0; left &= left - 1) {
                const int l = __builtin_ctz(left);
                append_pixel(out, buffers, samples, at + i + l, x_px + i + l);
            }
        }
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
