#include "apps/io/gltf/build/choices.hpp"

#include "apps/io/files/text.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
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

int scene_index(const std::vector<std::string>& names, const std::string& wanted) {
    if (const int index = name_or_index(names, wanted); index >= 0) return index;
    if (names.empty()) refuse("", fmt::format("scene: the file has none, found '{}'", printable(wanted, 80)), ErrorCode::usage);
    refuse("",
           fmt::format("scene: expected an index below {} or a scene's name ({}), found '{}'", names.size(), list_of(names),
                       printable(wanted, 80)),
           ErrorCode::usage);
}

int variant_index(const std::vector<std::string>& names, const std::string& wanted) {
    if (const auto named = std::find(names.begin(), names.end(), wanted); named != names.end())
        return static_cast<int>(named - names.begin());
    if (names.empty()) refuse("", fmt::format("variant: the file has none, found '{}'", printable(wanted, 80)), ErrorCode::usage);
    refuse("", fmt::format("variant: expected one of {}, found '{}'", list_of(names), printable(wanted, 80)), ErrorCode::usage);
}

}  // namespace

void check_threads(const LoadOptions& options) {
    if (options.threads < 0) refuse("", fmt::format("threads is {}, expected at least 0", options.threads), ErrorCode::usage);
}

void check_pose_time(const LoadOptions& options) {
    if (!std::isfinite(options.time_s)) refuse("", fmt::format("time_s is {}, expected a finite number", options.time_s), ErrorCode::usage);
}

int name_or_index(const std::vector<std::string>& names, const std::string& wanted) {
    if (const auto named = std::find(names.begin(), names.end(), wanted); named != names.end())
        return static_cast<int>(named - names.begin());
    int index = -1;
    const char* const end = wanted.data() + wanted.size();
    const auto [stop, error] = std::from_chars(wanted.data(), end, index);
    const bool is_index = error == std::errc{} && stop == end && index >= 0 && static_cast<std::size_t>(index) < names.size();
    return is_index ? index : -1;
}

void choose_scene(Document& document) {
    file::File& file = document.file;
    std::vector<std::string>& names = document.info.scene_names;
    document.geometry.take(file.scenes.size() * sizeof(std::string));
    TimeCheck check;
    for (const file::Scene& scene : file.scenes) {
        check();
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

int choose_animation(const std::vector<std::string>& names, const std::string& wanted) {
    if (wanted == "none") return -1;
    if (wanted.empty()) return names.empty() ? -1 : 0;
    if (const int index = name_or_index(names, wanted); index >= 0) return index;
    if (names.empty()) refuse("", fmt::format("animation: the file has none, found '{}'", printable(wanted, 80)), ErrorCode::usage);
    refuse(
        "",
        fmt::format("animation: expected an index below {}, an animation's name or none, found '{}'", names.size(), printable(wanted, 80)),
        ErrorCode::usage);
}

void refuse_choices(const LoadOptions& options) {
    check_pose_time(options);
    (void)choose_animation({}, options.animation);
    if (!options.scene.empty()) (void)scene_index({""}, options.scene);
    if (!options.variant.empty()) (void)variant_index({}, options.variant);
}

}  // namespace halflit::io::detail
