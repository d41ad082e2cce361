// Light from all around: an environment as shading uses it, ready to be convolved with any lobe at the order that the error requires.
#pragma once

#include "halflit/environment.hpp"
#include "sh/coefficients.hpp"
#include "sh/project.hpp"
#include "sh/rotate.hpp"
#include "shading/image_light.hpp"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace halflit {

/// A piece of a sun: the direction to it, and its radiance times solid angle over pi.
struct SunPatch {
    Vec3d direction, light;
};

/// A sun's light, which a directional light replaces. Everything is over pi and channel by channel; d is the direction to a piece of the
/// sun, D that of the light, and means are weighted by the pieces' light.
struct SunShape {
    Vec3d light;                    ///< in the image
    Vec3d mean_square;              ///< of |d - D|
    Vec3d drift;                    ///< |mean of d - D|
    std::vector<SunPatch> patches;  ///< for the reference; empty unless the light was kept
};

/// An environment image in ten bands, and the data that bound the error of leaving bands out. Suns taken out of the image are separate
/// lights: the caller adds them to the scene's lights.
struct Environment {
    /// Set by make_environment(), different for each environment, shared by copies. Renderers keep data of an environment under its id, so
    /// make a new environment instead of editing this one.
    std::uint64_t id = 0;
    sh::RadianceSh radiance;  ///< turned by rotate_rad
    /// Light of the image without the suns and before any rotation; null: darkness.
    std::shared_ptr<const shading::ImageLight> light;
    bool calibrated = false;           ///< as in EnvironmentImage
    std::vector<Light> suns;           ///< directional, colour premultiplied by 1/pi
    std::vector<SunShape> sun_shapes;  ///< of each of them
    /// The original image with the suns, before any rotation, for the background of pictures; rotate_rad turns it. Empty unless kept.
    std::vector<float> rgb;
    int width = 0, height = 0;
    double rotate_rad = 0.0;
    float studio_level = 0.0f;  ///< of the built-in studio; 0: it is another environment
    bool kept_light = false;    ///< EnvironmentOptions::keep_light: the suns have their patches
};

}  // namespace halflit

namespace halflit::shading {

/// A pointer to an environment that the caller keeps alive.
[[nodiscard]] inline std::shared_ptr<const Environment> borrowed(const Environment& environment) {
    return {std::shared_ptr<void>(), &environment};
}

/// The environment that something kept was made of. Its address does not tell it from others: another one may come to lie there.
class EnvironmentSlot {
public:
    /// Returns true if the environment is another one than before.
    bool replace(std::shared_ptr<const Environment> environment) {
        const std::uint64_t id = environment != nullptr ? environment->id : 0;
        const bool other = environment != environment_ || id != id_;
        environment_ = std::move(environment);
        id_ = id;
        return other;
    }
    [[nodiscard]] const Environment& operator*() const { return *environment_; }

private:
    std::shared_ptr<const Environment> environment_;
    std::uint64_t id_ = 0;
};

[[nodiscard]] inline sh::EquirectView view_of(const EnvironmentImage& image) { return {image.width, image.height, image.rgb}; }

/// An environment without suns, of a light that is there already.
[[nodiscard]] Environment make_environment(std::shared_ptr<const ImageLight> light, double rotate_rad);

/// The same as halflit::make_environment, for images that are known to be valid.
[[nodiscard]] Environment environment_of(EnvironmentImage image, const EnvironmentOptions& options = {});

/// The same for a copy of an image.
[[nodiscard]] inline Environment make_environment(const sh::EquirectView& image, const EnvironmentOptions& options = {}) {
    return environment_of({image.width, image.height, {image.rgb.begin(), image.rgb.end()}, false}, options);
}

}  // namespace halflit::shading
