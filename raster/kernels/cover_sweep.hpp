// What covers hide along directions through a lattice, and on the ground below it.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "shading/kernels/simd.hpp"
#include "shading/plan/sky_grid_plan.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Share that is hidden towards a direction, from the i-th point of rows of parts on.
HALFLIT_INLINE F cover_towards(const float* const (&part)[kCoverParts], std::int64_t i, const float (&d)[3], const float (&size)[3]) {
    const F front = (load(part[0] + i) * F(d[0]) + load(part[1] + i) * F(d[1])) + load(part[2] + i) * F(d[2]);
    const F rest = (load(part[3] + i) * F(size[0]) + load(part[4] + i) * F(size[1])) + load(part[5] + i) * F(size[2]);
    return (vmax(front, F(0.0f)) + vmax(F(0.0f) - front, F(0.0f)) * load(part[6] + i)) + rest;
}

inline void sweep_covers(const CoverSweep& s) {
    const auto place = [](int row) { return (row + 1) * kSweepPitch + 1; };  // of a row's first point in the work space
    const std::int64_t half = (s.layout.rows + 2) * kSweepPitch;
    float *before = s.work, *after = s.work + half;
    for (std::int64_t i = 0; i < half; ++i) before[i] = 0.0f;
    const int first = s.along < 0.0f ? -1 : 0, below = s.across < 0.0f ? -1 : 0;  // of the two points, and rows, that are mixed
    const F u(s.along < 0.0f ? s.along + 1.0f : s.along), v(s.across < 0.0f ? s.across + 1.0f : s.across);
    for (int k = 0; k < s.layout.layers; ++k) {
        const int layer = s.from_last ? s.layout.layers - 1 - k : k;
        for (int r = 0; r < s.layout.rows; ++r) {
            const std::int64_t at = layer * s.layout.layer_step + r * s.layout.row_step;
            const float* const lower = before + place(r + below) + first;
            const float* const upper = lower + kSweepPitch;
            float* const next = after + place(r);
            const bool filled = s.filled[at / kCoverPitch] != 0;
            for (int i = 0; i < kCoverPitch; i += kWidth) {
                const F near = load(lower + i) + (load(upper + i) - load(lower + i)) * v;
                const F far = load(lower + i + 1) + (load(upper + i + 1) - load(lower + i + 1)) * v;
                const F here = near + (far - near) * u;
                store(s.hidden + at + i, here);
                store(next + i, filled ? vmin(here + cover_towards(s.parts, at + i, s.towards, s.size), F(1.0f)) : here);
            }
        }
        float* const swapped = before;
        before = after, after = swapped;
    }
}

inline void add_grid_terms(const GridTermSums& s) {
    constexpr int kTerms = shading::kGridTerms;
    for (std::int64_t p = s.first; p < s.end; p += kWidth) {
        F terms[kTerms];
        for (int k = 0; k < kTerms; ++k) terms[k] = load(s.sums + k * s.points + p);
        for (int d = 0; d < s.directions; ++d) {
            const F share = load(s.shares[d] + p);
            for (int k = 0; k < kTerms; ++k) terms[k] = mad(share, F(s.factors[d][k]), terms[k]);
        }
        for (int k = 0; k < kTerms; ++k) store(s.sums + k * s.points + p, terms[k]);
    }
}

inline void cover_ground(const GroundCover& s) {
    for (int r = 0; r < s.rows; ++r) {
        float* const out = s.shares + (r + 1) * kGroundPitch + 1;
        const std::int64_t at = r * s.row_step;
        const bool filled = s.filled[at / kCoverPitch] != 0;
        for (int i = 0; i < kCoverPitch; i += kWidth) store(out + i, filled ? cover_towards(s.parts, at + i, s.towards, s.size) : F(0.0f));
    }
    for (int step = 0; step < s.steps; ++step) {
        const float x = s.x[step], z = s.z[step];
        const auto floor_of = [](float a) {
            const int whole = static_cast<int>(a);
            return whole - (static_cast<float>(whole) > a ? 1 : 0);
        };
        const int left = floor_of(x), up = floor_of(z);
        const F u(x - static_cast<float>(left)), v(z - static_cast<float>(up));
        // Cell (i, k) of the map looks at point i - move_x, of those with a zero before the first, and the next one.
        const int move_x = s.first_x - left - 1, move_z = s.first_z - up - 1;
        const int begin = move_x > 0 ? move_x : 0, end = move_x + s.length + 1 < kGroundCells ? move_x + s.length + 1 : kGroundCells;
        const int last = move_z + s.rows + 1 < kGroundCells ? move_z + s.rows + 1 : kGroundCells;
        for (int k = move_z > 0 ? move_z : 0; k < last; ++k) {
            const float* const lower = s.shares + (k - move_z) * kGroundPitch - move_x;
            const float* const upper = lower + kGroundPitch;
            float* const out = s.sums + k * kGroundPitch;
            for (int i = begin; i < end; i += kWidth) {
                const F near = load(lower + i) + (load(upper + i) - load(lower + i)) * v;
                const F far = load(lower + i + 1) + (load(upper + i + 1) - load(lower + i + 1)) * v;
                store(out + i, load(out + i) + (near + (far - near) * u));
            }
        }
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
