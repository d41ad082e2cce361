// Light from all around: an environment as shading takes it, ready to be convolved with any lobe at the order that the error asks for.
#pragma once

#include "sh/coefficients.hpp"
#include "sh/order.hpp"
#include "sh/project.hpp"
#include "sh/rotate.hpp"
#include "shading/light.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace halflit::shading {

/// An environment image in ten bands, with what bounds the error of leaving bands out. Suns that were taken out of it are lights of
/// their own: whoever lights a scene with this adds them to the scene's lights.
struct Environment {
    /// Given by make_environment, never twice; copies share it. What renderers keep of an environment goes by it, so make another one
    /// instead of editing this.
    std::uint64_t id = 0;
    sh::RadianceSh radiance;  ///< turned as the scene wants it
    sh::BandGrid grid;
    std::vector<Light> suns;  ///< directional, colour premultiplied by 1/pi
    /// The image itself, suns and all, as it came, and how it is to be turned: what is seen behind a scene. Empty unless kept.
    std::vector<float> rgb;
    int width = 0, height = 0;
    double rotate_rad = 0.0;
    /// What the bands stand for: the image without the suns. Empty unless kept.
    std::vector<float> lit_rgb;
    int lit_width = 0, lit_height = 0;
};

struct EnvironmentOptions {
    bool extract_suns = true;  ///< where that lowers the bound
    double rotate_rad = 0.0;   ///< about +y, counterclockwise seen from above
    bool keep_image = false;   ///< for a background
    bool keep_light = false;   ///< for Accuracy::reference
};

/// What a rough surface mirrors: a cosine power about the mirrored view, with a quarter of the highlight's exponent, because
/// the mirrored direction turns twice as fast as the half vector. Normalised.
[[nodiscard]] sh::WrapLobe specular_environment_lobe(float roughness);

/// An environment that the caller keeps alive.
[[nodiscard]] inline std::shared_ptr<const Environment> borrowed(const Environment& environment) {
    return {std::shared_ptr<void>(), &environment};
}

[[nodiscard]] Environment make_environment(const sh::EquirectView& image, const EnvironmentOptions& options = {});

}  // namespace halflit::shading
