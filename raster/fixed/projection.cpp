#include "raster/fixed/projection.hpp"

namespace halflit::raster {
namespace {

Vec3d in_double(Vec3f v) { return {v.x, v.y, v.z}; }
Vec3d unit(Vec3d v) {
    const double length = __builtin_sqrt(dot(v, v));
    return length > 0.0 ? v * (1.0 / length) : Vec3d{0, 0, 1};
}
Vec4f column(double x, double y, double z, double w) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(w)};
}

}  // namespace

Mat4 view_from_world(Vec3f position, Vec3f forward, Vec3f up) {
    const Vec3d f = unit(in_double(forward)), s = unit(cross(f, in_double(up))), u = unit(cross(s, f)), at = in_double(position);
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

View window_view(const Mat4& clip_from_world, int width, int height) {
    View view;
    view.clip_from_world = clip_from_world;
    view.viewport.half_width = static_cast<float>(width) * 0.5f;
    view.viewport.half_height = static_cast<float>(height) * 0.5f;
    view.viewport.guard_x = static_cast<float>(kGuardBandPx) / view.viewport.half_width;
    view.viewport.guard_y = static_cast<float>(kGuardBandPx) / view.viewport.half_height;
    view.tile_size = kMaxTileSize;
    set_region(view, {0, 0, width, height});
    return view;
}

}  // namespace halflit::raster
