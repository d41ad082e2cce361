// Environments: images of the light from all directions, and a built-in sky. Directions: sh/equirect.hpp.
#pragma once

#include "sh/equirect.hpp"
#include "shading/result.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace halflit::io {

/// An equirectangular image of linear rgb radiance, finite and not negative.
struct EnvironmentImage {
    int width = 0, height = 0;
    std::vector<float> rgb;  ///< three floats per pixel, row 0 on top

    [[nodiscard]] sh::EquirectView view() const { return {width, height, rgb}; }
};

struct EnvironmentLimits {
    int max_width = 16384, max_height = 8192;
    std::size_t max_file_bytes = std::size_t{1} << 30;
};

/// A Radiance file (.hdr). Any aspect is accepted: the picture always covers the whole sphere. Values above 1e30 are clamped to it.
[[nodiscard]] Result<EnvironmentImage> read_environment(const std::string& path, const EnvironmentLimits& limits = {});

/// A clear day, 512 x 256: blue towards the zenith, pale at the horizon, ground of albedo 0.2 and a sun of 1.5 degrees radius, 40 degrees
/// high, to the right of and behind a camera that looks along -z. A white Lambert surface that faces the sun gets about 1 from the sun, and
/// one that faces up gets about 0.4 from the sky. Computed by + - * / and sqrt alone: the same bits on every machine.
[[nodiscard]] EnvironmentImage built_in_sky();

/// "sky" is the built-in one; anything else is a file.
[[nodiscard]] Result<EnvironmentImage> environment_by_name(const std::string& name, const EnvironmentLimits& limits = {});

}  // namespace halflit::io
