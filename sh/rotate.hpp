// Rotations of expansions. A rotated polynomial is a polynomial of the same degree. It is evaluated at the rotated nodes of an exact
// quadrature and projected again, which is exact. There is no recurrence over bands and no special case at the poles.
#pragma once

#include "sh/coefficients.hpp"

namespace halflit::sh {

/// An orthogonal 3x3 matrix, stored by columns: c[0] is the image of the x axis. Reflections are allowed.
struct Rotation {
    Vec3d c[3]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

[[nodiscard]] inline Vec3d operator*(const Rotation& r, Vec3d v) { return (r.c[0] * v.x + r.c[1] * v.y) + r.c[2] * v.z; }
[[nodiscard]] inline Rotation operator*(const Rotation& a, const Rotation& b) { return {{a * b.c[0], a * b.c[1], a * b.c[2]}}; }
[[nodiscard]] inline Rotation inverse(const Rotation& r) {
    return {{{r.c[0].x, r.c[1].x, r.c[2].x}, {r.c[0].y, r.c[1].y, r.c[2].y}, {r.c[0].z, r.c[1].z, r.c[2].z}}};
}

/// Rotation about +y, counterclockwise seen from above: +z goes towards +x.
[[nodiscard]] inline Rotation rotation_about_y(double angle_rad) {
    const SinCos a = sin_cos(angle_rad);
    return {{{a.cos, 0, -a.sin}, {0, 1, 0}, {a.sin, 0, a.cos}}};
}

/// Expansion of d -> L(r^-1 d): the light of direction d moves to r d. Bands do not mix. Error: below 1e-13 of the band's norm.
[[nodiscard]] RadianceSh rotated(const RadianceSh& sh, const Rotation& r);

}  // namespace halflit::sh
