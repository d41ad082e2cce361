// The light of a picture, as a value.
#pragma once

#include "halflit/environment.hpp"
#include "halflit/export.hpp"
#include "halflit/light.hpp"

#include <memory>
#include <vector>

namespace halflit {

/// All that lights a scene. A scene has one of its own; auto_setup() returns one, and Renderer::render takes any.
struct Lighting {
    std::vector<Light> lights;                       ///< summed in this order, and after them the environment's suns
    Ambient ambient;                                 ///< light from all around, where there is no environment; black by default
    std::shared_ptr<const Environment> environment;  ///< replaces `ambient`; null: none
    bool suns = true;                                ///< the environment's suns shine
    float sun_shadow_radius_rad = 0.0f;              ///< Light::shadow_radius of the environment's suns that have none, for soft shadows
    /// The lights are made for exposure 1. False: they come from a file, in a unit whose scale is not known; auto_setup() chooses the
    /// exposure from them.
    bool calibrated = true;
    friend bool operator==(const Lighting&, const Lighting&) = default;

    /// The lights, and the environment's suns if they shine.
    [[nodiscard]] HALFLIT_API std::vector<Light> all_lights() const;
};

}  // namespace halflit
