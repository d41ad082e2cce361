// Suns: small bright sources that are taken out of an environment image and become directional lights, whose lobe is evaluated exactly. The
// rest of the image is smooth, so that few bands are enough for it and the series does not ring. A source is taken only where that lowers
// the bound on the error; its part of the bound (sun_bound) is included. All energy is kept.
#pragma once

#include "sh/order.hpp"
#include "sh/project.hpp"

#include <cstdint>
#include <vector>

namespace halflit::sh {

struct Sun {
    Vec3d direction;                   ///< unit vector towards it
    Vec3d irradiance;                  ///< on a surface that faces it; a light's colour is this divided by pi
    double solid_angle = 0;            ///< sr, of the pixels that it was taken from
    double spread_rad = 0;             ///< upper bound on the mean angle between its light and `direction`
    std::vector<std::int32_t> pixels;  ///< that it was taken from, y times the width plus x; no pixel belongs to two suns
    std::vector<Vec3f> before;         ///< radiance of each of them in the image
};

struct SunOptions {
    int max_suns = 4;
    double max_radius_rad = 0.07;  ///< 4 degrees; light farther than this from a source's middle is not part of it
    double min_contrast = 16.0;    ///< least luminance of the brightest pixel, as a multiple of the mean luminance
    double min_gain = 0.1;         ///< least share of the bound that taking a source must remove
};

struct SunExtraction {
    std::vector<Sun> suns;            ///< in the order found
    std::vector<float> residual_rgb;  ///< the image without the suns
    Projection residual;              ///< projection of the image without the suns
};

/// Takes the suns out of an image of `width` x `height` pixels, three floats each; `full` is its projection. Works in the image's memory,
/// and takes one bit per pixel besides. Bounds are those of Lambert's lobe at order 5.
[[nodiscard]] SunExtraction extract_suns(int width, int height, std::vector<float> rgb, const Projection& full,
                                         const SunOptions& options = {});

/// The same for a copy of the image.
[[nodiscard]] inline SunExtraction extract_suns(const EquirectView& image, const Projection& full, const SunOptions& options = {}) {
    return extract_suns(image.width, image.height, {image.rgb.begin(), image.rgb.end()}, full, options);
}

/// Bound on the error of treating each sun as one direction, for a lobe of finite slope: the sum of E spread slope / pi, E the irradiance.
[[nodiscard]] Vec3d sun_bound(const std::vector<Sun>& suns, const LobeSpectrum& lobe);

}  // namespace halflit::sh
