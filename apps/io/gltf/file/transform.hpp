// Affine transforms in double, for chains of nodes: rounded to float once, at the end.
#pragma once

#include "halflit/gltf.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"

#include <cstddef>

namespace halflit::io::detail {

/// Columns: the images of x, y and z, then that of the origin.
struct Affine {
    Vec3d c[4]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
};

inline Vec3d transform_direction(const Affine& m, Vec3d v) { return (m.c[0] * v.x + m.c[1] * v.y) + m.c[2] * v.z; }

/// The transform that applies b, then a.
inline Affine operator*(const Affine& a, const Affine& b) {
    return {{transform_direction(a, b.c[0]), transform_direction(a, b.c[1]), transform_direction(a, b.c[2]),
             transform_direction(a, b.c[3]) + a.c[3]}};
}

inline bool is_finite(const Affine& m) {
    for (const Vec3d& c : m.c)
        for (const double e : {c.x, c.y, c.z})
            if (!(e > -3e38 && e < 3e38)) return false;  // within float's range
    return true;
}

inline Mat4 to_mat4(const Affine& m) {
    Mat4 out;
    for (std::size_t j = 0; j < 4; ++j) {
        const Vec3f c = to_float(m.c[j]);
        out.c[j] = {c.x, c.y, c.z, j == 3 ? 1.0f : 0.0f};
    }
    return out;
}

inline NodeTransform to_node_transform(const Affine& m) {
    NodeTransform out;
    out.x = m.c[0], out.y = m.c[1], out.z = m.c[2], out.origin = m.c[3];
    return out;
}

inline Affine to_affine(const NodeTransform& m) { return {{m.x, m.y, m.z, m.origin}}; }

}  // namespace halflit::io::detail
