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

/// Places of a material where a texture may be used, with the channels that are read.
enum class TextureSlot : std::uint8_t {
    base_color,                 ///< sRGB, alpha linear
    metallic_roughness,         ///< linear: green is roughness, blue metallic
    normal,                     ///< linear, in tangent space: (2c - 1) * (normal_scale, normal_scale, 1)
    occlusion,                  ///< linear: red
    emissive,                   ///< sRGB
    specular,                   ///< linear: alpha
    specular_color,             ///< sRGB
    transmission,               ///< linear: red
    thickness,                  ///< linear: green
    clearcoat,                  ///< linear: red
    clearcoat_roughness,        ///< linear: green
    clearcoat_normal,           ///< linear, in tangent space; without it the coat has the mesh's normals, not the base's normal map
    sheen_color,                ///< sRGB
    sheen_roughness,            ///< linear: alpha
    iridescence,                ///< linear: red
    iridescence_thickness,      ///< linear: green, from the least thickness to the greatest
    anisotropy,                 ///< linear: red and green (2c - 1) turn the direction in tangent space, blue is the strength
    diffuse_transmission,       ///< linear: alpha
    diffuse_transmission_color  ///< sRGB
};
/// Number of slots.
inline constexpr int kTextureSlots = 19;

/// A value for each slot.
template <class T>
struct BySlot : std::array<T, kTextureSlots> {
    using std::array<T, kTextureSlots>::operator[];
    /// The value of a slot.
    constexpr T& operator[](TextureSlot slot) { return (*this)[static_cast<std::size_t>(slot)]; }
    /// The value of a slot.
    constexpr const T& operator[](TextureSlot slot) const { return (*this)[static_cast<std::size_t>(slot)]; }
};

/// A surface. The defaults are glTF's: white, metallic and rough. Numbers are multiplied by the
/// textures of the slots with their names, metallic and roughness by the channels of TextureSlot::metallic_roughness.
struct Material {
    std::string name{};                        ///< for messages; may be empty
    Vec4f base_color{1, 1, 1, 1};              ///< linear, in [0, 1]; the fourth number is alpha
    float metallic = 1;                        ///< in [0, 1]
    float roughness = 1;                       ///< in [0, 1]
    float dielectric_reflectance = 0.04f;      ///< F0 of dielectrics: reflectance at normal incidence where not metallic, in [0, 1]
    Vec3f emissive{0, 0, 0};                   ///< light of its own, linear, from 0
    float normal_scale = 1;                    ///< factor on x and y of the normal texture
    float occlusion_strength = 1;              ///< in [0, 1]; 0 ignores the occlusion texture; ambient light alone is occluded
    float alpha_cutoff = 0.5f;                 ///< from 0; where the alpha mode is mask: drawn where alpha is at least this
    AlphaMode alpha_mode = AlphaMode::opaque;  ///< meaning of alpha
    bool double_sided = false;                 ///< back faces are drawn too, with their normals turned around
    bool unlit = false;                        ///< base colour (times texture and vertex colour) alone, without light
    bool has_own_lobe = false;                 ///< a setting for all materials does not replace the lobe
    /// Invisible but for the shadows on it: black, with the share of its light that is hidden as alpha. Takes diffuse light by its lobe
    /// alone, has no textures, casts no shadow, and belongs to no bounds that views are framed by.
    bool shadow_catcher = false;
    Lobe lobe{};                    ///< of diffuse light
    BySlot<TextureUse> textures{};  ///< texels are made for a slot by the colour space that it names; normals by MipRule::normal

    // KHR_materials_specular
    float specular = 1;             ///< weight of the specular reflection of dielectrics, in [0, 1]
    Vec3f specular_color{1, 1, 1};  ///< factor on F0 of dielectrics, linear, from 0; F0 is at most 1

