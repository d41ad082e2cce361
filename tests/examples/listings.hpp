// The shader listings of apps/examples, compiled as C++ by a few types and functions that both languages have. `float` is double here, so
// that their formulas can be compared with others to many digits.
#pragma once

#include <algorithm>
#include <cmath>

namespace halflit::listings {

struct vec2 {
    double x, y;
    vec2(double x_, double y_) : x(x_), y(y_) {}
};

struct vec3 {
    double x = 0, y = 0, z = 0;
    vec3() = default;
    vec3(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
    friend vec3 operator+(vec3 a, vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend vec3 operator-(vec3 a, vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend vec3 operator*(vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
};

inline double max(double a, double b) { return std::max(a, b); }
inline vec3 max(vec3 a, vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }
inline double min(double a, double b) { return std::min(a, b); }
inline double clamp(double x, double low, double high) { return std::min(std::max(x, low), high); }
inline double pow(double x, double y) { return std::pow(x, y); }

// The listings define functions that are not inline: one source of a program includes this header.
#define float double
namespace glsl {
#include "apps/examples/wrap_shading.glsl"
}
namespace hlsl {
using float2 = vec2;
using float3 = vec3;
#include "apps/examples/wrap_shading.hlsl"
}  // namespace hlsl
#undef float

}  // namespace halflit::listings
