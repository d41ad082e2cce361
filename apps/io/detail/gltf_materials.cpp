#include "apps/io/detail/gltf_materials.hpp"

#include "apps/io/text.hpp"
#include "apps/io/lobe_name.hpp"
#include "sh/trig.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace halflit::io::detail {

namespace {

using shading::ColorSpace;

float clamp01(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

const tinygltf::Value* member(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key) {
    const auto found = extensions.find(extension);
    if (found == extensions.end() || !found->second.IsObject() || !found->second.Has(key)) return nullptr;
    return &found->second.Get(key);
}

double number_at(const tinygltf::Value* array, std::size_t index, double otherwise) {
    if (array == nullptr || !array->IsArray() || array->ArrayLen() <= index) return otherwise;
    const tinygltf::Value& value = array->Get(static_cast<int>(index));
    constexpr double kMost = 1e6;  // beyond it, float texture coordinates have no fraction left
    return value.IsNumber() ? std::clamp(value.GetNumberAsDouble(), -kMost, kMost) : otherwise;
}

shading::Wrap wrap_of(Document& document, int code) {
    if (code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return shading::Wrap::clamp;
    if (code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return shading::Wrap::mirror;
    if (code != TINYGLTF_TEXTURE_WRAP_REPEAT) document.warn(fmt::format("samplers: unknown wrap mode {}, drawn as repeat", code));
    return shading::Wrap::repeat;
}

shading::Sampler sampler_of(Document& document, int index) {
    shading::Sampler sampler;
    if (index < 0) return sampler;
    const tinygltf::Sampler& source = document.model.samplers[static_cast<std::size_t>(index)];
    sampler.wrap_u = wrap_of(document, source.wrapS);
    sampler.wrap_v = wrap_of(document, source.wrapT);
    sampler.mag = source.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ? shading::Filter::nearest : shading::Filter::linear;
    using enum shading::MipFilter;
    switch (source.minFilter) {
        case TINYGLTF_TEXTURE_FILTER_NEAREST:
            sampler.min = shading::Filter::nearest;
            sampler.mip = none;
            break;
        case TINYGLTF_TEXTURE_FILTER_LINEAR:
            sampler.mip = none;
            break;
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
            sampler.min = shading::Filter::nearest;
            sampler.mip = nearest;
            break;
        case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
            sampler.mip = nearest;
            break;
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
            sampler.min = shading::Filter::nearest;
            break;
        default:
            break;  // linear within and between levels, also where nothing is said
    }
    return sampler;
}

/// KHR_texture_transform: uv' = T R S uv, with rows R = [cos sin; -sin cos]: counter-clockwise as seen, where v points down.
/// differs: the shader in the extension's text, read column by column, has the transpose; its test model and its viewers have this one.
void apply_transform(const tinygltf::ExtensionMap& extensions, shading::TextureUse& use, int& uv_set) {
    constexpr const char* kName = "KHR_texture_transform";
    if (extensions.count(kName) == 0) return;
    const tinygltf::Value* offset = member(extensions, kName, "offset");
    const tinygltf::Value* scale = member(extensions, kName, "scale");
    const tinygltf::Value* rotation = member(extensions, kName, "rotation");
    const tinygltf::Value* tex_coord = member(extensions, kName, "texCoord");
    const double su = number_at(scale, 0, 1.0), sv = number_at(scale, 1, 1.0);
    const SinCos angle = sin_cos(rotation != nullptr && rotation->IsNumber() ? rotation->GetNumberAsDouble() : 0.0);
    use.row_u = {static_cast<float>(angle.cos * su), static_cast<float>(angle.sin * sv), static_cast<float>(number_at(offset, 0, 0.0))};
    use.row_v = {static_cast<float>(-angle.sin * su), static_cast<float>(angle.cos * sv), static_cast<float>(number_at(offset, 1, 0.0))};
    if (tex_coord != nullptr && tex_coord->IsInt()) uv_set = tex_coord->GetNumberAsInt();
}

class MaterialMaker {
public:
    MaterialMaker(Document& document, ImageStore& images) : document_(document), images_(images) {}

    shading::Material make(std::size_t index, bool with_textures) {
        const tinygltf::Material& source = document_.model.materials[index];
        where_ = fmt::format("materials[{}]", index);
        shading::Material material;
        material.name = source.name;
        const auto& base = source.pbrMetallicRoughness.baseColorFactor;
        material.base_color = {clamp01(base[0]), clamp01(base[1]), clamp01(base[2]), clamp01(base[3])};
        material.metallic = clamp01(source.pbrMetallicRoughness.metallicFactor);
        material.roughness = clamp01(source.pbrMetallicRoughness.roughnessFactor);
        const tinygltf::Value* strength = member(source.extensions, "KHR_materials_emissive_strength", "emissiveStrength");
        const double glow = strength != nullptr && strength->IsNumber() ? std::clamp(strength->GetNumberAsDouble(), 0.0, 1e18) : 1.0;
        const auto emissive = [&](std::size_t c) { return static_cast<float>(std::clamp(source.emissiveFactor[c], 0.0, 1.0) * glow); };
        material.emissive = {emissive(0), emissive(1), emissive(2)};
        material.normal_scale = static_cast<float>(std::clamp(source.normalTexture.scale, -1e6, 1e6));
        material.occlusion_strength = clamp01(source.occlusionTexture.strength);
        if (source.alphaMode == "MASK")
            material.alpha_mode = shading::AlphaMode::mask;
        else if (source.alphaMode == "BLEND")
            material.alpha_mode = shading::AlphaMode::blend;
        else if (source.alphaMode != "OPAQUE")
            document_.warn(fmt::format("{}.alphaMode: \"{}\" is unknown, drawn as OPAQUE", where_, printable(source.alphaMode, 40)));
        material.alpha_cutoff = static_cast<float>(std::clamp(source.alphaCutoff, 0.0, 1e6));
        material.double_sided = source.doubleSided;
        material.unlit = source.extensions.count("KHR_materials_unlit") != 0;
        own_lobe(source.extras, material);
        if (with_textures) {
            material.base_color_texture =
                use(source.pbrMetallicRoughness.baseColorTexture, "pbrMetallicRoughness.baseColorTexture", ColorSpace::srgb);
            material.emissive_texture = use(source.emissiveTexture, "emissiveTexture", ColorSpace::srgb);
            material.metallic_roughness_texture = use(source.pbrMetallicRoughness.metallicRoughnessTexture,
                                                      "pbrMetallicRoughness.metallicRoughnessTexture", ColorSpace::linear);
            material.normal_texture = use(source.normalTexture, "normalTexture", ColorSpace::linear);
            material.occlusion_texture = use(source.occlusionTexture, "occlusionTexture", ColorSpace::linear);
        }
        return material;
    }

private:
    template <class TextureInfo>
    shading::TextureUse use(const TextureInfo& info, const char* key, ColorSpace space) {
        shading::TextureUse use;
        if (info.index < 0) return use;
        const tinygltf::Texture& texture = document_.model.textures[static_cast<std::size_t>(info.index)];
        if (texture.source < 0) {
            document_.warn(fmt::format("textures[{}]: has no picture that can be read (source), left out", info.index));
            return use;
        }
        int uv_set = info.texCoord;
        apply_transform(info.extensions, use, uv_set);
        if (uv_set > 1) {
            document_.warn(fmt::format("{}.{}: texCoord {} is not supported (0 and 1 are), left out", where_, key, uv_set));
            return use;
        }
        use.uv_set = uv_set;
        use.sampler = sampler_of(document_, texture.sampler);
        use.texture = images_.texture_for(texture.source, space);
        return use;
    }

    /// extras.halflit = {"lobe": "sloan", "wrap": 0.5, "power": 1.5, "normalize": true}
    void own_lobe(const tinygltf::Value& extras, shading::Material& material) const {
        if (!extras.IsObject() || !extras.Has("halflit")) return;
        const std::string where = where_ + ".extras.halflit";
        const tinygltf::Value& own = extras.Get("halflit");
        if (!own.IsObject()) refuse(where, "expected an object");
        LobeParameters parameters;
        std::string name;
        for (const std::string& key : own.Keys()) {
            const tinygltf::Value& value = own.Get(key);
            if (key == "lobe" && value.IsString())
                name = value.Get<std::string>();
            else if (key == "wrap" && value.IsNumber())
                parameters.wrap = static_cast<float>(value.GetNumberAsDouble());
            else if (key == "power" && value.IsNumber())
                parameters.power = static_cast<float>(value.GetNumberAsDouble());
            else if (key == "normalize" && value.IsBool())
                parameters.normalize = value.Get<bool>();
            else
                refuse(where, fmt::format("\"{}\": expected lobe (a string), wrap, power (numbers) and normalize (true or false)",
                                          printable(key, 40)));
        }
        const auto lobe = lobe_from_name(name, parameters);
        if (!lobe) refuse(where, lobe.error().message);
        material.lobe = *lobe;
        material.has_own_lobe = true;
    }

    Document& document_;
    ImageStore& images_;
    std::string where_;
};

}  // namespace

std::vector<shading::Material> make_materials(Document& document, ImageStore& images, const std::vector<bool>& used) {
    MaterialMaker maker(document, images);
    std::vector<shading::Material> materials;
    materials.reserve(document.model.materials.size());
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) materials.push_back(maker.make(i, used[i]));
    return materials;
}

}  // namespace halflit::io::detail
