// Materials: the glTF metallic-roughness parameters, and the lobe that shapes diffuse light.
#pragma once

#include "halflit/lobe.hpp"
#include "halflit/math.hpp"
#include "halflit/texture.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace halflit {

/// Meaning of a surface's alpha.
enum class AlphaMode : std::uint8_t {
    opaque,  ///< none: alpha counts as 1
    mask,    ///< drawn where alpha >= alpha_cutoff, opaque there
    blend    ///< drawn over what is behind; each sample blends its layers by their depths, of one depth in the order of the scene
};

/// Light that passes through a surface without being scattered or refracted, tinted by the base colour and by what absorbs it on its way:
/// KHR_materials_transmission, and KHR_materials_volume without refraction. A surface that transmits is drawn as a transparent layer, and
/// casts no shadow, whatever its alpha mode.
struct Transmission {
    float share = 0;                   ///< of the light that enters the surface, in [0, 1], times the texture's; the rest is matt
    float thickness = 0;               ///< way that light goes inside, world units, from 0, times the texture's
    float attenuation_distance = 0;    ///< way after which white light has the colour below, world units; 0: nothing is absorbed
    Vec3f attenuation_color{1, 1, 1};  ///< linear, in [0, 1]
    TextureUse texture;                ///< linear: R
    TextureUse thickness_texture;      ///< linear: G
};

/// A smooth layer of varnish above the surface, with an index of refraction of 1.5: KHR_materials_clearcoat. It mirrors with an F0 of 0.04,
/// and takes what it mirrors from the light of all that is below it.
struct Clearcoat {
    float factor = 0;              ///< share of the surface that is coated, in [0, 1], times the texture's; 0: there is no coat
    float roughness = 0;           ///< in [0, 1], times the texture's
    float normal_scale = 1;        ///< factor on x and y of the normal texture
    TextureUse texture;            ///< linear: R
    TextureUse roughness_texture;  ///< linear: G
    TextureUse normal_texture;     ///< linear: tangent space; without it the coat has the mesh's normals, not the base's normal map
};

/// Fibres above the surface, as those of velvet, which glow at grazing views: KHR_materials_sheen. What they reflect is taken from what is
/// below them.
struct Sheen {
    Vec3f color{0, 0, 0};          ///< linear, in [0, 1], times the texture's; black: there is no sheen
    float roughness = 0;           ///< in [0, 1], times the texture's; rougher fibres glow less at grazing views and more elsewhere
    TextureUse color_texture;      ///< sRGB
    TextureUse roughness_texture;  ///< linear: A
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
    /// Invisible but for the shadows on it: black, with the share of its light that is hidden as alpha. Takes matt light by its lobe alone,
    /// has no textures, casts no shadow, and belongs to no bounds that views are framed by.
    bool shadow_catcher = false;

    float specular = 1;             ///< KHR_materials_specular: factor of what is mirrored where not metallic, in [0, 1]
    Vec3f specular_color{1, 1, 1};  ///< linear, from 0: factor of F0 there, which is at most 1
    Transmission transmission;      ///< light from behind that passes through
    Clearcoat clearcoat;            ///< varnish
    Sheen sheen;                    ///< fibres, below the varnish
    /// True if F0 where not metallic is more than one number.
    [[nodiscard]] bool has_specular_color() const {
        return specular != 1.0f || specular_color != Vec3f{1, 1, 1} || specular_texture.used() || specular_color_texture.used();
    }
    /// True if there is a coat that may be seen.
    [[nodiscard]] bool is_coated() const { return clearcoat.factor > 0.0f && !unlit && !shadow_catcher; }
    /// True if there is sheen that may be seen.
    [[nodiscard]] bool has_sheen() const {
        return (sheen.color.x > 0.0f || sheen.color.y > 0.0f || sheen.color.z > 0.0f) && !unlit && !shadow_catcher;
    }
    /// True if light passes through.
    [[nodiscard]] bool transmits() const { return transmission.share > 0.0f && !unlit && !shadow_catcher; }
    /// True if the surface is drawn over what is behind it.
    [[nodiscard]] bool is_layer() const { return alpha_mode == AlphaMode::blend || transmits() || shadow_catcher; }

    TextureUse base_color_texture;          ///< sRGB, alpha linear
    TextureUse metallic_roughness_texture;  ///< linear: G roughness, B metallic
    TextureUse normal_texture;              ///< linear: tangent space, (2c - 1) * (scale, scale, 1)
    TextureUse occlusion_texture;           ///< linear: R
    TextureUse emissive_texture;            ///< sRGB
    TextureUse specular_texture;            ///< linear: A, times `specular`
    TextureUse specular_color_texture;      ///< sRGB, times `specular_color`
};

/// Every place of a material where a texture may be used. `material` may be const.
template <class AnyMaterial>
[[nodiscard]] constexpr auto texture_uses(AnyMaterial& material) {
    return std::array{&material.base_color_texture,
                      &material.metallic_roughness_texture,
                      &material.normal_texture,
                      &material.occlusion_texture,
                      &material.emissive_texture,
                      &material.specular_texture,
                      &material.specular_color_texture,
                      &material.transmission.texture,
                      &material.transmission.thickness_texture,
                      &material.clearcoat.texture,
                      &material.clearcoat.roughness_texture,
                      &material.clearcoat.normal_texture,
                      &material.sheen.color_texture,
                      &material.sheen.roughness_texture};
}

}  // namespace halflit
