// Suns: small bright sources taken out of an environment image and handed on as directional lights, whose lobe is evaluated exactly. What
// is left is smooth, so that few bands are enough for it and the series does not ring. A source is taken only where that lowers the bound
// on the error, its own part included; all energy is kept.
#pragma once

#include "sh/order.hpp"
#include "sh/project.hpp"

#include <vector>

namespace halflit::sh {

struct Sun {
    Vec3d direction;         ///< unit vector towards it
    Vec3d irradiance;        ///< on a surface that faces it; a light's colour is this divided by pi
    double solid_angle = 0;  ///< sr, of the pixels that it was taken from
    double spread_rad = 0;   ///< mean angle between its light and `direction`, from above
};

struct SunOptions {
    int max_suns = 4;
    double max_radius_rad = 0.07;  ///< 4 degrees: light farther than this from a source's middle is not its own
    double min_contrast = 16.0;    ///< times the mean luminance, for the brightest pixel
    double min_gain = 0.1;         ///< the part of the bound that has to go
};

struct SunExtraction {
    std::vector<Sun> suns;            ///< in the order found
    std::vector<float> residual_rgb;  ///< the image without them; empty when there are none
    Projection residual;              ///< of what is left, the whole image when there are none
};

/// `full` is the projection of `image`. Judged with Lambert's lobe at order 5.
[[nodiscard]] SunExtraction extract_suns(const EquirectView& image, const Projection& full, const SunOptions& options = {});

/// The error of treating the suns as directions, for a lobe of finite slope: the sum of E spread slope / pi.
[[nodiscard]] Vec3d sun_bound(const std::vector<Sun>& suns, const LobeSpectrum& lobe);

}  // namespace halflit::sh
