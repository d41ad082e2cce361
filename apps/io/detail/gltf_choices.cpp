#include "apps/io/detail/gltf_choices.hpp"

#include "apps/io/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <vector>

namespace halflit::io::detail {

namespace {

constexpr std::size_t kMostNamed = 20;  ///< names in a message

std::string list_of(const std::vector<std::string>& names) {
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), kMostNamed); ++i)
        list += fmt::format("{}'{}'", i == 0 ? "" : ", ", printable(names[i], 80));
    if (names.size() > kMostNamed) list += fmt::format(" and {} more", names.size() - kMostNamed);
    return list;
}

/// Position of a name; -1: not there.
int find_name(const std::vector<std::string>& names, const std::string& wanted) {
    const auto found = std::find(names.begin(), names.end(), wanted);
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

int scene_index(const std::vector<std::string>& names, const std::string& wanted) {
    if (const int named = find_name(names, wanted); named >= 0) return named;
    int index = -1;
    const char* const end = wanted.data() + wanted.size();
    const auto [stop, error] = std::from_chars(wanted.data(), end, index);
    if (error == std::errc{} && stop == end && index >= 0 && static_cast<std::size_t>(index) < names.size()) return index;
    if (names.empty()) refuse("", fmt::format("scene: the file has none, expected '{}'", printable(wanted, 80)), ErrorCode::usage);
    refuse("",
           fmt::format("scene: expected an index below {} or a scene's name ({}), found '{}'", names.size(), list_of(names),
                       printable(wanted, 80)),
           ErrorCode::usage);
}

int variant_index(const std::vector<std::string>& names, const std::string& wanted) {
    if (const int named = find_name(names, wanted); named >= 0) return named;
    if (names.empty()) refuse("", fmt::format("variant: the file has none, expected '{}'", printable(wanted, 80)), ErrorCode::usage);
    refuse("", fmt::format("variant: expected one of {}, found '{}'", list_of(names), printable(wanted, 80)), ErrorCode::usage);
}

}  // namespace

void choose_scene(Document& document) {
    file::File& file = document.file;
    std::vector<std::string>& names = document.info.scene_names;
    document.geometry.take(file.scenes.size() * sizeof(std::string));
    for (const file::Scene& scene : file.scenes) {
        document.geometry.take(scene.name.size());
        names.emplace_back(scene.name);
    }
    if (!document.options.scene.empty()) file.scene = scene_index(names, document.options.scene);
    document.info.scene = file.scenes.empty() ? -1 : std::max(file.scene, 0);
}

void choose_variant(Document& document) {
    file::File& file = document.file;
    std::vector<std::string>& names = document.info.variants;
    document.geometry.take(file.variants.size() * sizeof(std::string));
    for (const std::string_view name : file.variants) {
        document.geometry.take(name.size());
        names.emplace_back(name);
    }
    const int chosen = document.options.variant.empty() ? -1 : variant_index(names, document.options.variant);
    for (std::size_t m = 0; m < file.meshes.size(); ++m)
        for (std::size_t p = 0; p < file.meshes[m].primitives.size(); ++p) {
            file::Primitive& primitive = file.meshes[m].primitives[p];
            for (const file::VariantMaterial& mapping : primitive.variants)
                for (const int variant : mapping.variants) {
                    if (static_cast<std::size_t>(variant) >= names.size() && !document.warnings_are_full())
                        document.warn(
                            fmt::format("meshes[{}].primitives[{}].extensions.KHR_materials_variants: variant {}, but the file "
                                        "has {}; ignored",
                                        m, p, variant, names.size()));
                    if (variant == chosen) primitive.material = mapping.material;
                }
        }
}

void refuse_choices(const LoadOptions& options) {
    if (!options.scene.empty()) (void)scene_index({""}, options.scene);
    if (!options.variant.empty()) (void)variant_index({}, options.variant);
}

}  // namespace halflit::io::detail
