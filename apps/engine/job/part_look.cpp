#include "apps/engine/job/part_look.hpp"

#include "raster/scene/instance_material.hpp"
#include "raster/scene/mean_color.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace halflit::engine {
namespace {

constexpr float kGhostAlpha = 0.16f;
constexpr Vec3f kGhostColor{0.75f, 0.78f, 0.82f};
constexpr float kGlassAlpha = 0.2f;                              // of what transmitted light, dimmed: what lies behind stays in sight
constexpr float kHighlightedGlassAlpha = 0.6f;                   // highlighted it is found at a glance
constexpr float kDarkestDimmed = 0.1f, kLightestDimmed = 0.35f;  // linear

/// Linear luminance of the material's mean colour, in [0, 1] (Rec. 709).
float mean_luminance(const Scene& scene, const Material& material) {
    const Vec3f mean = raster::mean_color(scene, material.textures[TextureSlot::base_color]);
    const Vec4f& base = material.base_color;
    return std::clamp(0.2126f * (mean.x * base.x) + 0.7152f * (mean.y * base.y) + 0.0722f * (mean.z * base.z), 0.0f, 1.0f);
}

/// White with the alpha of the texture.
Result<Texture> alpha_alone(const Texture& texture) {
    const TextureLevel& level = texture.levels()[0];
    const auto texels = texture.data().subspan(4 * static_cast<std::size_t>(level.offset),
                                               4 * static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
    std::vector<std::uint16_t> white(texels.begin(), texels.end());
    TimeCheck check;
    for (std::size_t i = 0; i < white.size(); i += 4) {
        check();
        white[i] = white[i + 1] = white[i + 2] = 65535;
    }
    return Texture::from_rgba16(white, level.width, level.height, texture.rule());
}

}  // namespace

TextureUse PartPainter::shape_of(const Material& source) {
    TextureUse use = source.textures[TextureSlot::base_color];
    if (!use.used() || static_cast<std::size_t>(use.texture) >= scene_.textures.size()) return {};
    const auto [entry, is_new] = shapes_.try_emplace(use.texture, -1);
    if (const Texture& texture = scene_.textures[static_cast<std::size_t>(use.texture)]; is_new && !texture.levels().empty())
        if (auto made = alpha_alone(texture)) {
            entry->second = static_cast<int>(scene_.textures.size());
            scene_.textures.push_back(std::move(*made));
        }
    use.texture = entry->second;
    return use;
}

Material PartPainter::painted(const Material& source, PartLook look, bool is_cap, bool is_lit) {
    Material out;
    out.name = source.name;
    out.metallic = 0.0f;
    out.roughness = 0.6f;
    out.double_sided = source.double_sided;
    out.unlit = !is_lit;
    out.lobe = source.lobe;
    out.has_own_lobe = source.has_own_lobe;
    out.alpha_mode = source.alpha_mode;
    out.alpha_cutoff = source.alpha_cutoff;
    float alpha = source.alpha_mode == AlphaMode::opaque ? 1.0f : source.base_color.w;
    if (is_cap)
        out.textures[TextureSlot::base_color] = source.textures[TextureSlot::base_color];
    else if (source.alpha_mode != AlphaMode::opaque)
        out.textures[TextureSlot::base_color] = shape_of(source);
    if (look == PartLook::ghost) {
        out.alpha_mode = AlphaMode::blend;
        out.roughness = 1.0f;
        out.base_color = {kGhostColor.x, kGhostColor.y, kGhostColor.z, kGhostAlpha};
        return out;
    }
    out.normal_scale = source.normal_scale;
    out.occlusion_strength = source.occlusion_strength;
    if (is_lit && !source.unlit)
        for (const TextureSlot slot : {TextureSlot::normal, TextureSlot::occlusion}) out.textures[slot] = source.textures[slot];
    const bool highlighted = look == PartLook::highlight;
    if (source.transmits()) out.alpha_mode = AlphaMode::blend, alpha = kGlassAlpha;
    if (highlighted && out.alpha_mode == AlphaMode::blend) alpha = std::max(alpha, kHighlightedGlassAlpha);
    const float grey = kDarkestDimmed + (kLightestDimmed - kDarkestDimmed) * mean_luminance(scene_, source);
    const Vec3f color = highlighted ? highlight_ : Vec3f{grey, grey, grey};
    out.base_color = {color.x, color.y, color.z, alpha};
    return out;
}

void PartPainter::paint(Instance& instance, PartLook look, bool is_cap) {
    const int index = raster::material_index(scene_, instance);
    const Material* const found = raster::material_of(scene_, instance);
    const Material source = found != nullptr ? *found : Material{};
    // A surface that had no need of light may have no normals.
    const bool is_lit = !source.unlit || !scene_.meshes[static_cast<std::size_t>(instance.mesh)].normals.empty();
    const auto [entry, is_new] = materials_.try_emplace({index, look, is_cap, is_lit}, static_cast<int>(scene_.materials.size()));
    if (is_new) {
        Material made = painted(source, look, is_cap, is_lit);  // it may add a texture
        scene_.materials.push_back(std::move(made));
    }
    instance.material = entry->second;
    instance.color = {1, 1, 1, 1};
}

}  // namespace halflit::engine
