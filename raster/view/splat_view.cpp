#include "raster/view/splat_view.hpp"

#include "raster/view/projection.hpp"
#include "sh/mat4.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::raster {
namespace {

constexpr double kMostSlope = 1.3;  // of the projection, in sides of the picture
constexpr double kNearest = 0.2;    // less where all is smaller than that

struct Growth {
    double variance;    ///< added in the picture, square pixels
    double least_area;  ///< SplatView::least_area
};
constexpr Growth kGrowths[] = {{0.3, 2.0}, {0.3, 2.5e-5}, {0.0, 2.0}, {0.1, 0.0}};  // inria, inria_aa, khr, mip

}  // namespace

SplatEye::SplatEye(const Camera& camera, const Mat4& clip_from_world, int width, int height, const Bounds& scene)
    : nearest_(std::min(kNearest, 0.1 * static_cast<double>(scene.radius()))), orthographic_(camera.orthographic) {
    const auto axis = [](Vec4f v, double sign) { return Vec3d{sign * v.x, sign * v.y, sign * v.z}; };
    const Mat4& m = camera.world_from_camera;
    const Vec3d right = axis(m.c[0], 1), down = axis(m.c[1], -1), ahead = axis(m.c[2], -1);
    axes_[0] = right, axes_[1] = down, axes_[2] = ahead, place_ = axis(m.c[3], 1);
    if (orthographic_) {
        const auto row = [&](float Vec4f::*of) {
            return Vec3d{clip_from_world.c[0].*of, clip_from_world.c[1].*of, clip_from_world.c[2].*of};
        };
        const Vec3d row_x = row(&Vec4f::x), row_y = row(&Vec4f::y);
        focal_[0] = 0.5 * width * dot(row_x, right), focal_[1] = -0.5 * height * dot(row_y, down);
        middle_[0] = 0.5 * width * (1.0 + dot(row_x, place_) + static_cast<double>(clip_from_world.c[3].x));
        middle_[1] = 0.5 * height * (1.0 - dot(row_y, place_) - static_cast<double>(clip_from_world.c[3].y));
        least_slope_[0] = least_slope_[1] = most_slope_[0] = most_slope_[1] = 0.0;
        return;
    }
    // The view rays say how the picture lies about the axis.
    const ViewRays rays = view_rays(camera, static_cast<float>(width) / static_cast<float>(height));
    const double forward = dot(rays.middle, ahead), sides[2] = {dot(rays.right, right) / forward, -dot(rays.up, down) / forward},
                 offsets[2] = {dot(rays.middle, right) / forward, dot(rays.middle, down) / forward};
    const double half_size[2] = {0.5 * width, 0.5 * height};
    for (int k = 0; k < 2; ++k) {
        focal_[k] = half_size[k] / sides[k];
        middle_[k] = half_size[k] - focal_[k] * offsets[k];
        least_slope_[k] = offsets[k] - kMostSlope * sides[k], most_slope_[k] = offsets[k] + kMostSlope * sides[k];
    }
}

SplatView SplatEye::view_of(const Mat4& world_from_object, SplatReference reference, const Region& part) const {
    const auto column = [&](int c) {
        const Vec4f v = world_from_object.c[c];
        return Vec3d{v.x, v.y, v.z};
    };
    const Vec3d columns[3] = {column(0), column(1), column(2)}, origin = column(3) - place_;
    SplatView view{};
    view.orthographic = orthographic_;
    view.nearest = nearest_;
    view.x0 = part.x, view.x1 = part.x + part.width, view.y0 = part.y, view.y1 = part.y + part.height;
    view.by_distance = reference == SplatReference::khr && !orthographic_;
    const Growth& growth = kGrowths[static_cast<std::size_t>(reference)];
    view.variance = growth.variance, view.least_area = growth.least_area;
    for (int k = 0; k < 2; ++k) {
        view.focal[k] = focal_[k], view.middle[k] = middle_[k];
        view.least_slope[k] = least_slope_[k], view.most_slope[k] = most_slope_[k];
    }
    const double in_world[3] = {origin.x, origin.y, origin.z};
    for (int r = 0; r < 3; ++r) {
        view.origin[r] = dot(axes_[r], origin), view.world_origin[r] = in_world[r];
        for (int c = 0; c < 3; ++c) {
            view.axes[r][c] = dot(axes_[r], columns[c]);
            view.world[r][c] = r == 0 ? columns[c].x : r == 1 ? columns[c].y : columns[c].z;
        }
    }
    // The object's axes as turned.
    Vec3d turned[3];
    for (int r = 0; r < 3; ++r) {
        Vec3d axis = columns[r];
        for (int k = 0; k < r; ++k) axis = axis - turned[k] * dot(axis, turned[k]);
        const double length = std::sqrt(dot(axis, axis));
        turned[r] = length > 0.0 ? axis * (1.0 / length) : Vec3d{};
        view.turn_origin[r] = dot(turned[r], orthographic_ ? axes_[2] : origin);
        for (int c = 0; c < 3; ++c) view.turn[r][c] = orthographic_ ? 0.0 : dot(turned[r], columns[c]);
    }
    return view;
}

SplatBatch splat_batch(const Mesh& mesh, std::size_t first, std::uint32_t number) {
    const Splats& s = *mesh.splats;
    const auto coefficients = harmonics_per_splat(s.degree);
    return {&mesh.positions[first].x,
            &s.rotations[first].x,
            &s.scales[first].x,
            &s.opacities[first],
            &s.harmonics[coefficients * first],
            static_cast<int>(std::min(kSplatsAtOnce, s.opacities.size() - first)),
            s.degree,
            number};
}

}  // namespace halflit::raster
