#include "apps/io/gltf/file/versions.hpp"
#include "apps/io/files/optional_libraries.hpp"

#include "apps/io/files/load_failure.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/gltf/text/glb_container.hpp"
#include "sh/time_limit.hpp"
#include "shading/material_properties.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

namespace halflit::io::detail {

namespace {

/// Extensions that a file may require, beside those of the table of materials. Their values are read; for quantised data, the reading of
/// accessors covers it.
constexpr std::string_view kSupportedExtensions[] = {"KHR_lights_punctual",
                                                     "KHR_materials_unlit",
                                                     "KHR_texture_transform",
                                                     "KHR_materials_emissive_strength",
                                                     "KHR_materials_ior",
                                                     "KHR_mesh_quantization",
                                                     "KHR_materials_pbrSpecularGlossiness",
                                                     "KHR_animation_pointer",
                                                     "KHR_node_visibility",
                                                     "KHR_materials_variants",
                                                     "EXT_mesh_gpu_instancing",
                                                     "KHR_gaussian_splatting",
                                                     "KHR_gaussian_splatting_compression_spz",
                                                     "KHR_gaussian_splatting_compression_spz_2"};

/// "2.0" as {2, 0}; unless strict, "2" too.
std::optional<std::pair<int, int>> parse_version(std::string_view text, bool strict) {
    std::pair<int, int> v;
    const char* end = text.data() + text.size();
    const auto major = std::from_chars(text.data(), end, v.first);
    if (major.ec == std::errc{} && major.ptr == end && !strict) return v;
    if (major.ec != std::errc{} || major.ptr == end || *major.ptr != '.') return std::nullopt;
    const auto minor = std::from_chars(major.ptr + 1, end, v.second);
    if (minor.ec != std::errc{} || minor.ptr != end || v.first < 0 || v.second < 0) return std::nullopt;
    return v;
}

/// An extension that needs a library, which a build may lack.
struct Decoder {
    std::string_view extension;
    const char* library;
    bool (*is_there)();
    bool is_of_pictures = false;  ///< without it, surfaces are drawn plain
};
constexpr Decoder kDecoders[] = {
    {"EXT_meshopt_compression", "meshoptimizer", has_meshopt}, {"EXT_texture_webp", "libwebp", has_webp, true},
    {"KHR_draco_mesh_compression", "Draco", has_draco},        {"KHR_meshopt_compression", "meshoptimizer", has_meshopt},
    {"KHR_texture_basisu", "libzstd", has_ktx2, true},
};

const Decoder* decoder_of(std::string_view name) {
    const auto* found = std::find_if(std::begin(kDecoders), std::end(kDecoders), [&](const Decoder& d) { return d.extension == name; });
    return found == std::end(kDecoders) ? nullptr : found;
}

struct LeftOut {
    std::string_view extension;
    const char* what;  // is not drawn
};

/// Extensions whose data are ignored, and what the picture lacks for it.
constexpr LeftOut kLeftOut[] = {
    {"EXT_lights_image_based", "its environment is left out"},
    {"EXT_mesh_manifold", "nothing is left out of the picture"},
    {"EXT_meshopt_compression", "the data without compression are drawn"},
    {"EXT_texture_avif", "the pictures of other formats are drawn"},
    {"EXT_texture_webp", "the pictures of other formats are drawn"},
    {"KHR_draco_mesh_compression", "the data without compression are drawn"},
    {"KHR_meshopt_compression", "the data without compression are drawn"},
    {"KHR_texture_basisu", "the pictures of other formats are drawn"},
    {"KHR_xmp_json_ld", "nothing is left out of the picture"},
    {"MSFT_lod", "the finest level is drawn"},
    {"MSFT_texture_dds", "the pictures of other formats are drawn"},
    {"VRM", "the avatar is drawn with its plain materials, as it stands"},
    {"VRMC_materials_mtoon", "the plain materials are drawn"},
    {"VRMC_springBone", "nothing swings"},
    {"VRMC_vrm", "the avatar is drawn as it stands"},
};

}  // namespace

void choose_forms(file::File& file) {
    for (file::Texture& texture : file.textures) {
        if (has_ktx2() && texture.basisu >= 0) texture.source = texture.basisu;
        if (has_webp() && texture.webp >= 0) texture.source = texture.webp;
    }
    if (!has_meshopt())
        for (file::BufferView& view : file.buffer_views) view.compressed = -1;
    if (!has_draco())
        for (file::Mesh& mesh : file.meshes)
            for (file::Primitive& primitive : mesh.primitives) primitive.draco = -1;
}

bool is_supported(std::string_view extension) {
    if (const Decoder* decoder = decoder_of(extension)) return decoder->is_there();
    const auto has = [&](const shading::MaterialNumber& number) { return shading::extension_of(number.gltf) == extension; };
    return std::find(std::begin(kSupportedExtensions), std::end(kSupportedExtensions), extension) != std::end(kSupportedExtensions) ||
           (!extension.empty() && std::any_of(std::begin(shading::kMaterialNumbers), std::end(shading::kMaterialNumbers), has));
}

void check_versions(const file::File& file, bool strict) {
    if (file.version == "1" || file.version.starts_with("1.") || (file.version.empty() && file.has_dictionaries))
        refuse("asset.version", kIsFirstVersion);
    if (file.version.empty() && !strict) return;  // warned of
    const auto version = parse_version(file.version, strict);
    if (!version) refuse("asset.version", fmt::format("expected \"2.0\", found \"{}\"", printable(file.version, 20)));
    if (!file.min_version.empty()) {
        const auto min_version = parse_version(file.min_version, strict);
        if (!min_version) refuse("asset.minVersion", fmt::format("expected \"2.0\", found \"{}\"", printable(file.min_version, 20)));
        if (*min_version > std::pair(2, 0))
            refuse("asset.minVersion", fmt::format("the file needs glTF {}, expected at most 2.0", printable(file.min_version, 20)));
    }
    if (version->first != 2) refuse("asset.version", fmt::format("expected glTF 2, found \"{}\"", printable(file.version, 20)));
    TimeCheck check;
    for (const std::string_view name : file.extensions_required) {
        check();
        if (is_supported(name)) continue;
        std::string hint;
        const Decoder* decoder = decoder_of(name);
        if (!strict && (decoder == nullptr || decoder->is_of_pictures))
            continue;  // what it adds to the picture is left out, with a warning
        if (decoder != nullptr) hint = fmt::format(": it needs the library {}, which this build lacks", decoder->library);
        refuse("extensionsRequired", fmt::format("\"{}\" is not supported{}", printable(name, 80), hint));
    }
}

void check_extensions(Document& document) {
    const file::File& file = document.file;
    TimeCheck check;
    std::set<std::string_view> used;
    for (const std::string_view name : file.extensions_used) {
        check();
        used.insert(name);
    }
    for (const std::string_view name : used) {
        check();
        if (is_supported(name)) continue;
        const auto* row = std::find_if(std::begin(kLeftOut), std::end(kLeftOut), [&](const LeftOut& one) { return one.extension == name; });
        const char* const what = row != std::end(kLeftOut)            ? row->what
                                 : name.starts_with("KHR_materials_") ? "surfaces are drawn without it"
                                                                      : nullptr;
        document.warn(what != nullptr ? fmt::format("extensionsUsed: {} is not supported, {}", printable(name, 80), what)
                                      : fmt::format("extensionsUsed: {} is not known, ignored", printable(name, 80)));
    }
    for (std::size_t i = 0; i < file.extensions_required.size(); ++i)
        if (const std::string_view name = file.extensions_required[i]; check(), !is_supported(name))
            document.warn(fmt::format("extensionsRequired[{}]: {} is not supported, drawn without it", i, printable(name, 80)));
        else if (!used.contains(name))
            document.warn(fmt::format("extensionsRequired[{}]: {} is not in extensionsUsed, read as if it were", i, printable(name, 80)));
}

}  // namespace halflit::io::detail
