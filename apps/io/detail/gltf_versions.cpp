#include "apps/io/detail/gltf_versions.hpp"

#include "apps/io/detail/load_failure.hpp"
#include "apps/io/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <utility>

namespace halflit::io::detail {

namespace {

/// Extensions that a file may require. Their values are read; for quantised data, the reading of accessors covers it.
constexpr std::string_view kSupportedExtensions[] = {"KHR_lights_punctual", "KHR_materials_unlit", "KHR_texture_transform",
                                                     "KHR_materials_emissive_strength", "KHR_mesh_quantization"};

/// "2.0" as {2, 0}.
std::optional<std::pair<int, int>> parse_version(std::string_view text) {
    std::pair<int, int> v;
    const char* end = text.data() + text.size();
    const auto major = std::from_chars(text.data(), end, v.first);
    if (major.ec != std::errc{} || major.ptr == end || *major.ptr != '.') return std::nullopt;
    const auto minor = std::from_chars(major.ptr + 1, end, v.second);
    if (minor.ec != std::errc{} || minor.ptr != end || v.first < 0 || v.second < 0) return std::nullopt;
    return v;
}

}  // namespace

void check_versions(const file::File& file) {
    const auto version = parse_version(file.version);
    if (!version) refuse("asset.version", fmt::format("expected \"2.0\", found \"{}\"", printable(file.version, 20)));
    if (!file.min_version.empty()) {
        const auto min_version = parse_version(file.min_version);
        if (!min_version) refuse("asset.minVersion", fmt::format("expected \"2.0\", found \"{}\"", printable(file.min_version, 20)));
        if (*min_version > std::pair(2, 0))
            refuse("asset.minVersion", fmt::format("the file needs glTF {}, expected at most 2.0", printable(file.min_version, 20)));
    }
    if (version->first != 2) refuse("asset.version", fmt::format("expected glTF 2, found \"{}\"", printable(file.version, 20)));
    for (const std::string_view name : file.extensions_required) {
        if (std::find(std::begin(kSupportedExtensions), std::end(kSupportedExtensions), name) != std::end(kSupportedExtensions)) continue;
        const char* hint = name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression"
                               ? " (compressed geometry; save the model without it)"
                               : "";
        refuse("extensionsRequired", fmt::format("\"{}\" is not supported{}", printable(name, 80), hint));
    }
}

}  // namespace halflit::io::detail
