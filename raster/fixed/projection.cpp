#include "raster/fixed/projection.hpp"

#include "sh/vec3d.hpp"

namespace halflit::raster {
namespace {

Vec3d unit(Vec3d v) {
    const double length = __builtin_sqrt(dot(v, v));
    return length > 0.0 ? v * (1.0 / length) : Vec3d{0, 0, 1};
}
Vec4f column(double x, double y, double z, double w) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(w)};
}

}  // namespace

Mat4 view_from_world(Vec3f position, Vec3f forward, Vec3f up) {
    const Vec3d f = unit(to_double(forward)), s = unit(cross(f, to_double(up))), u = unit(cross(s, f)), at = to_double(position);
    Mat4 m;
    m.c[0] = column(s.x, u.x, -f.x, 0);
    m.c[1] = column(s.y, u.y, -f.y, 0);
    m.c[2] = column(s.z, u.z, -f.z, 0);
    m.c[3] = column(-dot(s, at), -dot(u, at), dot(f, at), 1);
    return m;
}

Mat4 clip_from_view(const Frustum& of) {
    const double width = of.right - of.left, height = of.top - of.bottom, depth = of.far_z - of.near_z;
    Mat4 m;
    if (of.parallel) {
        m.c[0] = column(2 / width, 0, 0, 0);
        m.c[1] = column(0, 2 / height, 0, 0);
        m.c[2] = column(0, 0, 1 / depth, 0);
        m.c[3] = column(-(of.right + of.left) / width, -(of.top + of.bottom) / height, of.far_z / depth, 1);
        return m;
    }
    m.c[0] = column(2 * of.near_z / width, 0, 0, 0);
    m.c[1] = column(0, 2 * of.near_z / height, 0, 0);
    m.c[2] = column((of.right + of.left) / width, (of.top + of.bottom) / height, of.near_z / depth, -1);
    m.c[3] = column(0, 0, of.near_z * of.far_z / depth, 0);
    return m;
}

}  // namespace halflit::raster
