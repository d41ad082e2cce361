// Vectors and matrices. Component order is x, y, z, w. Every sum has one fixed order, written out.
//
// The library's results have the same bits on every machine. The vector operators below are compiled with the caller's flags: where
// their results must be the same everywhere too, compile with -ffp-contract=off and without -ffast-math. The functions of matrices are the
// library's own code, and need no flag.
#pragma once

#include "halflit/export.hpp"

/// Forces inlining, also at -O0: no symbol of code for several instruction sets is left that the linker could merge.
#ifndef HALFLIT_INLINE
#define HALFLIT_INLINE inline __attribute__((always_inline))
#endif
// clang-format off
namespace halflit {

/// Two components, 0 by default.
template <class T>
struct Vec2 {
    T x{}, y{};  ///< of texture coordinates, u and v
    friend bool operator==(const Vec2&, const Vec2&) = default;  // constexpr where T's is
};

/// Three components, 0 by default.
template <class T>
struct Vec3 {
    T x{}, y{}, z{};  ///< in the world, y is up; of a colour, red, green and blue
    friend bool operator==(const Vec3&, const Vec3&) = default;  // constexpr where T's is
};

/// Four components, 0 by default.
template <class T>
struct Vec4 {
    T x{}, y{}, z{}, w{};  ///< w is 1 for a point, 0 for a direction; of a colour, alpha
    friend bool operator==(const Vec4&, const Vec4&) = default;  // constexpr where T's is
};

using Vec2f = Vec2<float>;   ///< texture coordinates
using Vec3f = Vec3<float>;   ///< positions, directions, colours
using Vec4f = Vec4<float>;   ///< homogeneous points, tangents, quaternions, colours with alpha
using Vec3d = Vec3<double>;  ///< positions and lengths that float would round too much or overflow

/// @{
/// Component by component; a number `s` multiplies every component.
template <class T>
HALFLIT_INLINE constexpr Vec2<T> operator+(Vec2<T> a, Vec2<T> b) { return {a.x + b.x, a.y + b.y}; }
template <class T>
HALFLIT_INLINE constexpr Vec2<T> operator-(Vec2<T> a, Vec2<T> b) { return {a.x - b.x, a.y - b.y}; }
template <class T>
HALFLIT_INLINE constexpr Vec2<T> operator*(Vec2<T> a, T s) { return {a.x * s, a.y * s}; }

template <class T>
HALFLIT_INLINE constexpr Vec3<T> operator+(Vec3<T> a, Vec3<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T>
HALFLIT_INLINE constexpr Vec3<T> operator-(Vec3<T> a, Vec3<T> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T>
HALFLIT_INLINE constexpr Vec3<T> operator*(Vec3<T> a, Vec3<T> b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
template <class T>
HALFLIT_INLINE constexpr Vec3<T> operator*(Vec3<T> a, T s) { return {a.x * s, a.y * s, a.z * s}; }

template <class T>
HALFLIT_INLINE constexpr Vec4<T> operator+(Vec4<T> a, Vec4<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
template <class T>
HALFLIT_INLINE constexpr Vec4<T> operator-(Vec4<T> a, Vec4<T> b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
template <class T>
HALFLIT_INLINE constexpr Vec4<T> operator*(Vec4<T> a, T s) { return {a.x * s, a.y * s, a.z * s, a.w * s}; }
/// @}

/// (a.x b.x + a.y b.y) + a.z b.z
template <class T>
HALFLIT_INLINE constexpr T dot(Vec3<T> a, Vec3<T> b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }

/// Perpendicular to both, by the right-hand rule. Its length is the area of the parallelogram of a and b.
template <class T>
HALFLIT_INLINE constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Length by one correctly rounded square root; overflows above 1.8e19 and underflows below 1e-23 in float.
HALFLIT_INLINE float length(Vec3f v) { return __builtin_sqrtf(dot(v, v)); }
/// The same in double: overflows above 1.3e154, underflows below 1e-162.
HALFLIT_INLINE double length(Vec3d v) { return __builtin_sqrt(dot(v, v)); }

/// v / |v|, computed in double so that every finite float vector keeps its direction; `fallback` for zero, NaN, infinity.
HALFLIT_INLINE Vec3f normalize_or(Vec3f v, Vec3f fallback) {
    const Vec3d d{v.x, v.y, v.z};
    const double len = length(d);
    if (!(len > 0.0) || !(len < 1e300)) return fallback;
    return {static_cast<float>(d.x / len), static_cast<float>(d.y / len), static_cast<float>(d.z / len)};
}

/// A 4x4 matrix, column major: c[j] is the image of basis vector j. A point p maps to ((c0 x + c1 y) + c2 z) + c3.
struct Mat4 {
    Vec4f c[4]{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};  ///< columns; by default the identity
    /// Maps every point to itself.
    [[nodiscard]] static constexpr Mat4 identity() { return {}; }
    friend constexpr bool operator==(const Mat4&, const Mat4&) = default;
};

/// ((c0 x + c1 y) + c2 z) + c3 w
[[nodiscard]] HALFLIT_API Vec4f operator*(const Mat4& m, Vec4f v);
/// Applies b first, then a.
[[nodiscard]] HALFLIT_API Mat4 operator*(const Mat4& a, const Mat4& b);

/// Moves points by t, and leaves directions (w = 0) alone.
[[nodiscard]] HALFLIT_API Mat4 translation(Vec3f t);
/// Scales along the axes; a negative factor mirrors.
[[nodiscard]] HALFLIT_API Mat4 scaling(Vec3f s);
/// Rotation by the unit quaternion (x, y, z, w), as glTF stores it.
[[nodiscard]] HALFLIT_API Mat4 rotation(Vec4f quaternion);
/// Rotation about an axis of any length, counter-clockwise seen against the axis. The identity if the axis has no direction, and for an
/// angle beyond 1e6 or not a number.
[[nodiscard]] HALFLIT_API Mat4 rotation(Vec3f axis, float angle_rad);
/// Place of a camera (Camera::world_from_camera), or of any object that looks along its -z: at `eye`, looking at `target`, with `up`
/// upwards in the picture. Where `up` is parallel to the view, or the target is the eye, another axis is taken: the result is always rigid.
[[nodiscard]] HALFLIT_API Mat4 look_at(Vec3f eye, Vec3f target, Vec3f up = {0, 1, 0});

}  // namespace halflit
