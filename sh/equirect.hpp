// Equirectangular (latitude-longitude) images of an environment, and the directions of their pixels.
//
// v = 0 is straight up (+y), v = 1 straight down; u = 0.5, the middle column, looks along -z; u = 0.75 along +x:
//     theta = pi v,  phi = 2 pi (u - 1/2),  direction = (sin theta sin phi, cos theta, -sin theta cos phi).
// A pixel is a patch of constant radiance, not a point sample: every integral in this folder is exact for that function.
#pragma once

#include "halflit/math.hpp"
#include "sh/arc.hpp"
#include "sh/trig.hpp"

#include <cstddef>
#include <span>

namespace halflit::sh {

/// Linear rgb, three floats a pixel, row 0 on top. Values must be finite.
struct EquirectView {
    int width = 0, height = 0;
    std::span<const float> rgb;

    [[nodiscard]] Vec3d at(int x, int y) const {
        const std::size_t i = (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 3;
        return {rgb[i], rgb[i + 1], rgb[i + 2]};
    }
};

[[nodiscard]] inline Vec3d equirect_direction(double u, double v) {
    const SinCos theta = sin_cos(kPi * v), phi = sin_cos(2.0 * kPi * (u - 0.5));
    return {theta.sin * phi.sin, theta.cos, -theta.sin * phi.cos};
}

struct EquirectPoint {
    double u, v;  ///< in [0, 1]
};

/// Inverse of equirect_direction(), for directions of any length.
[[nodiscard]] inline EquirectPoint equirect_point(Vec3d d) {
    return {0.5 + angle_of(d.x, -d.z) / (2.0 * kPi), angle_of(__builtin_sqrt(d.x * d.x + d.z * d.z), d.y) / kPi};
}

/// Solid angle of one pixel of a row: 2 pi/width (cos theta_0 - cos theta_1), written as a product that does not cancel.
[[nodiscard]] inline double pixel_solid_angle(int width, int height, int row) {
    const double half = 0.5 * kPi / height, middle = kPi * (row + 0.5) / height;
    return 2.0 * kPi / width * (2.0 * sin_cos(middle).sin * sin_cos(half).sin);
}

/// Relative luminance of linear rgb with sRGB's primaries (ITU-R BT.709).
[[nodiscard]] inline double luminance(Vec3d rgb) { return (0.2126 * rgb.x + 0.7152 * rgb.y) + 0.0722 * rgb.z; }

}  // namespace halflit::sh
