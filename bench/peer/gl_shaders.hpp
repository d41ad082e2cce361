// halflit's exact shading of a bench scene as GLSL: the same formulas in float32, with the driver's own square root and power.
#pragma once

#include "halflit/scene.hpp"

#include <string>

namespace halflit::peer {

/// What a fragment gives: its colour, planes that say what the pixel shows, or both. Planes are an unsigned number of the triangle, the
/// distance along the view axis, and the weights of the triangle's second and third corner, in colour attachments 1 to 3. They need the
/// vertices of a LabelledMesh.
enum class PeerOutputs { colour, planes, both };

struct ShaderSources {
    std::string vertex, fragment;
    std::string depth_fragment;  ///< writes no colour, for a depth pre-pass
};

/// Shaders of a scene's one material. What does not change is written as constants: the material, the environment's coefficients and suns.
/// Lights and the eye are uniforms. The target must encode sRGB. products: the highlights' power is written as products, where its exponent
/// is whole.
[[nodiscard]] ShaderSources shader_sources(const Scene& scene, PeerOutputs outputs, bool products);

}  // namespace halflit::peer
