#include "apps/io/detail/gltf_materials.hpp"

#include "apps/io/lobe_name.hpp"
#include "apps/io/text.hpp"
#include "sh/power.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace halflit::io::detail {

namespace {

float clamp01(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

constexpr double kMostScale = 1e6;  // beyond it, float texture coordinates have no fraction left

/// values[index], held within kMostScale, or `otherwise` if the list is shorter.
double number_at(const std::vector<double>& values, std::size_t index, double otherwise) {
    return index < values.size() ? std::clamp(values[index], -kMostScale, kMostScale) : otherwise;
}

// glTF 2.0, sampler: codes of OpenGL.
constexpr int kNearest = 9728, kLinear = 9729, kNearestMipmapNearest = 9984, kLinearMipmapNearest = 9985, kNearestMipmapLinear = 9986;
constexpr int kClampToEdge = 33071, kMirroredRepeat = 33648;

TextureWrap wrap_of(int code) {
    if (code == kClampToEdge) return TextureWrap::clamp;
    return code == kMirroredRepeat ? TextureWrap::mirror : TextureWrap::repeat;
}

Sampler sampler_of(const Document& document, int index) {
    Sampler sampler;
    if (index < 0) return sampler;
    const file::Sampler& source = document.file.samplers[static_cast<std::size_t>(index)];
    sampler.wrap_u = wrap_of(source.wrap_s);
    sampler.wrap_v = wrap_of(source.wrap_t);
    sampler.mag = source.mag_filter == kNearest ? TextureFilter::nearest : TextureFilter::linear;
    using enum MipFilter;
    switch (source.min_filter) {
        case kNearest:
            sampler.min = TextureFilter::nearest;
            sampler.mip = none;
            break;
        case kLinear:
            sampler.mip = none;
            break;
        case kNearestMipmapNearest:
            sampler.min = TextureFilter::nearest;
            sampler.mip = nearest;
            break;
        case kLinearMipmapNearest:
            sampler.mip = nearest;
            break;
        case kNearestMipmapLinear:
            sampler.min = TextureFilter::nearest;
            break;
        default:
            break;  // linear within and between levels, also without a filter
    }
    return sampler;
}

float thickness_of(const file::MaterialExtensions& source) { return static_cast<float>(std::clamp(source.thickness_factor, 0.0, 1e18)); }

/// Sets a value. Returns true if it changes.
template <class T>
bool put(T& to, const T& value) {
    const bool changes = !(to == value);
    to = value;
    return changes;
}

/// All numbers of a material but those of its textures.
bool set_factors(const file::Material& source, const file::MaterialExtensions& more, Material& material) {
    bool changed = false;
    if (!more.specular_glossiness) {
        const auto base = [&](std::size_t c) { return clamp01(number_at(source.base_color_factor, c, 1.0)); };
        changed |= put(material.base_color, {base(0), base(1), base(2), base(3)});
        changed |= put(material.metallic, clamp01(source.metallic_factor));
        changed |= put(material.roughness, clamp01(source.roughness_factor));
        const double root = (source.ior - 1.0) / (source.ior + 1.0);  // Fresnel, straight on; -1 for the index 0, as the extension asks
        changed |= put(material.dielectric_reflectance, clamp01(root * root));
    }
    const double glow = std::clamp(source.emissive_strength, 0.0, 1e18);
    const auto emissive = [&](std::size_t c) {
        return static_cast<float>(std::clamp(number_at(source.emissive_factor, c, 0.0), 0.0, 1.0) * glow);
    };
    changed |= put(material.emissive, {emissive(0), emissive(1), emissive(2)});
    changed |= put(material.normal_scale, static_cast<float>(std::clamp(source.normal_texture.scale, -kMostScale, kMostScale)));
    changed |= put(material.occlusion_strength, clamp01(source.occlusion_texture.strength));
    changed |= put(material.alpha_cutoff, static_cast<float>(std::clamp(source.alpha_cutoff, 0.0, 1e6)));
    Transmission& t = material.transmission;
    changed |= put(t.share, clamp01(more.transmission_factor));
    changed |= put(t.attenuation_distance, static_cast<float>(std::clamp(more.attenuation_distance, 0.0, 1e18)));
    const auto attenuation = [&](std::size_t c) { return clamp01(number_at(more.attenuation_color, c, 1.0)); };
    changed |= put(t.attenuation_color, {attenuation(0), attenuation(1), attenuation(2)});
    changed |= put(material.specular, clamp01(more.specular_factor));
    const auto specular = [&](std::size_t c) { return static_cast<float>(std::max(0.0, number_at(more.specular_color_factor, c, 1.0))); };
    changed |= put(material.specular_color, {specular(0), specular(1), specular(2)});
    Clearcoat& coat = material.clearcoat;
    changed |= put(coat.factor, clamp01(more.clearcoat_factor));
    changed |= put(coat.roughness, clamp01(more.clearcoat_roughness_factor));
    changed |= put(coat.normal_scale, static_cast<float>(std::clamp(more.clearcoat_normal_texture.scale, -kMostScale, kMostScale)));
    const auto sheen = [&](std::size_t c) { return clamp01(number_at(more.sheen_color_factor, c, 0.0)); };
    changed |= put(material.sheen.color, {sheen(0), sheen(1), sheen(2)});
    changed |= put(material.sheen.roughness, clamp01(more.sheen_roughness_factor));
    return changed;
}

/// KHR_texture_transform: uv' = T R S uv, with rows R = [cos sin; -sin cos]: counter-clockwise as seen, where v points down.
/// differs: the shader in the extension's text, whose matrices are given by columns, has the transpose. The extension's test model and
/// viewers agree with R as it is here.
void apply_transform(const file::TextureTransform& source, TextureUse& use, int& uv_set) {
    const double su = number_at(source.scale, 0, 1.0), sv = number_at(source.scale, 1, 1.0);
    const SinCos angle = sin_cos(source.rotation);
    use.row_u = {static_cast<float>(angle.cos * su), static_cast<float>(angle.sin * sv),
                 static_cast<float>(number_at(source.offset, 0, 0.0))};
    use.row_v = {static_cast<float>(-angle.sin * su), static_cast<float>(angle.cos * sv),
                 static_cast<float>(number_at(source.offset, 1, 0.0))};
    if (source.tex_coord >= 0) uv_set = source.tex_coord;
}

class MaterialMaker {
public:
    MaterialMaker(Document& document, ImageStore& images) : document_(document), images_(images) {}

    Material make(std::size_t index, bool used) {
        const file::Material& source = document_.file.materials[index];
        const file::MaterialExtensions& more = document_.file.extensions_of(source);
        where_ = fmt::format("materials[{}]", index);
        Material material;
        material.name = source.name;
        set_factors(source, more, material);
        material.transmission.thickness = thickness_of(more);
        if (source.alpha_mode == "MASK")
            material.alpha_mode = AlphaMode::mask;
        else if (source.alpha_mode == "BLEND")
            material.alpha_mode = AlphaMode::blend;
        material.double_sided = source.double_sided;
        material.unlit = source.unlit;
        if (source.own_lobe) own_lobe(*source.own_lobe, material, used);
        if (used) {
            const MipRule color_rule = material.alpha_mode == AlphaMode::opaque ? MipRule::equal : MipRule::alpha;
            if (more.specular_glossiness) {
                constexpr const char* kWhere = "extensions.KHR_materials_pbrSpecularGlossiness.";
                material.base_color_texture =
                    use(more.diffuse_texture, fmt::format("{}diffuseTexture", kWhere), ColorSpace::srgb, color_rule);
                material.metallic_roughness_texture =
                    use(more.specular_glossiness_texture, fmt::format("{}specularGlossinessTexture", kWhere), ColorSpace::srgb);
            } else {
                material.base_color_texture =
                    use(source.base_color_texture, "pbrMetallicRoughness.baseColorTexture", ColorSpace::srgb, color_rule);
                material.metallic_roughness_texture =
                    use(source.metallic_roughness_texture, "pbrMetallicRoughness.metallicRoughnessTexture", ColorSpace::linear);
            }
            material.specular_texture = use(more.specular_texture, "extensions.KHR_materials_specular.specularTexture", ColorSpace::linear);
            material.specular_color_texture =
                use(more.specular_color_texture, "extensions.KHR_materials_specular.specularColorTexture", ColorSpace::srgb);
            material.emissive_texture = use(source.emissive_texture, "emissiveTexture", ColorSpace::srgb);
            material.normal_texture = use(source.normal_texture, "normalTexture", ColorSpace::linear, MipRule::normal);
            material.occlusion_texture = use(source.occlusion_texture, "occlusionTexture", ColorSpace::linear);
            if (material.has_sheen()) {
                constexpr const char* kWhere = "extensions.KHR_materials_sheen.";
                material.sheen.color_texture = use(more.sheen_color_texture, fmt::format("{}sheenColorTexture", kWhere), ColorSpace::srgb);
                material.sheen.roughness_texture =
                    use(more.sheen_roughness_texture, fmt::format("{}sheenRoughnessTexture", kWhere), ColorSpace::linear);
            }
            if (material.is_coated()) read_coat(more, material.clearcoat);
            material.transmission.texture =
                use(more.transmission_texture, "extensions.KHR_materials_transmission.transmissionTexture", ColorSpace::linear);
            material.transmission.thickness_texture =
                use(more.thickness_texture, "extensions.KHR_materials_volume.thicknessTexture", ColorSpace::linear);
        }
        return material;
    }

private:
    void read_coat(const file::MaterialExtensions& source, Clearcoat& coat) {
        constexpr const char* kWhere = "extensions.KHR_materials_clearcoat.";
        coat.texture = use(source.clearcoat_texture, fmt::format("{}clearcoatTexture", kWhere), ColorSpace::linear);
        coat.roughness_texture =
            use(source.clearcoat_roughness_texture, fmt::format("{}clearcoatRoughnessTexture", kWhere), ColorSpace::linear);
        coat.normal_texture =
            use(source.clearcoat_normal_texture, fmt::format("{}clearcoatNormalTexture", kWhere), ColorSpace::linear, MipRule::normal);
    }

    TextureUse use(const file::TexturePlace& info, std::string_view key, ColorSpace space, MipRule rule = MipRule::equal) {
        TextureUse use;
        if (info.index < 0) return use;
        const file::Texture& texture = document_.file.textures[static_cast<std::size_t>(info.index)];
        if (texture.source < 0) {
            document_.warn(fmt::format("textures[{}]: {}, left out", info.index,
                                       texture.basisu >= 0 ? "its picture is KTX2 (KHR_texture_basisu), which is not supported"
                                                           : "has no source picture that can be read"));
            return use;
        }
        int uv_set = info.tex_coord;
        if (info.transform) apply_transform(*info.transform, use, uv_set);
        if (uv_set > 1) {
            const bool own = !info.transform || info.transform->tex_coord < 0;
            document_.warn(fmt::format("{}.{}.{}texCoord: set {} is not supported (0 and 1 are), the texture is left out", where_, key,
                                       own ? "" : "extensions.KHR_texture_transform.", uv_set));
            return use;
        }
        use.uv_set = uv_set;
        use.sampler = sampler_of(document_, texture.sampler);
        use.texture = images_.texture_for(texture.source, space, rule);
        return use;
    }

    /// extras.halflit = {"lobe": "sloan", "wrap": 0.5, "power": 1.5, "normalize": true}
    void own_lobe(const file::OwnLobe& own, Material& material, bool used) const {
        const auto lobe = lobe_from_name(own.name, own.parameters);
        if (!lobe && used) refuse(where_ + ".extras.halflit", lobe.error().message);
        if (!lobe) return document_.warn(fmt::format("{}.extras.halflit: {}, {}", where_, lobe.error().message, kNothingUsesIt));
        material.lobe = *lobe;
        material.has_own_lobe = true;
    }

    Document& document_;
    ImageStore& images_;
    std::string where_;
};

}  // namespace

std::vector<Material> make_materials(Document& document, ImageStore& images, const std::vector<bool>& used) {
    MaterialMaker maker(document, images);
    std::vector<Material> materials;
    materials.reserve(document.file.materials.size());
    for (std::size_t i = 0; i < document.file.materials.size(); ++i) materials.push_back(maker.make(i, used[i]));
    return materials;
}

bool set_material(const file::File& file, std::size_t index, Material& material) {
    const file::Material& source = file.materials[index];
    const file::MaterialExtensions& more = file.extensions_of(source);
    bool changed = set_factors(source, more, material);
    const auto transform = [&](const file::TexturePlace& place, TextureUse& use) {
        if (!place.transform || !use.used()) return;
        const TextureUse before = use;
        int uv_set = use.uv_set;
        apply_transform(*place.transform, use, uv_set);
        changed |= !(use.row_u == before.row_u && use.row_v == before.row_v);
    };
    if (!more.specular_glossiness) {
        transform(source.base_color_texture, material.base_color_texture);
        transform(source.metallic_roughness_texture, material.metallic_roughness_texture);
    }
    transform(source.normal_texture, material.normal_texture);
    transform(source.occlusion_texture, material.occlusion_texture);
    transform(source.emissive_texture, material.emissive_texture);
    transform(more.transmission_texture, material.transmission.texture);
    transform(more.thickness_texture, material.transmission.thickness_texture);
    transform(more.specular_texture, material.specular_texture);
    transform(more.specular_color_texture, material.specular_color_texture);
    return changed;
}

bool set_thickness(const file::File& file, Scene& scene, std::span<const Mat4> world_from_object) {
    bool changed = false;
    std::vector<bool> done(file.materials.size(), false);
    for (std::size_t i = 0; i < world_from_object.size(); ++i) {
        const int index = scene.meshes[static_cast<std::size_t>(scene.instances[i].mesh)].material;
        if (index < 0 || static_cast<std::size_t>(index) >= done.size() || done[static_cast<std::size_t>(index)]) continue;
        const auto material = static_cast<std::size_t>(index);
        done[material] = true;
        const float thickness = thickness_of(file.extensions_of(file.materials[material]));
        const Mat4& m = world_from_object[i];
        const auto column = [&](int c) { return Vec3d{m.c[c].x, m.c[c].y, m.c[c].z}; };
        const double volume = dot(column(0), cross(column(1), column(2)));
        const double scaled = thickness == 0.0f ? 0.0 : static_cast<double>(thickness) * power_of(volume < 0 ? -volume : volume, 1.0 / 3);
        changed |= put(scene.materials[material].transmission.thickness, static_cast<float>(std::min(1e18, scaled)));
    }
    return changed;
}

}  // namespace halflit::io::detail
