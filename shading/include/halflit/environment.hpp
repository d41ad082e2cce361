// Light from all around: an environment, ready to light a scene through any lobe with as few bands as the error allows.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/light.hpp"

#include <memory>
#include <span>
#include <vector>

namespace halflit {

/// An equirectangular (latitude-longitude) image of linear RGB radiance, finite and not negative. Any aspect covers the whole sphere.
/// Row 0 is straight up (+y); the middle column looks along -z, the column at three quarters of the width along +x.
struct EnvironmentImage {
    int width = 0, height = 0;  ///< pixels
    std::vector<float> rgb;     ///< three floats per pixel, row 0 on top
    bool calibrated = false;    ///< made for exposure 1; false: the scale of its unit is not known, as with most files
};

/// Decisions about an environment that are made once, when it is prepared.
struct EnvironmentOptions {
    bool extract_suns = true;  ///< make directional lights of suns where that lowers the bound on the error
    double rotate_rad = 0.0;   ///< about +y, counter-clockwise seen from above
    bool keep_image = false;   ///< keep the image, for Settings::background_environment
    bool keep_light = false;   ///< keep the pieces of the suns, for Accuracy::reference
    double time_limit_s = 0;   ///< wall clock; beyond it the call fails (limit). 0: no limit
};

/// An image in ten bands of spherical harmonics, its suns, and the data that bound the error of leaving bands out.
struct Environment;

/// Takes about 0.2 s for 1024 x 512 pixels, and works in the image's own memory: move an image that is no longer needed. Fails (bad_input)
/// for an image without pixels, of the wrong length, or with a value that is not finite or is negative, and (limit) for one of more than
/// 2^29 pixels. Thread-safe.
[[nodiscard]] HALFLIT_API Result<std::shared_ptr<const Environment>> make_environment(EnvironmentImage image,
                                                                                      const EnvironmentOptions& options = {});

/// The suns that were taken out of the image, as directional lights. They shine with the environment.
[[nodiscard]] HALFLIT_API std::span<const Light> environment_suns(const Environment& environment);

/// Luminance (Rec. 709) of the mean radiance over the sphere, suns included.
[[nodiscard]] HALFLIT_API double environment_level(const Environment& environment);

}  // namespace halflit
