// Transforms by 4x4 matrices, for the inner loops. Only + - * / are used: the same bits on every machine.
#pragma once

#include "halflit/math.hpp"

#include <initializer_list>

namespace halflit {

HALFLIT_INLINE Vec3f transform_point(const Mat4& m, Vec3f p) {
    const Vec4f r = ((m.c[0] * p.x + m.c[1] * p.y) + m.c[2] * p.z) + m.c[3];
    return {r.x, r.y, r.z};
}

HALFLIT_INLINE Vec3f transform_vector(const Mat4& m, Vec3f v) {
    const Vec4f r = (m.c[0] * v.x + m.c[1] * v.y) + m.c[2] * v.z;
    return {r.x, r.y, r.z};
}

/// The image of an axis, 0 to 2, or of the origin, 3.
HALFLIT_INLINE Vec3d axis(const Mat4& m, int i) { return {m.c[i].x, m.c[i].y, m.c[i].z}; }

/// Determinant of the upper left 3x3; negative for a mirroring transform.
HALFLIT_INLINE double determinant3(const Mat4& m) { return dot(axis(m, 0), cross(axis(m, 1), axis(m, 2))); }

/// Columns of the matrix that carries normals: the cofactors of the upper left 3x3, i.e. det * inverse transpose.
/// Its result is not unit length, and for a mirroring transform it points inwards unless multiplied by the sign of det.
struct NormalMatrix {
    Vec3f c[3]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

/// The cofactor matrix, times the sign of the determinant, scaled so that its largest entry is 1 (direction is kept).
HALFLIT_INLINE NormalMatrix normal_matrix(const Mat4& m) {
    const Vec3d a = axis(m, 0), b = axis(m, 1), c = axis(m, 2);
    const Vec3d cof[3] = {cross(b, c), cross(c, a), cross(a, b)};
    double largest = 0;
    for (const Vec3d& v : cof)
        for (const double e : {v.x, v.y, v.z}) largest = (e < 0 ? -e : e) > largest ? (e < 0 ? -e : e) : largest;
    if (!(largest > 0.0) || !(largest < 1e300)) return {};
    const double scale = (dot(a, cof[0]) < 0 ? -1.0 : 1.0) / largest;
    NormalMatrix n;
    for (int j = 0; j < 3; ++j)
        n.c[j] = {static_cast<float>(cof[j].x * scale), static_cast<float>(cof[j].y * scale), static_cast<float>(cof[j].z * scale)};
    return n;
}

}  // namespace halflit
