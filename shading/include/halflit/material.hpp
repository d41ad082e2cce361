// Materials: the glTF metallic-roughness parameters, and the lobe that shapes diffuse light.
#pragma once

#include "halflit/lobe.hpp"
#include "halflit/math.hpp"
#include "halflit/texture.hpp"

#include <cstdint>
#include <string>

namespace halflit {

/// Meaning of a surface's alpha.
enum class AlphaMode : std::uint8_t {
    opaque,  ///< none: alpha counts as 1
    mask,    ///< drawn where alpha >= alpha_cutoff, opaque there
    blend    ///< drawn over what is behind; each sample blends its layers by their depths, of one depth in the order of the scene
};

/// A surface. The defaults are glTF's: white, metallic and rough.
struct Material {
    std::string name;                          ///< for messages; may be empty
    Vec4f base_color{1, 1, 1, 1};              ///< linear; w is alpha
    float metallic = 1.0f, roughness = 1.0f;   ///< in [0, 1], times the texture's
    float dielectric_reflectance = 0.04f;      ///< F0 where not metallic: share of light mirrored straight on, in [0, 1]; glTF's is 0.04
    Vec3f emissive{0, 0, 0};                   ///< linear, KHR_materials_emissive_strength multiplied in
    float normal_scale = 1.0f;                 ///< factor on x and y of the normal texture
    float occlusion_strength = 1.0f;           ///< in [0, 1]: 0 ignores the occlusion texture; ambient light alone is occluded
    AlphaMode alpha_mode = AlphaMode::opaque;  ///< meaning of alpha
    float alpha_cutoff = 0.5f;                 ///< mask: drawn where alpha >= cutoff
    bool double_sided = false;                 ///< back faces are drawn too, with their normals turned around
    bool unlit = false;                        ///< colour is base_color (times texture and vertex colour), no light
    Lobe lobe;                                 ///< diffuse lobe
    bool has_own_lobe = false;                 ///< the file chose the lobe; a setting for all materials does not replace it

    TextureUse base_color_texture;          ///< sRGB, alpha linear
    TextureUse metallic_roughness_texture;  ///< linear: G roughness, B metallic
    TextureUse normal_texture;              ///< linear: tangent space, (2c - 1) * (scale, scale, 1)
    TextureUse occlusion_texture;           ///< linear: R
    TextureUse emissive_texture;            ///< sRGB
};

}  // namespace halflit
