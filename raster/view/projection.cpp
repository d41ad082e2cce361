#include "raster/view/projection.hpp"

#include "raster/detail/view_math.hpp"

namespace halflit::raster {

namespace {

/// Half extents of the view: tangents for a perspective camera, lengths for an orthographic one.
struct HalfView {
    double x, y;
};

/// Extents that the picture shows: one is as asked, the other as asked or larger.
HalfView widen_to(HalfView asked, double aspect) {
    if (asked.x < asked.y * aspect) return {asked.y * aspect, asked.y};
    return {asked.x, asked.x / aspect};
}

HalfView half_view(const Camera& camera, double aspect) {
    HalfView asked{};
    if (camera.orthographic) {
        asked.x = finite(camera.half_width) ? magnitude(camera.half_width) : 0.0;
        asked.y = finite(camera.half_height) ? magnitude(camera.half_height) : 0.0;
        if (asked.y == 0.0) asked.y = asked.x == 0.0 ? 1.0 : asked.x / aspect;
        if (asked.x == 0.0) asked.x = asked.y * aspect;
    } else {
        asked.y = half_angle_tangent(usable_fov(camera.fov_y_rad));
        asked.x = asked.y * (camera.aspect > 0.0f && finite(camera.aspect) ? usable_aspect(camera.aspect) : aspect);
    }
    return widen_to(asked, aspect);
}

/// The sides as the middle of the picture, right and up of the axis, and half the extents.
struct SeenSides {
    double middle_x = 0, middle_y = 0;
    HalfView half;
};
SeenSides seen_sides(const Camera& camera, double aspect) {
    if (!camera.sides) return {0, 0, half_view(camera, aspect)};
    const auto span = [](double low, double high, double& middle) {
        middle = 0.5 * (low + high);
        return larger(0.5 * (high - low), 1e-30);
    };
    const ViewSides& s = *camera.sides;
    SeenSides out;
    out.half.x = span(s.left, s.right, out.middle_x);
    out.half.y = span(s.bottom, s.top, out.middle_y);
    return out;
}

DepthMap perspective_depth(const Camera& camera) {
    const bool has_far = finite(camera.far_z) && camera.far_z > 0.0f;
    double near_z = camera.near_z;
    if (!finite(camera.near_z) || !(camera.near_z > 0.0f)) near_z = has_far ? clamped(camera.far_z * 1e-3, 1e-6, 0.1) : 0.1;
    const double far_z = camera.far_z;
    if (!has_far || !(far_z > near_z)) return {0.0, near_z, false};
    return {near_z / (far_z - near_z), near_z * far_z / (far_z - near_z), false};
}

DepthMap orthographic_depth(const Camera& camera, HalfView half) {
    const double near_z = finite(camera.near_z) ? camera.near_z : 0.0;
    double far_z = camera.far_z;
    // Without a usable far limit: 1000 half heights, or |near_z| if that is more, so that rounding does not lose the depth.
    if (!finite(camera.far_z) || !(far_z > near_z)) far_z = near_z + 1000.0 * larger(half.y, 1e-3 * magnitude(near_z));
    return {1.0 / (far_z - near_z), far_z / (far_z - near_z), true};
}

}  // namespace

DepthMap depth_map(const Camera& camera, float picture_aspect) {
    if (!camera.orthographic) return perspective_depth(camera);
    return orthographic_depth(camera, seen_sides(camera, usable_aspect(picture_aspect)).half);
}

double half_extent(const Camera& camera, float picture_aspect) {
    const double aspect = usable_aspect(picture_aspect);
    const HalfView half = seen_sides(camera, aspect).half;
    return larger(half.y, half.x / aspect);
}

Mat4 clip_from_world(const Camera& camera, float picture_aspect) {
    const SeenSides seen = seen_sides(camera, usable_aspect(picture_aspect));
    const HalfView half = seen.half;
    const DepthMap depth = depth_map(camera, picture_aspect);

    // Projection times the inverse of the rigid world_from_camera, in double and rounded once.
    const Mat4& m = camera.world_from_camera;
    const Vec3d axis[3] = {{m.c[0].x, m.c[0].y, m.c[0].z}, {m.c[1].x, m.c[1].y, m.c[1].z}, {m.c[2].x, m.c[2].y, m.c[2].z}};
    const Vec3d eye{m.c[3].x, m.c[3].y, m.c[3].z};
    const auto clip_column = [&](double x_vs, double y_vs, double z_vs, double one) {
        const double w = camera.orthographic ? one : -z_vs;
        if (camera.sides) x_vs -= seen.middle_x * w, y_vs -= seen.middle_y * w;
        return Vec4f{static_cast<float>(x_vs / half.x), static_cast<float>(y_vs / half.y),
                     static_cast<float>(depth.z_scale * z_vs + depth.z_offset * one), static_cast<float>(w)};
    };
    return {{clip_column(axis[0].x, axis[1].x, axis[2].x, 0.0), clip_column(axis[0].y, axis[1].y, axis[2].y, 0.0),
             clip_column(axis[0].z, axis[1].z, axis[2].z, 0.0),
             clip_column(-dot(axis[0], eye), -dot(axis[1], eye), -dot(axis[2], eye), 1.0)}};
}

ViewRays view_rays(const Camera& camera, float picture_aspect) {
    const Mat4& m = camera.world_from_camera;
    const auto axis = [&](int i) { return Vec3d{m.c[i].x, m.c[i].y, m.c[i].z}; };
    if (camera.orthographic) return {axis(2) * -1.0, {}, {}};
    const SeenSides seen = seen_sides(camera, usable_aspect(picture_aspect));
    const Vec3d right = axis(0) * seen.half.x, up = axis(1) * seen.half.y;
    if (!camera.sides) return {axis(2) * -1.0, right, up};
    return {(axis(0) * seen.middle_x + axis(1) * seen.middle_y) - axis(2), right, up};
}

}  // namespace halflit::raster
