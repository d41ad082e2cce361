// Loading of untrusted models under small limits, and what every loaded scene promises.
#pragma once

#include "tests/fuzz/target.hpp"

#include "halflit/gltf.hpp"

#include <span>

namespace halflit::fuzz {

inline std::span<const std::byte> as_bytes(View input) { return std::as_bytes(input); }

/// Limits that keep an execution within milliseconds.
inline LoadOptions small_limits(bool strict) {
    LoadOptions options;
    options.strict = strict;
    options.keep_animations = true;
    options.limits.max_total_bytes = std::size_t{4} << 20;
    options.limits.max_json_tokens = 100'000;
    options.limits.max_texture_bytes = std::size_t{1} << 20;
    options.limits.max_texture_side = 256;
    options.limits.max_texture_pixels = std::size_t{1} << 14;
    options.limits.max_geometry_bytes = std::uint64_t{8} << 20;
    options.limits.max_lights = 64;
    return options;
}

/// Arrays of equal length, indices in range, nodes that pose() accepts, and animations that pose_at() does.
void check_loaded(const LoadedScene& loaded);
/// One line of text that a terminal shows as it is.
void check_error(const Error& error);

}  // namespace halflit::fuzz
