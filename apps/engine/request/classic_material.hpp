// Diffuse factor, specular factor and exponent of the classic lighting model ([CMSC]), which the flags choose for all materials.
#pragma once

#include "halflit/scene.hpp"

#include <optional>

namespace halflit::engine {

/// Largest exponent: a little below that of the least roughness, 8.3e4.
inline constexpr float kMaxShininess = 80000;

struct ClassicMaterial {
    std::optional<float> diffuse;   ///< kd in [0, 1], times the base colour
    std::optional<float> specular;  ///< ks in [0, 1]: F0
    std::optional<float> exponent;  ///< s of Blinn's (N.H)^s, in [0, kMaxShininess]; Phong's (R.V)^(s/4) has it too
    /// Something is given.
    [[nodiscard]] bool any() const { return diffuse || specular || exponent; }
};

/// Replaces what is given in all materials but unlit ones, and makes them non-metallic. Nothing given: changes nothing.
void replace_materials(Scene& scene, const ClassicMaterial& classic);

}  // namespace halflit::engine
