// Frame settings and materials of the trials.
#include "shading/material_properties.hpp"
#include "tests/adversary/textures.hpp"
#include "tests/adversary/trial.hpp"

#include <algorithm>

namespace halflit::adversary {
namespace {

Lobe some_lobe(Genes& genes) {
    const int kind = genes.pick(7);
    // A third of the wraps are 0, 1 or nearly so.
    const double w = genes.next(), end = genes.next();
    const auto wrap = static_cast<float>(end < 0.7 ? w : end < 0.8 ? 0.0 : end < 0.9 ? 1.0 : w * 0x1p-10);
    const double power = genes.octaves(1, 2.5), rare = genes.next(), sharp = genes.octaves(1.0 / 16, 17);
    const auto n = static_cast<float>(rare < 0.85 ? power : std::min(sharp, 10000.0));
    switch (kind) {
        case 0:
            return Lobe::lambert();
        case 1:
            return Lobe::green(wrap);
        case 2:
            return Lobe::valve();
        case 3:
        case 4:
            return Lobe::sloan(wrap);
        case 5:
            return Lobe::mcauley(wrap, n);
        default:
            return {wrap, n, false};
    }
}

Material some_material(Genes& genes) {
    Material m;
    m.has_own_lobe = true;
    m.lobe = some_lobe(genes);  // 6 genes
    const Vec3f color = some_color(genes);
    m.base_color = {color.x, color.y, color.z, 1};
    m.metallic = genes.chance(0.5) ? genes.real32(1, 0) : 0.0f;
    genes.skip(m.metallic > 0 ? 0 : 1);
    m.roughness = genes.real32(1, 0);
    if (genes.chance(0.3)) m.roughness *= 0.125f;
    const bool other = genes.chance(0.2);
    const float reflectance = genes.real32(0, 1);
    if (other) m.dielectric_reflectance = reflectance;
    const bool glows = genes.chance(0.15);
    const Vec3f glow = some_color(genes);
    const float glow_level = genes.octaves32(0x1p-10, 12);
    if (glows) m.emissive = glow * glow_level;
    m.normal_scale = genes.chance(0.3) ? genes.real32(-1, 4) : 1.0f;
    if (m.normal_scale == 1.0f) genes.skip(1);
    m.occlusion_strength = genes.real32(1, 0);
    m.double_sided = genes.chance(0.3);
    m.unlit = genes.chance(0.03);
    // Blended surfaces do not fill a pixel alone, unless their alpha is 1.
    const int mode = genes.pick(20);
    m.alpha_mode = mode == 18 ? AlphaMode::mask : mode == 19 ? AlphaMode::blend : AlphaMode::opaque;
    m.alpha_cutoff = 0.3f;
    return m;
}

}  // namespace

namespace {

/// Numbers of the extensions' properties: each is the default, or anything up to twice white, or twice the default.
void add_layers(const Genome& genome, int index, Trial& trial, Material& m) {
    int row = 0;
    for (const shading::MaterialNumber& number : shading::kMaterialNumbers) {
        if (!number.gltf.starts_with("extensions/")) continue;
        // Four genes for each.
        Genes genes(genome, kLayers + kLayerSections * index + row / 8 % kLayerSections, trial.read);
        genes.skip(row++ % 8 * 4);
        if (!genes.chance(0.2)) continue;
        float values[4];
        number.get(m, values);
        const float high = std::max(2.0f, 2.0f * values[0]);
        for (int c = 0; c < number.count; ++c) values[c] = genes.real32(std::max(number.low, -1.0f), std::min(number.high, high));
        number.set(m, values);
    }
}

void add_textures(const Genome& genome, AvoidSet avoid, int index, Trial& trial, Material& m) {
    for (int i = 0; i < kTextureSlots; ++i) {
        const auto slot = static_cast<TextureSlot>(i);
        const int section = i < kFirstSlots ? kMaterialTextures + index * kFirstSlots / 2 + i / 2
                                            : kLayerTextures + index * kSlotSections + (i - kFirstSlots) / 2;
        Genes genes(genome, section, trial.read);
        genes.skip(i % 2 * kTextureGenes);
        TextureUse& use = m.textures[slot];
        const auto picture = some_texture(genes, slot, avoid, use);
        const bool metal = slot == TextureSlot::base_color || slot == TextureSlot::metallic_roughness;
        if (picture == nullptr || ((avoid & kAvoidMetalTextures) != 0 && metal)) {
            use = {};
            continue;
        }
        use.texture = static_cast<int>(trial.scene.textures.size());
        trial.scene.textures.push_back(picture->texture);
        trial.pictures.push_back(picture);
    }
}

}  // namespace

void add_materials(const Genome& genome, AvoidSet avoid, Trial& trial) {
    for (int i = 0; i < kMaterials; ++i) {
        Genes genes(genome, kMaterial + i, trial.read);
        Material m = some_material(genes);
        add_layers(genome, i, trial, m);
        add_textures(genome, avoid, i, trial, m);
        trial.scene.materials.push_back(m);
    }
}

Vec3f some_color(Genes& genes) {
    const double level = genes.real(1, 0), hue = genes.next(), strength = genes.next();
    const auto channel = [&](double at) { return static_cast<float>(level * (1 - strength * (hue > at ? hue - at : at - hue))); };
    return {channel(0), channel(0.5), channel(1)};
}

Vec3f some_direction(Genes& genes) {
    const Vec3f v{genes.real32(0, 2), genes.real32(1, -1), genes.real32(0, 2)};
    // Values above 1 stand for the negative ones, so that 0 is in the middle and simple.
    const auto side = [](float x) { return x <= 1.0f ? x : 1.0f - x; };
    return normalize_or(Vec3f{side(v.x), v.y, side(v.z)}, {0, 1, 0});
}

}  // namespace halflit::adversary
