// KHR_materials_pbrSpecularGlossiness: converted to metal and roughness, texel by texel, after the pictures were decoded.
#pragma once

#include "apps/io/gltf/file/document.hpp"
#include "halflit/scene.hpp"

namespace halflit::io::detail {

/// A surface by its diffuse and its specular colour, linear, in [0, 1].
struct GlossySurface {
    double diffuse[3] = {1, 1, 1}, specular[3] = {1, 1, 1}, glossiness = 1;
};
/// The nearest surface by metal and roughness.
struct MetalSurface {
    double base_color[3], metallic, roughness;
};
/// The conversion that the Khronos group published with the extension (three.pbrUtilities.js): the metallic value is such that the diffuse
/// and specular brightness stay; the base colour is taken from the diffuse colour where not metallic, from the specular one where metallic.
[[nodiscard]] MetalSurface to_metal(const GlossySurface& surface);

/// Converts the materials with that extension. Until then the slots base_color and metallic_roughness of a material have its
/// diffuse and its specular-glossiness texture. Throws LoadFailure.
void convert_specular_glossiness(Document& document, Scene& scene);

}  // namespace halflit::io::detail
