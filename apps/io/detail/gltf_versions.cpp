#include "apps/io/detail/gltf_versions.hpp"

#include "apps/io/detail/json_scan.hpp"
#include "apps/io/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <utility>

namespace halflit::io::detail {

namespace {

/// Extensions that a file may require. What they change is either read or, for quantised data, part of how accessors are read.
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

void check_versions(std::string_view version_text, std::string_view min_version_text, const std::vector<std::string>& extensions_required) {
    const auto refuse = [](std::string what) { throw JsonFault{ErrorCode::bad_input, std::string_view::npos, std::move(what)}; };
    const auto version = parse_version(version_text);
    if (!version) refuse(fmt::format("asset.version: expected \"2.0\", found \"{}\"", printable(version_text, 20)));
    if (!min_version_text.empty()) {
        const auto min_version = parse_version(min_version_text);
        if (!min_version) refuse(fmt::format("asset.minVersion: expected \"2.0\", found \"{}\"", printable(min_version_text, 20)));
        if (*min_version > std::pair(2, 0))
            refuse(fmt::format("asset.minVersion: the file needs glTF {}, expected at most 2.0", printable(min_version_text, 20)));
    }
    if (version->first != 2) refuse(fmt::format("asset.version: expected glTF 2, found \"{}\"", printable(version_text, 20)));
    for (const std::string& name : extensions_required) {
        if (std::find(std::begin(kSupportedExtensions), std::end(kSupportedExtensions), name) != std::end(kSupportedExtensions)) continue;
        const char* hint = name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression"
                               ? " (compressed geometry; save the model without it)"
                               : "";
        refuse(fmt::format("extensionsRequired: \"{}\" is not supported{}", printable(name, 80), hint));
    }
}

}  // namespace halflit::io::detail
