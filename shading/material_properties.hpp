// The tables of material_properties.def.
#pragma once

#include "halflit/material.hpp"
#include "halflit/shading.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>

namespace halflit::shading {

inline constexpr float kMostScale = 1e6f;    ///< beyond it, float texture coordinates have no fraction left
inline constexpr float kMostNumber = 1e18f;  ///< its square is a float

/// Numbers of a member: one, three or four floats.
[[nodiscard]] constexpr int count_of(float) { return 1; }
[[nodiscard]] constexpr int count_of(Vec3f) { return 3; }
[[nodiscard]] constexpr int count_of(Vec4f) { return 4; }
constexpr void get_numbers(float from, float* to) { to[0] = from; }
constexpr void get_numbers(Vec3f from, float* to) { to[0] = from.x, to[1] = from.y, to[2] = from.z; }
constexpr void get_numbers(Vec4f from, float* to) { to[0] = from.x, to[1] = from.y, to[2] = from.z, to[3] = from.w; }
constexpr void set_numbers(float& to, const float* from) { to = from[0]; }
constexpr void set_numbers(Vec3f& to, const float* from) { to = {from[0], from[1], from[2]}; }
constexpr void set_numbers(Vec4f& to, const float* from) { to = {from[0], from[1], from[2], from[3]}; }

/// A number of a material, or a few.
struct MaterialNumber {
    std::string_view name;
    int count;              ///< 1, 3 or 4
    float low, high;        ///< range of each
    std::string_view gltf;  ///< place below a material, with '/' between keys; empty: derived from others
    void (*get)(const Material& from, float* to);
    void (*set)(Material& to, const float* from);
};

inline constexpr MaterialNumber kMaterialNumbers[] = {
#define HALFLIT_NUMBER(member, low, high, gltf)                             \
    {#member,                                                               \
     count_of(decltype(Material::member){}),                                \
     low,                                                                   \
     high,                                                                  \
     gltf,                                                                  \
     [](const Material& from, float* to) { get_numbers(from.member, to); }, \
     [](Material& to, const float* from) { set_numbers(to.member, from); }},
#include "shading/material_properties.def"
};
inline constexpr std::size_t kMaterialNumberCount = std::size(kMaterialNumbers);

/// Where each row's floats begin in a list of all floats of a material, and how many these are.
inline constexpr auto kFirstFloats = [] {
    std::array<std::size_t, kMaterialNumberCount + 1> first{};
    for (std::size_t i = 0; i < kMaterialNumberCount; ++i) first[i + 1] = first[i] + static_cast<std::size_t>(kMaterialNumbers[i].count);
    return first;
}();
inline constexpr std::size_t kMaterialFloats = kFirstFloats.back();
/// Row of a member; kMaterialNumberCount if there is none.
[[nodiscard]] constexpr std::size_t number_row(std::string_view name) {
    std::size_t row = 0;
    while (row < kMaterialNumberCount && kMaterialNumbers[row].name != name) ++row;
    return row;
}

/// "KHR_materials_sheen" of "extensions/KHR_materials_sheen/sheenColorFactor"; empty if the path is not below an extension.
[[nodiscard]] constexpr std::string_view extension_of(std::string_view gltf) {
    constexpr std::string_view kExtensions = "extensions/";
    if (!gltf.starts_with(kExtensions)) return {};
    gltf.remove_prefix(kExtensions.size());
    return gltf.substr(0, gltf.find('/'));
}

/// A place where a material may use a texture.
struct TextureSlotInfo {
    std::string_view name;
    ColorSpace space;
    MipRule rule;  ///< of smaller levels; alpha: counts as equal for opaque materials; normal: the texels are normals
    Stage stage;   ///< reads the texture
    std::string_view gltf;
};

inline constexpr TextureSlotInfo kTextureSlotInfos[] = {
#define HALFLIT_TEXTURE(slot, space, rule, stage, gltf) {#slot, ColorSpace::space, MipRule::rule, stage, gltf},
#include "shading/material_properties.def"
};
static_assert(std::size(kTextureSlotInfos) == kTextureSlots);

inline constexpr TextureSlot kAllTextureSlots[] = {
#define HALFLIT_TEXTURE(slot, ...) TextureSlot::slot,
#include "shading/material_properties.def"
};
static_assert([] {
    for (int i = 0; i < kTextureSlots; ++i)
        if (static_cast<int>(kAllTextureSlots[i]) != i) return false;
    return true;
}());

[[nodiscard]] constexpr const TextureSlotInfo& info_of(TextureSlot slot) { return kTextureSlotInfos[static_cast<std::size_t>(slot)]; }
/// True if the slot's texels are normals.
[[nodiscard]] constexpr bool holds_normals(TextureSlot slot) { return info_of(slot).rule == MipRule::normal; }

/// Row of the number that is 0 where a stage's layer (transmission, coat, sheen, film, brush) is absent: the first number of the extension
/// that the first texture of the stage belongs to. kMaterialNumberCount: the stage belongs to no extension.
[[nodiscard]] constexpr std::size_t layer_row(Stage stage) {
    for (const TextureSlotInfo& info : kTextureSlotInfos) {
        if (info.stage != stage) continue;
        const std::string_view extension = extension_of(info.gltf);
        std::size_t row = extension.empty() ? kMaterialNumberCount : 0;
        while (row < kMaterialNumberCount && extension_of(kMaterialNumbers[row].gltf) != extension) ++row;
        return row;
    }
    return kMaterialNumberCount;
}
static_assert(kMaterialNumbers[layer_row(kStageSheen)].name == "sheen_color" && layer_row(kStageNormalMap) == kMaterialNumberCount);

/// True if the layer that a stage draws is there, and may be seen.
[[nodiscard]] inline bool has_layer(const Material& material, Stage stage) {
    const std::size_t row = layer_row(stage);
    if (row == kMaterialNumberCount) return true;
    const MaterialNumber& number = kMaterialNumbers[row];
    float values[4] = {};
    number.get(material, values);
    return std::any_of(values, values + number.count, [](float value) { return value > 0.0f; }) && !material.unlit &&
           !material.shadow_catcher;
}
/// False if the texture cannot be seen because its layer is absent.
[[nodiscard]] inline bool shows(const Material& material, TextureSlot slot) { return has_layer(material, info_of(slot).stage); }

/// True if the slot's texels are directions in tangent space.
[[nodiscard]] constexpr bool needs_tangents(TextureSlot slot) { return holds_normals(slot) || slot == TextureSlot::anisotropy; }

/// Set of texture coordinates by which tangents are made: of the first texture in tangent space, else 0 for a brushed surface. Nothing: the
/// material needs no tangents.
[[nodiscard]] inline std::optional<int> tangent_uv_set(const Material& material) {
    for (const TextureSlot slot : kAllTextureSlots)
        if (needs_tangents(slot) && material.textures[slot].used()) return material.textures[slot].uv_set;
    return material.is_anisotropic() ? std::optional(0) : std::nullopt;
}

}  // namespace halflit::shading