    // KHR_materials_transmission, KHR_materials_volume and KHR_materials_dispersion: light that passes through a surface without being
    // scattered, tinted by the base colour and by what absorbs it on its way, blurred by the roughness, and bent where there is thickness.
    // A surface that transmits is drawn as a transparent layer, and casts no shadow, whatever its alpha mode.
    float transmission = 0;            ///< share of light from behind that passes through, in [0, 1]; the rest is diffuse
    float thickness = 0;               ///< path length of that light inside, world units, from 0
    float attenuation_distance = 0;    ///< path length after which white light has attenuation_color, world units; 0: no absorption
    Vec3f attenuation_color{1, 1, 1};  ///< linear, in [0, 1]
    float dispersion = 0;              ///< spread of the indices of refraction of red and blue, from 0: 20 / Abbe's number

    // KHR_materials_clearcoat: a smooth layer with an index of refraction of 1.5 above the surface. It reflects with an F0 of 0.04, and
    // takes what it reflects from the light of all that is below it.
    float clearcoat = 0;               ///< share of the surface that is coated, in [0, 1]
    float clearcoat_roughness = 0;     ///< in [0, 1]
    float clearcoat_normal_scale = 1;  ///< factor on x and y of the coat's normal texture

    // KHR_materials_sheen: fibres above the surface, as those of velvet, which glow at grazing views. What they reflect is taken from what
    // is below them.
    Vec3f sheen_color{0, 0, 0};  ///< of fibres above the surface, linear, in [0, 1]; black: none
    float sheen_roughness = 0;   ///< in [0, 1]; rougher fibres glow less at grazing views and more elsewhere

    // KHR_materials_iridescence: a thin film on the surface, below a coat. Light that its two sides reflect interferes, so what the surface
    // mirrors has colours that change with the angle, as those of soap bubbles and of coated glass.
    float iridescence = 0;                     ///< share of the surface that the film covers, in [0, 1]
    float iridescence_ior = 1.3f;              ///< index of refraction of the film, from 1
    float iridescence_thickness_min_nm = 100;  ///< of the film where its texture is 0, nanometres, from 0
    float iridescence_thickness_max_nm = 400;  ///< of the film where its texture is 1, or without a texture

    // KHR_materials_anisotropy: a brushed surface, rougher along a direction than across it. The direction is the mesh's tangent, turned; a
    // mesh without tangents is drawn without it.
    float anisotropy_strength = 0;      ///< in [0, 1]: alpha along the direction is roughness^2 + (1 - roughness^2) strength^2
    float anisotropy_rotation_rad = 0;  ///< of the direction from the tangent, counter-clockwise, radians

    // KHR_materials_diffuse_transmission: a thin surface, as a leaf or a lampshade, that scatters a share of the light to its far side.
    float diffuse_transmission = 0;             ///< share of scattered light that leaves on the far side, in [0, 1]
    Vec3f diffuse_transmission_color{1, 1, 1};  ///< of that light, in place of the base colour, linear, in [0, 1]

    /// True if F0 where not metallic is more than one number.
    [[nodiscard]] bool has_specular_color() const {
        return specular != 1.0f || specular_color != Vec3f{1, 1, 1} || textures[TextureSlot::specular].used() ||
               textures[TextureSlot::specular_color].used();
    }
    /// True if there is a coat that may be seen.
    [[nodiscard]] bool is_coated() const { return clearcoat > 0.0f && !unlit && !shadow_catcher; }
    /// True if there is sheen that may be seen.
    [[nodiscard]] bool has_sheen() const {
        return (sheen_color.x > 0.0f || sheen_color.y > 0.0f || sheen_color.z > 0.0f) && !unlit && !shadow_catcher;
    }
    /// True if there is a thin film that may be seen.
    [[nodiscard]] bool is_iridescent() const { return iridescence > 0.0f && !unlit && !shadow_catcher; }
    /// True if the surface is brushed.
    [[nodiscard]] bool is_anisotropic() const { return anisotropy_strength > 0.0f && !unlit && !shadow_catcher; }
    /// True if light passes through.
    [[nodiscard]] bool transmits() const { return transmission > 0.0f && !unlit && !shadow_catcher; }
    /// True if the surface is drawn over what is behind it.
    [[nodiscard]] bool is_layer() const { return alpha_mode == AlphaMode::blend || transmits() || shadow_catcher; }
};

}  // namespace halflit
