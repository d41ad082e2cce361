// Maps of directions: where a direction lies in one, and the four values about it.
#pragma once

#include "shading/kernels/simd_texels.hpp"
#include "shading/kernels/vector.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Angle of (x, y) from the x axis, in [-pi, pi], within 3e-7; (0, 0) gives 0.
HALFLIT_INLINE F angle_of(F y, F x) {
    constexpr float kCoefficients[] = {1.0f,
                                       -0.3333309292793274f,
                                       0.19993053376674652f,
                                       -0.14207127690315247f,
                                       0.10654652863740921f,
                                       -0.07533621788024902f,
                                       0.04303872212767601f,
                                       -0.01628260686993599f,
                                       0.0029034512117505074f};
    const F ax = vabs(x), ay = vabs(y), zero(0.0f);
    const F t = vdiv(vmin(ax, ay), vmax(vmax(ax, ay), F(1e-30f))), s = t * t;
    F p(kCoefficients[8]);
    for (int i = 7; i >= 0; --i) p = mad(p, s, F(kCoefficients[i]));
    const F octant = p * t, quadrant = sel(ay > ax, F(1.57079633f) - octant, octant);
    const F half = sel(x < zero, F(3.14159265f) - quadrant, quadrant);
    return sel(y < zero, vneg(half), half);
}

/// A direction as a point of a map (ReflectionMap), both coordinates in [0, 1]. turned: ReflectionPlan's.
struct GlobePoint {
    F u, v;
};
HALFLIT_INLINE GlobePoint globe_point(V3 direction, F turned) {
    const F turn(0.159154943f), one(1.0f), none(0.0f);
    const F across = vsqrt(direction.x * direction.x + direction.z * direction.z);
    const F u = mad(angle_of(direction.x, vneg(direction.z)), turn, F(0.5f)) + turned;
    return {clamp(u - vfloor(u), none, one), clamp(angle_of(across, direction.y) * (turn + turn), none, one)};
}

/// The upper left of the four values about a point in a level of so many rows, as a number of floats from the map's first one; from a row
/// to the next; and weights.
struct MapTaps {
    alignas(64) std::int32_t index[kWidth], below[kWidth];
    alignas(64) float right[kWidth], down[kWidth];
};
HALFLIT_INLINE void map_taps(GlobePoint at, F rows, I first, MapTaps& out) {
    const F columns = rows + rows;
    const F x = at.u * columns, y = at.v * rows;
    const F x_low = vmin(vfloor(x), columns - F(1.0f)), y_low = vmin(vfloor(y), rows - F(1.0f));
    store(out.right, x - x_low);
    store(out.down, y - y_low);
    const I row = round_to_int(columns) + I(1);
    store(out.index, shl<2>(first + round_to_int(y_low) * row + round_to_int(x_low)));
    store(out.below, shl<2>(row));
}
HALFLIT_INLINE TapRows<float> rows_of(const float* rgba, const MapTaps& taps, int lane) {
    const float* const upper = rgba + taps.index[lane];
    return {upper, upper + taps.below[lane]};
}
HALFLIT_INLINE TapWeights weights_of(const MapTaps& taps, int lane) { return {taps.right[lane], taps.down[lane]}; }

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
