// The built-in sky, computed.
#include "halflit/image.hpp"

#include "sh/equirect.hpp"
#include "sh/fp_environment.hpp"
#include "sh/smoothstep.hpp"
#include "sh/trig.hpp"

namespace halflit {
namespace {

constexpr int kSkyWidth = 512, kSkyHeight = 256;
constexpr int kSamples = 8;  ///< per side of each pixel on or near the sun

Vec3d mix(Vec3d a, Vec3d b, double t) { return a * (1.0 - t) + b * t; }

struct Sun {
    Vec3d direction;
    double cos_radius, cos_outside;  ///< cosines of the radii of the disc, and of the region whose pixels are sampled
    Vec3d radiance;
};

Sun make_sun() {
    const SinCos height = sin_cos(40.0 * kPi / 180.0), side = sin_cos(35.0 * kPi / 180.0);
    const double cos_radius = sin_cos(1.5 * kPi / 180.0).cos;
    // Irradiance pi c for the colour c: radiance pi c / (pi sin^2 r) over a disc of angular radius r.
    const double radiance = 1.0 / (1.0 - cos_radius * cos_radius);
    return {{height.cos * side.sin, height.sin, height.cos * side.cos},
            cos_radius,
            sin_cos(2.5 * kPi / 180.0).cos,
            Vec3d{1.0, 0.92, 0.78} * radiance};
}

/// Radiance from direction d without the sun's disc.
Vec3d background(Vec3d d, const Sun& sun) {
    const Vec3d zenith{0.14, 0.29, 0.62}, horizon{0.56, 0.66, 0.78}, haze{0.62, 0.62, 0.6}, ground{0.19, 0.17, 0.15};
    const double up = d.y < 0 ? 0 : d.y;
    const double rise = 1.0 - (1.0 - up) * (1.0 - up) * (1.0 - up);
    const double near_sun = 0.5 * (1.0 + dot(d, sun.direction)), near2 = near_sun * near_sun, near8 = (near2 * near2) * (near2 * near2);
    const Vec3d glow = Vec3d{0.5, 0.42, 0.3} * (near8 * near8);
    const Vec3d sky = mix(horizon, zenith, rise) + glow;
    const Vec3d below = mix(haze * 0.5, ground, smoothstep(-4.0 * d.y));
    return mix(below, sky, smoothstep(0.5 + 25.0 * d.y));
}

/// Mean radiance of a pixel. Only pixels on or near the sun take several samples.
Vec3d sky_pixel(int x, int y, const Sun& sun) {
    const Vec3d middle = sh::equirect_direction((x + 0.5) / kSkyWidth, (y + 0.5) / kSkyHeight);
    const Vec3d color = background(middle, sun);
    if (dot(middle, sun.direction) < sun.cos_outside) return color;
    int inside = 0;
    for (int j = 0; j < kSamples; ++j)
        for (int i = 0; i < kSamples; ++i) {
            const Vec3d d = sh::equirect_direction((x + (i + 0.5) / kSamples) / kSkyWidth, (y + (j + 0.5) / kSamples) / kSkyHeight);
            inside += dot(d, sun.direction) > sun.cos_radius ? 1 : 0;
        }
    return color + sun.radiance * (static_cast<double>(inside) / (kSamples * kSamples));
}

}  // namespace

EnvironmentImage built_in_sky() {
    const FpEnvironment environment_of_host;
    EnvironmentImage sky{kSkyWidth, kSkyHeight, {}, true};
    sky.rgb.reserve(static_cast<std::size_t>(kSkyWidth) * kSkyHeight * 3);
    const Sun sun = make_sun();
    for (int y = 0; y < kSkyHeight; ++y)
        for (int x = 0; x < kSkyWidth; ++x) {
            const Vec3d color = sky_pixel(x, y, sun);
            for (const double component : {color.x, color.y, color.z}) sky.rgb.push_back(static_cast<float>(component));
        }
    return sky;
}

}  // namespace halflit
