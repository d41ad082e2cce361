#include "apps/io/gltf/build/materials.hpp"

#include "apps/io/files/lobe_name.hpp"
#include "apps/io/files/text.hpp"
#include "sh/power.hpp"
#include "sh/time_limit.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"
#include "shading/material_properties.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace halflit::io::detail {

namespace {

float clamp01(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

constexpr double kMostScale = shading::kMostScale;

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

constexpr std::size_t kThickness = shading::number_row("thickness");
static_assert(kThickness < shading::kMaterialNumberCount);

/// Numbers of a row, held within its range.
void held_numbers(const file::Material& source, std::size_t row, float* to) {
    const shading::MaterialNumber& number = shading::kMaterialNumbers[row];
    for (int c = 0; c < number.count; ++c) {
        const double value = source.numbers[shading::kFirstFloats[row] + static_cast<std::size_t>(c)];
        to[c] = static_cast<float>(std::clamp(value, static_cast<double>(number.low), static_cast<double>(number.high)));
    }
}

float thickness_of(const file::Material& source) {
    float thickness = 0.0f;
    held_numbers(source, kThickness, &thickness);
    return thickness;
}

/// Sets a value. Returns true if it changes.
template <class T>
bool put(T& to, const T& value) {
    const bool changes = !(to == value);
    to = value;
    return changes;
}

/// All numbers of a material but its thickness, which its instances scale, and those of its textures.
bool set_factors(const file::Material& source, Material& material) {
    bool changed = false;
    for (std::size_t row = 0; row < shading::kMaterialNumberCount; ++row) {
        const shading::MaterialNumber& number = shading::kMaterialNumbers[row];
        if (number.gltf.empty() || row == kThickness || source.replaces(number.gltf)) continue;
        float now[4], before[4];
        held_numbers(source, row, now);
        number.get(material, before);
        if (std::equal(now, now + number.count, before)) continue;
        number.set(material, now);
        changed = true;
    }
    if (source.glossy < 0) {
        const double root = (source.ior - 1.0) / (source.ior + 1.0);  // Fresnel, straight on; -1 for the index 0, as the extension asks
        changed |= put(material.dielectric_reflectance, clamp01(root * root));
    }
    const double glow = std::clamp(source.emissive_strength, 0.0, 1e18);
    const auto emissive = [&](std::size_t c) {
        return static_cast<float>(std::clamp(number_at(source.emissive_factor, c, 0.0), 0.0, 1.0) * glow);
    };
    return put(material.emissive, {emissive(0), emissive(1), emissive(2)}) || changed;
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
        where_ = fmt::format("materials[{}]", index);
        Material material;
        material.name = source.name;
        set_factors(source, material);
        material.thickness = thickness_of(source);
        if (source.alpha_mode == "MASK")
            material.alpha_mode = AlphaMode::mask;
        else if (source.alpha_mode == "BLEND")
            material.alpha_mode = AlphaMode::blend;
        material.double_sided = source.double_sided;
        material.unlit = source.unlit;
        if (source.own_lobe) own_lobe(*source.own_lobe, material, used);
        // An animation may make a layer visible later.
        const bool may_change = document_.options.keep_animations && !document_.file.animations.empty() && !material.unlit;
        for (const TextureSlot slot : shading::kAllTextureSlots)
            if (used && (may_change || shading::shows(material, slot)))
                material.textures[slot] = texture_of(source, slot, material.alpha_mode);
        return material;
    }

private:
    TextureUse texture_of(const file::Material& source, TextureSlot slot, AlphaMode alpha) {
        const shading::TextureSlotInfo& info = shading::info_of(slot);
        const MipRule rule = info.rule == MipRule::alpha && alpha == AlphaMode::opaque ? MipRule::equal : info.rule;
        if (source.replaces(info.gltf)) {
            const file::SpecularGlossiness& glossy = document_.file.glossy[static_cast<std::size_t>(source.glossy)];
            return slot == TextureSlot::base_color
                       ? use(glossy.diffuse_texture, "extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture", ColorSpace::srgb,
                             rule)
                       : use(glossy.specular_glossiness_texture, "extensions.KHR_materials_pbrSpecularGlossiness.specularGlossinessTexture",
                             ColorSpace::srgb, rule);
        }
        return use(source.places[slot], file::place_of(slot), info.space, rule);
    }

    TextureUse use(const file::TexturePlace& info, std::string_view key, ColorSpace space, MipRule rule) {
        TextureUse use;
        if (info.index < 0) return use;
        const file::Texture& texture = document_.file.textures[static_cast<std::size_t>(info.index)];
        if (texture.source < 0) {
            document_.warn(fmt::format("textures[{}]: {}, left out", info.index,
                                       texture.basisu >= 0 ? "its picture is KTX2 (KHR_texture_basisu), which needs the library libzstd"
                                                           : "has no source picture that can be read"));
            return use;
        }
        int uv_set = info.tex_coord;
        const file::TextureTransform* const transform = document_.file.transform_of(info);
        if (transform != nullptr) apply_transform(*transform, use, uv_set);
        if (uv_set > 1) {
            const bool own = transform == nullptr || transform->tex_coord < 0;
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
    bool changed = set_factors(source, material);
    for (const TextureSlot slot : shading::kAllTextureSlots) {
        TextureUse& use = material.textures[slot];
        const file::TextureTransform* const transform = file.transform_of(source.places[slot]);
        if (transform == nullptr || !use.used() || source.replaces(shading::info_of(slot).gltf)) continue;
        const TextureUse before = use;
        int uv_set = use.uv_set;
        apply_transform(*transform, use, uv_set);
        changed |= !(use.row_u == before.row_u && use.row_v == before.row_v);
    }
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
        const float thickness = thickness_of(file.materials[material]);
        const Mat4& m = world_from_object[i];
        const auto column = [&](int c) { return Vec3d{m.c[c].x, m.c[c].y, m.c[c].z}; };
        const double volume = dot(column(0), cross(column(1), column(2)));
        const double scaled = thickness == 0.0f ? 0.0 : static_cast<double>(thickness) * power_of(volume < 0 ? -volume : volume, 1.0 / 3);
        changed |= put(scene.materials[material].thickness, static_cast<float>(std::min(1e18, scaled)));
    }
    return changed;
}

void make_visible(Document& document, Scene& scene) {
    const auto is_clear = [](const Mesh& mesh, const Material& material) {
        if (material.alpha_mode == AlphaMode::opaque) return false;
        return material.base_color.w == 0.0f ||
               (!mesh.colors.empty() && std::all_of(mesh.colors.begin(), mesh.colors.end(), [](const Vec4f& c) { return c.w == 0.0f; }));
    };
    if (document.options.strict || scene.instances.empty()) return;
    std::vector<bool> judged(scene.meshes.size(), false);
    for (const Instance& instance : scene.instances) {
        if (judged[static_cast<std::size_t>(instance.mesh)]) continue;
        judged[static_cast<std::size_t>(instance.mesh)] = true;
        check_time();
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (mesh.material < 0 || !is_clear(mesh, scene.materials[static_cast<std::size_t>(mesh.material)])) return;
    }
    for (Mesh& mesh : scene.meshes)
        for (Vec4f& color : mesh.colors) color.w = 1.0f;
    for (Material& material : scene.materials) {
        material.base_color.w = 1.0f;
        material.alpha_mode = AlphaMode::opaque;
    }
    document.warn("alpha is 0 everywhere, which would draw nothing; drawn opaque");
}

}  // namespace halflit::io::detail
