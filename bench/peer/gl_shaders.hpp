// halflit's exact shading of a bench scene as GLSL: the same formulas in float32, with the driver's own square root and power.
#pragma once

#include "halflit/scene.hpp"

#include <string>

namespace halflit::peer {

struct ShaderSources {
    std::string vertex, fragment;
    std::string depth_fragment;  ///< writes no colour, for a depth pre-pass
};

/// Shaders of a scene's one material. What does not change is written as constants: the material, the environment's coefficients and suns.
/// Lamps are uniforms. The target must encode sRGB. products: the highlights' power is written as products, where its exponent is whole.
[[nodiscard]] ShaderSources shader_sources(const Scene& scene, Vec3f eye, bool products);

}  // namespace halflit::peer
