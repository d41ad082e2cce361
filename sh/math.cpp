#include "halflit/math.hpp"

#include "sh/fp_environment.hpp"
#include "sh/mat4.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

namespace halflit {
namespace {

Vec4f column(Vec3d v, float w) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), w}; }

/// v / |v|; zero if v has no direction.
Vec3d unit(Vec3d v) {
    const double size = length(v);
    return size > 0.0 && size < 1e300 ? v * (1.0 / size) : Vec3d{};
}

bool zero(Vec3d v) { return v.x == 0.0 && v.y == 0.0 && v.z == 0.0; }

/// The axis that is least along v.
Vec3d least_axis(Vec3d v) {
    const auto size = [](double x) { return x < 0 ? -x : x; };
    const double x = size(v.x), y = size(v.y), z = size(v.z);
    return x <= y && x <= z ? Vec3d{1, 0, 0} : y <= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
}

}  // namespace

Vec4f operator*(const Mat4& m, Vec4f v) {
    const FpEnvironment environment_of_host;
    return ((m.c[0] * v.x + m.c[1] * v.y) + m.c[2] * v.z) + m.c[3] * v.w;
}

Mat4 operator*(const Mat4& a, const Mat4& b) {
    const FpEnvironment environment_of_host;
    return {{a * b.c[0], a * b.c[1], a * b.c[2], a * b.c[3]}};
}

Mat4 translation(Vec3f t) { return {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {t.x, t.y, t.z, 1}}}; }

Mat4 scaling(Vec3f s) { return {{{s.x, 0, 0, 0}, {0, s.y, 0, 0}, {0, 0, s.z, 0}, {0, 0, 0, 1}}}; }

Mat4 rotation(Vec4f q) {
    const FpEnvironment environment_of_host;
    const float x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
    const float xx = q.x * x2, yy = q.y * y2, zz = q.z * z2;
    const float xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
    const float wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
    return {
        {{1 - (yy + zz), xy + wz, xz - wy, 0}, {xy - wz, 1 - (xx + zz), yz + wx, 0}, {xz + wy, yz - wx, 1 - (xx + yy), 0}, {0, 0, 0, 1}}};
}

Mat4 rotation(Vec3f axis, float angle_rad) {
    const FpEnvironment environment_of_host;
    const Vec3d n = unit(to_double(axis));
    if (zero(n) || !(angle_rad - angle_rad == 0.0f)) return {};
    const SinCos a = sin_cos(static_cast<double>(angle_rad));
    // Rodrigues: the image of v is v cos + (n x v) sin + n (n.v) (1 - cos).
    const auto turned = [&](Vec3d v) { return (v * a.cos + cross(n, v) * a.sin) + n * (dot(n, v) * (1.0 - a.cos)); };
    return {{column(turned({1, 0, 0}), 0), column(turned({0, 1, 0}), 0), column(turned({0, 0, 1}), 0), {0, 0, 0, 1}}};
}

Mat4 look_at(Vec3f eye, Vec3f target, Vec3f up) {
    const FpEnvironment environment_of_host;
    Vec3d back = unit(to_double(eye) - to_double(target));
    if (zero(back)) back = {0, 0, 1};
    const Vec3d upward = unit(to_double(up));
    Vec3d right = cross(upward, back);
    // A nearly parallel `up` would leave only rounding errors.
    if (!(length(right) > 1e-6)) right = cross(least_axis(back), back);
    right = unit(right);
    return {{column(right, 0), column(cross(back, right), 0), column(back, 0), {eye.x, eye.y, eye.z, 1}}};
}

}  // namespace halflit
