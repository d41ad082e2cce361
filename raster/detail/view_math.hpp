// Numerics of cameras and framing: clamps for extreme or invalid input, and tangents of angles without the C library.
#pragma once

#include "halflit/mesh.hpp"
#include "sh/trig.hpp"
#include "shading/model/numbers.hpp"

namespace halflit::raster {

inline constexpr double kMinFov = 1e-5, kMaxFov = 3.1415;  // rad; tan of the half angle stays within [5e-6, 2.2e4]

using shading::finite;

HALFLIT_INLINE double magnitude(double x) { return x < 0 ? -x : x; }
HALFLIT_INLINE double larger(double a, double b) { return a < b ? b : a; }
HALFLIT_INLINE double clamped(double x, double low, double high) { return x < low ? low : high < x ? high : x; }

HALFLIT_INLINE double half_angle_tangent(double fov_rad) {
    const SinCos h = sin_cos(0.5 * fov_rad);
    return h.sin / h.cos;
}

HALFLIT_INLINE double usable_aspect(float aspect) { return aspect > 0.0f && finite(aspect) ? clamped(aspect, 1e-6, 1e6) : 1.0; }

HALFLIT_INLINE double usable_fov(float fov_rad) { return finite(fov_rad) ? clamped(fov_rad, kMinFov, kMaxFov) : 0.25 * kPi; }

/// A column of a matrix.
HALFLIT_INLINE Vec4f column(Vec3d v, float w) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), w}; }

/// The largest magnitude of a coordinate; 0 for an empty box.
inline double largest_coordinate(const Bounds& b) {
    if (b.empty) return 0.0;
    double largest = 0.0;
    for (const float v : {b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z}) largest = larger(largest, magnitude(double{v}));
    return largest;
}

}  // namespace halflit::raster
