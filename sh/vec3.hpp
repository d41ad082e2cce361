// Small vectors over a number type T (float, double, or a SIMD batch). Component order is x, y, z, w.
// Every sum has one fixed association, written out, so that all instruction sets give the same bits.
#pragma once

#include "sh/config.hpp"

// clang-format off
namespace halflit {

template <class T>
struct Vec2 {
    T x{}, y{};
    friend bool operator==(const Vec2&, const Vec2&) = default;  // constexpr where T's is
};

template <class T>
struct Vec3 {
    T x{}, y{}, z{};
    friend bool operator==(const Vec3&, const Vec3&) = default;  // constexpr where T's is
};

template <class T>
struct Vec4 {
    T x{}, y{}, z{}, w{};
    friend bool operator==(const Vec4&, const Vec4&) = default;  // constexpr where T's is
};

using Vec2f = Vec2<float>;
using Vec3f = Vec3<float>;
using Vec4f = Vec4<float>;
using Vec3d = Vec3<double>;

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
/// Component by component.
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

/// (a.x b.x + a.y b.y) + a.z b.z
template <class T>
HALFLIT_INLINE constexpr T dot(Vec3<T> a, Vec3<T> b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }

template <class T>
HALFLIT_INLINE constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Length by one correctly rounded square root; overflows above 1.8e19 and underflows below 1e-23 in float.
HALFLIT_INLINE float length(Vec3f v) { return __builtin_sqrtf(dot(v, v)); }
HALFLIT_INLINE double length(Vec3d v) { return __builtin_sqrt(dot(v, v)); }

/// v / |v|, computed in double so that every finite float vector keeps its direction; `fallback` for zero, NaN, infinity.
HALFLIT_INLINE Vec3f normalize_or(Vec3f v, Vec3f fallback) {
    const Vec3d d{v.x, v.y, v.z};
    const double len = length(d);
    if (!(len > 0.0) || !(len < 1e300)) return fallback;
    return {static_cast<float>(d.x / len), static_cast<float>(d.y / len), static_cast<float>(d.z / len)};
}

}  // namespace halflit
