// A studio in daylight: large bright soft boxes in a grey room, and a light floor. Directions in it are those of a viewer who looks along
// -z.
#include "halflit/scene.hpp"

#include "sh/arc.hpp"
#include "sh/equirect.hpp"
#include "sh/fp_environment.hpp"
#include "sh/smoothstep.hpp"
#include "sh/trig.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

/// Walls, ceiling and floor. The right side is darker, so that faces of a box differ; a strip below the horizon and the side of the viewer
/// are, too, so that metals show their curvature.
Vec3d room(Vec3d d) {
    constexpr double kDarkerRight = 0.35, kDarkerBehind = 0.27, kBlend = 0.12, kStripHeight = -0.226, kStripReach = 0.236;
    const Vec3d horizon{0.40, 0.397, 0.39}, ceiling{0.154, 0.162, 0.174}, near_floor{0.735, 0.72, 0.695}, floor{0.435, 0.425, 0.41};
    const Vec3d strip{0.23, 0.227, 0.22};
    const Vec3d above = mixed(horizon, ceiling, smoothstep(d.y / 0.9)), below = mixed(near_floor, floor, smoothstep(d.y / -0.8));
    const double apart = d.y - kStripHeight, level = std::sqrt(std::max(0.0, 1.0 - d.y * d.y));
    const Vec3d light = mixed(below, above, smoothstep(0.5 + 0.5 * d.y / kBlend)) -
                        strip * (level * smoothstep(1.0 - (apart < 0.0 ? -apart : apart) / kStripReach));
    const double right = smoothstep(0.5 + 0.5 * d.x) * smoothstep((d.y + 0.6) / 0.8);
    const double behind = smoothstep((d.z - 0.1) / 0.9) * smoothstep(0.5 + 2.0 * d.y);
    return light * ((1.0 - kDarkerRight * right) * (1.0 - kDarkerBehind * behind));
}

}  // namespace

EnvironmentImage studio_image() {
    const FpEnvironment environment_of_host;
    const std::array<SoftBox, 4> boxes{SoftBox{-45, 51, 54, 44, {2.42, 2.38, 2.28}},  // the main one, to the left above the viewer
                                       SoftBox{78, 20, 36, 70, {1.36, 1.40, 1.47}},   // a tall one on the right side
                                       SoftBox{150, 38, 76, 34, {0.86, 0.88, 0.92}},  // behind the model: edges
                                       SoftBox{0, 86, 70, 70, {0.66, 0.66, 0.66}}};   // overhead
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
