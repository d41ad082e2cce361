// Environment images for tests, and the light that a surface reflects under them, by brute force.
#pragma once

#include "sh/coefficients.hpp"
#include "sh/equirect.hpp"
#include "sh/lobe_error.hpp"
#include "sh/quadrature.hpp"
#include "tests/support/random.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace halflit::test {

struct Sky {
    int width = 0, height = 0;
    std::vector<float> rgb;
    [[nodiscard]] sh::EquirectView view() const { return {width, height, rgb}; }
};

/// fn(direction of the pixel's middle) -> Vec3d.
template <class Fn>
Sky painted_sky(int width, int height, Fn&& fn) {
    Sky sky{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec3d v = fn(sh::equirect_direction((x + 0.5) / width, (y + 0.5) / height));
            for (const double c : {v.x, v.y, v.z}) sky.rgb.push_back(static_cast<float>(c));
        }
    return sky;
}

/// Smooth noise and one small sun, different in every channel.
inline Sky random_sky(int width, int height, std::uint64_t seed) {
    Random random(seed);
    const Vec3d a{random.real(-3, 3), random.real(-3, 3), random.real(-3, 3)},
        b{random.real(-9, 9), random.real(-9, 9), random.real(-9, 9)};
    Sky sky = painted_sky(width, height, [&](Vec3d d) {
        return Vec3d{1.2 + std::sin(dot(a, d)), 1.1 + std::cos(dot(b, d)), 1.5 + std::sin(dot(a, d)) * std::cos(3 * dot(b, d))};
    });
    for (std::size_t i = 0; i < 3; ++i) sky.rgb[3 * static_cast<std::size_t>(random.index(width * height)) + i] = 40.0f;
    return sky;
}

/// Mean over blocks of factor x factor pixels, each weighted with its solid angle, so that the integral over a block does not change.
inline Sky downsampled(const sh::EquirectView& image, int factor) {
    Sky out{image.width / factor, image.height / factor, {}};
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            Vec3d sum{};
            double weight = 0;
            for (int j = 0; j < factor; ++j)
                for (int i = 0; i < factor; ++i) {
                    const double w = sh::pixel_solid_angle(image.width, image.height, y * factor + j);
                    sum = sum + image.at(x * factor + i, y * factor + j) * w;
                    weight += w;
                }
            for (const double c : {sum.x, sum.y, sum.z}) out.rgb.push_back(static_cast<float>(c / weight));
        }
    return out;
}

/// Direction with the light that comes from there: radiance times solid angle.
struct LightSample {
    Vec3d direction, flux;
};

/// The image as samples: 2 x 2 Gauss points in each pixel, more where a pixel holds much of the light, up to 24 x 24.
inline std::vector<LightSample> light_samples(const sh::EquirectView& image) {
    double total = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) total += sh::luminance(image.at(x, y)) * sh::pixel_solid_angle(image.width, image.height, y);
    std::vector<LightSample> samples;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double share = sh::luminance(image.at(x, y)) * sh::pixel_solid_angle(image.width, image.height, y) / total;
            const int count = std::clamp(static_cast<int>(2 + 60 * std::sqrt(share)), 2, 24);
            const auto rule = sh::gauss_legendre(count);
            for (const sh::GaussNode& v : rule)
                for (const sh::GaussNode& u : rule) {
                    const double theta = (y + 0.5 + 0.5 * v.x) * kPi / image.height;
                    const double weight = 0.25 * u.weight * v.weight * (kPi / image.height) * (2 * kPi / image.width) * std::sin(theta);
                    samples.push_back({sh::equirect_direction((x + 0.5 + 0.5 * u.x) / image.width, (y + 0.5 + 0.5 * v.x) / image.height),
                                       image.at(x, y) * weight});
                }
        }
    return samples;
}

inline double quick_lobe_value(const sh::WrapLobe& lobe, double x) {
    const double t = (x + lobe.wrap) / (1 + lobe.wrap);
    if (!(t > 0)) return 0;
    if (lobe.power == 1) return lobe.scale * t;
    if (lobe.power == 2) return lobe.scale * t * t;
    if (lobe.power == 1.5) return lobe.scale * t * std::sqrt(t);
    return lobe.scale * std::pow(t, lobe.power);
}

/// (1/pi) times the integral over directions d of L(d) f(N.d), sample by sample. L: radiance, f: lobe, N: normal.
inline Vec3d reflected(const std::vector<LightSample>& samples, const sh::WrapLobe& lobe, Vec3d normal) {
    Vec3d sum{};
    for (const LightSample& s : samples) {
        const double f = quick_lobe_value(lobe, dot(normal, s.direction));
        if (f != 0) sum = sum + s.flux * f;
    }
    return sum * (1.0 / kPi);
}

inline std::vector<Vec3d> random_normals(int count, std::uint64_t seed) {
    Random random(seed);
    std::vector<Vec3d> normals;
    while (static_cast<int>(normals.size()) < count) {
        const Vec3d v{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
        const double size = length(v);
        if (size > 0.1 && size < 1) normals.push_back(v * (1.0 / size));
    }
    return normals;
}

inline double largest_difference(Vec3d a, Vec3d b) {
    const Vec3d d = a - b;
    return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
}

/// Expansion of fn(direction) -> Vec3d, bands in 1..10, by a quadrature of the given degree: exact if fn is a polynomial of degree up to
/// `degree` - `bands` + 1, and close if it is smooth.
template <class Fn>
sh::RadianceSh project_function(int bands, int degree, Fn&& fn) {
    sh::RadianceSh out{bands, {}};
    for (const sh::SphereNode& node : sh::sphere_quadrature(degree)) {
        double y[sh::kMaxCoefficients];
        sh::evaluate_basis<sh::kMaxBands>(node.direction, y);
        const Vec3d value = fn(node.direction) * node.weight;
        for (int i = 0; i < sh::coefficient_count(bands); ++i)
            out.c[static_cast<std::size_t>(i)] = out.c[static_cast<std::size_t>(i)] + value * y[i];
    }
    return out;
}

}  // namespace halflit::test
