// Splats from object coordinates to the picture.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "sh/basis.hpp"
#include "shading/kernels/pow.hpp"
#include "shading/kernels/simd_double.hpp"

#include <utility>

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

struct DoubleVec3 {
    D x, y, z;
};
HALFLIT_INLINE D dot(DoubleVec3 a, DoubleVec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HALFLIT_INLINE DoubleVec3 placed(const double (&m)[3][3], const double (&origin)[3], DoubleVec3 p) {
    const auto row = [&](int r) { return d_set(m[r][0]) * p.x + d_set(m[r][1]) * p.y + d_set(m[r][2]) * p.z + d_set(origin[r]); };
    return {row(0), row(1), row(2)};
}

/// Adds the spherical harmonics of N bands at a direction to the colours. at: places of the first coefficients.
template <int N>
HALFLIT_INLINE void add_harmonics(const float* harmonics, I at, Vec3<F> direction, F (&color)[3]) {
    F y[N * N];
    sh::evaluate_basis<N>(direction, y);
    for (int k = 0; k < N * N; ++k)
        for (int channel = 0; channel < 3; ++channel) color[channel] = mad(y[k], gather(harmonics + 3 * k + channel, at), color[channel]);
}

/// Double where digits are lost: places, and determinants of thin discs, which are sums of squares.
inline int project_splats(const SplatView& view, const SplatBatch& batch, SplatRecord* out, double* distances, std::uint32_t* numbers) {
    const auto [least_x, least_y] = view.least_slope;
    const auto [most_x, most_y] = view.most_slope;
    const std::int32_t stride = 3 * (batch.degree + 1) * (batch.degree + 1);
    const D one = d_set(1.0), none = d_set(0.0);
    int written = 0;
    bool some_seen = false;  // of the last vector
    for (int first = 0; first < batch.count; first += kWidth) {
        alignas(64) std::int32_t index[4][kWidth];
        for (int lane = 0; lane < kWidth; ++lane) {
            const std::int32_t i = vmin(first + lane, batch.count - 1);
            index[0][lane] = i, index[1][lane] = 3 * i, index[2][lane] = 4 * i, index[3][lane] = stride * i;
        }
        // Where some are seen, those that follow are so as a rule.
        constexpr int kAhead = 2 * kWidth;
        constexpr int kLine = 16;  // floats of a line of the cache
        if (std::exchange(some_seen, false) && first + kAhead + kWidth <= batch.count)
            for (int k = 0; k < stride * kWidth; k += kLine) prefetch(batch.harmonics + (stride * (first + kAhead) + k));
        const I by_one = load(index[0]), by_three = load(index[1]), by_four = load(index[2]);
        const auto of = [](const float* base, I at) { return to_double(gather(base, at)); };
        const DoubleVec3 position{of(batch.positions, by_three), of(batch.positions + 1, by_three), of(batch.positions + 2, by_three)};
        const DoubleVec3 way = placed(view.axes, view.origin, position);
        const F opacity = gather(batch.opacities, by_one);
        M seen = (to_single(way.z - d_set(view.nearest)) >= F(0.0f)) & (opacity > F(0.0f));
        if (first + kWidth > batch.count) seen = seen & (iota_f() < F(static_cast<float>(batch.count - first)));
        if (!any(seen)) continue;

        // Rows of the projection's slope, along the axes of the object and then of the splat.
        const D per_z = view.orthographic ? one : one / way.z, slope_x = way.x * per_z, slope_y = way.y * per_z;
        const D held_x = view.orthographic ? none : vmax(vmin(slope_x, d_set(most_x)), d_set(least_x)),
                held_y = view.orthographic ? none : vmax(vmin(slope_y, d_set(most_y)), d_set(least_y));
        const D size_x = d_set(view.focal[0]) * per_z, size_y = d_set(view.focal[1]) * per_z;
        const auto row = [&](int axis, D held, D size) {
            const auto at = [&](int k) { return (d_set(view.axes[axis][k]) - d_set(view.axes[2][k]) * held) * size; };
            return DoubleVec3{at(0), at(1), at(2)};
        };
        const DoubleVec3 row_x = row(0, held_x, size_x), row_y = row(1, held_y, size_y);
        const D qx = of(batch.rotations, by_four), qy = of(batch.rotations + 1, by_four), qz = of(batch.rotations + 2, by_four),
                qw = of(batch.rotations + 3, by_four);
        const D norm = qx * qx + qy * qy + qz * qz + qw * qw, t = d_set(2.0) / norm;
        const D scale[3] = {of(batch.scales, by_three), of(batch.scales + 1, by_three), of(batch.scales + 2, by_three)};
        const DoubleVec3 axes[3] = {{one - t * (qy * qy + qz * qz), t * (qx * qy + qw * qz), t * (qx * qz - qw * qy)},
                                    {t * (qx * qy - qw * qz), one - t * (qx * qx + qz * qz), t * (qy * qz + qw * qx)},
                                    {t * (qx * qz + qw * qy), t * (qy * qz - qw * qx), one - t * (qx * qx + qy * qy)}};
        const auto through = [&](DoubleVec3 r) {
            return DoubleVec3{dot(axes[0], r) * scale[0], dot(axes[1], r) * scale[1], dot(axes[2], r) * scale[2]};
        };
        const DoubleVec3 u = through(row_x), v = through(row_y);
        const DoubleVec3 minors{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
        const D xx = dot(u, u), xy = dot(u, v), yy = dot(v, v), before = dot(minors, minors), grown = d_set(view.variance);
        const D area = before + grown * (xx + yy) + grown * grown, cxx = xx + grown, cyy = yy + grown;
        F kept_opacity = vmin(opacity, F(1.0f));
        if (view.least_area <= 1.0) kept_opacity = kept_opacity * to_single(vsqrt(vmax(before / area, d_set(view.least_area))));
        const Log2 log2 = log2_parts(kLog2Degree8, kept_opacity);
        const F log2_opacity = log2.exponent + log2.fraction, reach = log2_opacity - F(view.least_log2);

        // Axes of the ellipse; the smaller variance follows from the area.
        const D half = d_set(0.5) * (cxx - cyy), root = vsqrt(half * half + xy * xy), larger = d_set(0.5) * (cxx + cyy) + root;
        const D smaller = area / larger, ax = where_positive(half, half + root, xy), ay = where_positive(half, xy, root - half);
        const D length = vsqrt(ax * ax + ay * ay), per_length = one / length;
        const D cosine = where_positive(length, ax * per_length, one), sine = where_positive(length, ay * per_length, none);
        const D half_log2_e = d_set(0.72134752044448170), along = vsqrt(half_log2_e / larger), across = vsqrt(half_log2_e / smaller);
        const D x = d_set(view.middle[0]) + d_set(view.focal[0]) * slope_x, y = d_set(view.middle[1]) + d_set(view.focal[1]) * slope_y;
        const F half_x = to_single(vsqrt(cxx / half_log2_e)), half_y = to_single(vsqrt(cyy / half_log2_e));
        const F area_f = to_single(area), m00 = to_single(cosine * along), m01 = to_single(sine * along),
                m10 = to_single(none - sine * across), m11 = to_single(cosine * across);
        const F x_f = to_single(x), y_f = to_single(y);
        constexpr float kFar = 1e9f, kBeside = 3.0f;  // pixels; kBeside: what is listed in squares must be in
        seen = seen & (reach > F(0.0f)) & (area_f > F(0.0f)) & (area_f < F(1e38f)) & (vabs(x_f) < F(kFar)) & (vabs(y_f) < F(kFar));
        seen = seen & (vabs(m00) < F(1e18f)) & (vabs(m01) < F(1e18f)) & (vabs(m10) < F(1e18f)) & (vabs(m11) < F(1e18f));
        const F far = vsqrt(vmax(reach, F(0.0f))), far_x = far * half_x + F(kBeside), far_y = far * half_y + F(kBeside);
        const auto edge = [](int at) { return F(static_cast<float>(at)); };
        seen = seen & (x_f + far_x > edge(view.x0)) & (x_f - far_x < edge(view.x1)) & (y_f + far_y > edge(view.y0)) &
               (y_f - far_y < edge(view.y1));
        if (!any(seen)) continue;

        some_seen = true;
        const DoubleVec3 from_eye = placed(view.turn, view.turn_origin, position);
        const D from_eye_length = vsqrt(dot(from_eye, from_eye)), per_eye = one / from_eye_length;
        const auto direction = [&](D a, double otherwise) {
            return to_single(where_positive(from_eye_length, a * per_eye, d_set(otherwise)));
        };
        const Vec3<F> d{direction(from_eye.x, 0.0), direction(from_eye.y, 0.0), direction(from_eye.z, 1.0)};
        F color[3] = {F(0.5f), F(0.5f), F(0.5f)};
        const I coefficients = load(index[3]);
        switch (batch.degree) {
            case 0:
                add_harmonics<1>(batch.harmonics, coefficients, d, color);
                break;
            case 1:
                add_harmonics<2>(batch.harmonics, coefficients, d, color);
                break;
            case 2:
                add_harmonics<3>(batch.harmonics, coefficients, d, color);
                break;
            case 3:
                add_harmonics<4>(batch.harmonics, coefficients, d, color);
                break;
            default:
                add_harmonics<5>(batch.harmonics, coefficients, d, color);
        }
        D distance = way.z;
        if (view.by_distance) {
            const DoubleVec3 in_world = placed(view.world, view.world_origin, position);
            distance = vsqrt(dot(in_world, in_world));
        }
        constexpr float kMostColor = 1e6f;
        struct {
            alignas(64) float m00[kWidth], m01[kWidth], m10[kWidth], m11[kWidth],
                log2_opacity[kWidth], half_x[kWidth], half_y[kWidth], z[kWidth], color[3][kWidth];
            alignas(64) double x[kWidth], y[kWidth], distance[kWidth];
        } of_lane;
        store(of_lane.m00, m00), store(of_lane.m01, m01), store(of_lane.m10, m10), store(of_lane.m11, m11),
            store(of_lane.log2_opacity, log2_opacity);
        store(of_lane.half_x, half_x), store(of_lane.half_y, half_y), store(of_lane.z, to_single(way.z));
        for (int channel = 0; channel < 3; ++channel) store(of_lane.color[channel], vmin(vmax(color[channel], F(0.0f)), F(kMostColor)));
        store(of_lane.x, x), store(of_lane.y, y), store(of_lane.distance, distance);
        for (std::uint32_t lanes = mask_bits(seen); lanes != 0; lanes &= lanes - 1) {
            const int lane = __builtin_ctz(lanes);
            SplatRecord& s = out[written];
            const double whole_x = __builtin_floor(of_lane.x[lane]), whole_y = __builtin_floor(of_lane.y[lane]);
            s.x = static_cast<std::int32_t>(whole_x), s.y = static_cast<std::int32_t>(whole_y);
            s.x_part = static_cast<float>(of_lane.x[lane] - whole_x - 0.5), s.y_part = static_cast<float>(of_lane.y[lane] - whole_y - 0.5);
            s.m00 = of_lane.m00[lane], s.m01 = of_lane.m01[lane], s.m10 = of_lane.m10[lane], s.m11 = of_lane.m11[lane];
            s.log2_opacity = of_lane.log2_opacity[lane], s.half_x = of_lane.half_x[lane], s.half_y = of_lane.half_y[lane],
            s.z = of_lane.z[lane];
            for (int channel = 0; channel < 3; ++channel) s.color[channel] = of_lane.color[channel][lane];
            if (numbers != nullptr) numbers[written] = batch.first + static_cast<std::uint32_t>(first + lane);
            distances[written++] = of_lane.distance[lane];
        }
    }
    return written;
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
