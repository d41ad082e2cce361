#include "apps/viewer/orbit_camera.hpp"

#include "apps/engine/job/view_choice.hpp"
#include "sh/arc.hpp"
#include "sh/trig.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace halflit::viewer {
namespace {

// At the poles +y is along the view, and no direction in the picture would be up.
constexpr double kMostElevation = 89.0 / 180.0 * kPi;
constexpr double kZoomStep = 1.1;

Vec3d column(const Mat4& m, std::size_t i) { return {m.c[i].x, m.c[i].y, m.c[i].z}; }

}  // namespace

OrbitCamera::OrbitCamera(const Camera& start, const Bounds& bounds) : start_(start), bounds_(bounds) { reset(); }

void OrbitCamera::reset() {
    const Vec3d eye = column(start_.world_from_camera, 3), away = column(start_.world_from_camera, 2);
    const Vec3d center = bounds_.empty ? Vec3d{} : to_double(bounds_.center());
    radius_ = bounds_.empty || !(bounds_.radius() > 0.0f) ? 1.0 : static_cast<double>(bounds_.radius());
    azimuth_ = angle_of(away.x, away.z);
    elevation_ = std::clamp(angle_of(away.y, std::sqrt(away.x * away.x + away.z * away.z)), -kMostElevation, kMostElevation);
    // A camera inside the scene, or one that looks away from it, turns around a point close before it.
    distance_ = std::max(dot(eye - center, away), radius_ * 0.05);
    target_ = eye - away * distance_;
    half_height_ = static_cast<double>(start_.half_height);
    moved_ = false;
}

Vec3d OrbitCamera::back() const {
    const SinCos az = sin_cos(azimuth_), el = sin_cos(elevation_);
    return {az.sin * el.cos, el.sin, az.cos * el.cos};
}

void OrbitCamera::turn(double right_px, double down_px) {
    moved_ = true;
    azimuth_ = std::remainder(azimuth_ - right_px * (2.0 * kPi / kPixelsOfTurn), 2.0 * kPi);
    elevation_ = std::clamp(elevation_ + down_px * (2.0 * kPi / kPixelsOfTurn), -kMostElevation, kMostElevation);
}

void OrbitCamera::pan(double right_px, double down_px, int picture_height) {
    moved_ = true;
    const SinCos az = sin_cos(azimuth_), half = sin_cos(static_cast<double>(start_.fov_y_rad) / 2);
    const double half_view = start_.orthographic ? half_height_ : distance_ * half.sin / half.cos;
    const double unit = half_view / (std::max(picture_height, 1) / 2.0);
    const Vec3d right{az.cos, 0.0, -az.sin}, up = cross(back(), right);
    target_ = target_ - right * (right_px * unit) + up * (down_px * unit);
}

void OrbitCamera::zoom(double steps) {
    moved_ = true;
    const double factor = std::pow(kZoomStep, -steps);
    if (start_.orthographic)
        half_height_ = std::clamp(half_height_ * factor, radius_ * 1e-3, radius_ * 1e3);
    else
        distance_ = std::clamp(distance_ * factor, radius_ * 1e-3, radius_ * 1e3);
}

Camera OrbitCamera::camera() const {
    if (!moved_) return start_;
    constexpr float kDegrees = static_cast<float>(180.0 / kPi);
    Camera camera =
        engine::placed_camera(look_at(to_float(target_ + back() * distance_), to_float(target_)), start_.fov_y_rad * kDegrees, bounds_);
    camera.name = start_.name;
    camera.aspect = start_.aspect;
    if (start_.orthographic) {
        camera.orthographic = true;
        camera.half_height = static_cast<float>(half_height_);
        camera.half_width = start_.half_width * static_cast<float>(half_height_ / static_cast<double>(start_.half_height));
        // An orthographic view may begin behind its camera. All of the scene lies in it.
        const Vec3d center = bounds_.empty ? Vec3d{} : to_double(bounds_.center());
        const double middle = dot(target_ + back() * distance_ - center, back());
        camera.near_z = static_cast<float>(middle - 2.0 * radius_);
        camera.far_z = static_cast<float>(middle + 2.0 * radius_);
    }
    return camera;
}

std::string OrbitCamera::flags(double aspect, const Placement& placement) const {
    if (!moved_ || start_.orthographic) return "";
    const auto point = [&](Vec3d p) {
        const Vec3d at = placement.out(p);
        return fmt::format("{},{},{}", at.x, at.y, at.z);
    };
    // A camera made for a wider picture shows its width, and more above and below.
    const SinCos half = sin_cos(static_cast<double>(start_.fov_y_rad) / 2);
    const double wider = start_.aspect > 0.0f ? std::max(1.0, static_cast<double>(start_.aspect) / aspect) : 1.0;
    return fmt::format("--camera-position {} --camera-target {} --fov {}", point(target_ + back() * distance_), point(target_),
                       static_cast<float>(2.0 * arc_tangent(half.sin / half.cos * wider) * (180.0 / kPi)));
}

}  // namespace halflit::viewer
