// A photographer's studio: a dim room with a bright horizon, soft boxes, and a floor that returns some light. Directions in it are those of
// a viewer who looks along -z.
#include "halflit/scene.hpp"

#include "sh/arc.hpp"
#include "sh/equirect.hpp"
#include "sh/fp_environment.hpp"
#include "sh/smoothstep.hpp"
#include "sh/trig.hpp"

#include <algorithm>
#include <array>

namespace halflit {
namespace {

constexpr int kStudioRows = 64;

Vec3d mixed(Vec3d a, Vec3d b, double t) { return a + (b - a) * t; }

/// A rectangle of light far away, upright, with soft edges.
class SoftBox {
public:
    /// azimuth: 0 is behind the viewer, 90 to the viewer's right. Width and height: angles.
    SoftBox(double azimuth_deg, double elevation_deg, double width_deg, double height_deg, Vec3d radiance) : radiance_(radiance) {
        constexpr double kDegree = kPi / 180.0;
        const SinCos turn = sin_cos(azimuth_deg * kDegree), rise = sin_cos(elevation_deg * kDegree);
        towards_ = {turn.sin * rise.cos, rise.sin, turn.cos * rise.cos};
        right_ = {turn.cos, 0.0, -turn.sin};
        up_ = cross(towards_, right_);
        const auto reach = [](double angle_deg) {
            const SinCos half = sin_cos(0.5 * angle_deg * kDegree);
            return half.cos / half.sin;
        };
        per_width_ = reach(width_deg);
        per_height_ = reach(height_deg);
    }
    [[nodiscard]] Vec3d light(Vec3d d) const {
        constexpr double kEdge = 0.5;  // of the half width
        const double along = dot(d, towards_);
        if (!(along > 1e-3)) return {};
        const auto inside = [&](double across, double per_side) {
            return smoothstep((1.0 - (across < 0.0 ? -across : across) / along * per_side) / kEdge);
        };
        return radiance_ * (inside(dot(d, right_), per_width_) * inside(dot(d, up_), per_height_));
    }

private:
    Vec3d towards_, right_, up_, radiance_;
    double per_width_, per_height_;  ///< 1 / tan of half the angle
};

/// Walls, ceiling and floor.
Vec3d room(Vec3d d) {
    const Vec3d horizon{0.251, 0.256, 0.263}, wall{0.164, 0.171, 0.184}, ceiling{0.097, 0.103, 0.116};
    const Vec3d near_floor{0.193, 0.186, 0.176}, floor{0.097, 0.092, 0.087};
    const Vec3d above = mixed(mixed(horizon, wall, smoothstep(d.y / 0.35)), ceiling, smoothstep((d.y - 0.3) / 0.7));
    const Vec3d below = mixed(near_floor, floor, smoothstep(d.y / -0.8));
    // The room is darker behind the viewer: mirrors that face him get contrast.
    const double behind = smoothstep((d.z - 0.1) / 0.9) * smoothstep(0.5 + 3.0 * d.y);
    return mixed(below, above, smoothstep(0.5 + 10.0 * d.y)) * (1.0 - 0.45 * behind);
}

}  // namespace

EnvironmentImage studio_image() {
    const FpEnvironment environment_of_host;
    const std::array<SoftBox, 5> boxes{SoftBox{-50, 40, 54, 44, {2.2, 2.13, 2.0}},     // the main one, to the left above the viewer
                                       SoftBox{75, 22, 44, 80, {0.35, 0.37, 0.41}},    // a tall one fills the right side
                                       SoftBox{150, 38, 76, 34, {1.25, 1.29, 1.38}},   // behind the model: edges
                                       SoftBox{-125, 15, 30, 90, {1.04, 1.01, 0.98}},  // a strip behind it to the left
                                       SoftBox{0, 85, 70, 70, {0.66, 0.66, 0.66}}};    // overhead
    EnvironmentImage image{2 * kStudioRows, kStudioRows, {}, true};
    image.rgb.reserve(static_cast<std::size_t>(6) * kStudioRows * kStudioRows);
    for (int y = 0; y < kStudioRows; ++y)
        for (int x = 0; x < 2 * kStudioRows; ++x) {
            const Vec3d d = sh::equirect_direction((x + 0.5) / (2 * kStudioRows), (y + 0.5) / kStudioRows);
            Vec3d sum = room(d);
            for (const SoftBox& box : boxes) sum = sum + box.light(d);
            for (const double channel : {sum.x, sum.y, sum.z}) image.rgb.push_back(static_cast<float>(channel));
        }
    return image;
}

}  // namespace halflit
