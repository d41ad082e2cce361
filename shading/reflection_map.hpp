// An environment as rough mirrors see it: blurred by lobes of eight widths.
#pragma once

#include "sh/equirect.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace halflit::shading {

/// Level k is the environment's radiance blurred by the lobe
///     h(t) ~ cos^4(t/2) / (cos^2(t/2) (a^2 - 1) + 1)^2,  a = kReflectionSharpest 2^k,
/// t being the angle to the direction. This is GGX's distribution of half vectors about a mirror seen straight on.
/// Level 0 is sharper than that: its a is 0.0049, that of kMinRoughness, blurred by the image's own pixels.
inline constexpr int kReflectionLevels = 8;
inline constexpr double kReflectionSharpest = 0.008;
inline constexpr int kMostReflectionRows = 512, kLeastReflectionRows = 32;

/// Each level has its values at the polar angles pi j / n, j = 0 .. n, and the longitudes pi i / n, i = 0 .. 2 n, of
/// sh::equirect_direction: both poles are rows of one value, and the last column repeats the first one. So the four values about any
/// direction are neighbours in memory, and the bilinear function through them is continuous everywhere. (A square that an octahedron
/// unfolds to needs no arc tangents, but its folds bend the function: up to 2 % of a cosine's range at these sizes.)
struct ReflectionMap {
    std::int32_t rows[kReflectionLevels];    ///< n
    std::int32_t first[kReflectionLevels];   ///< number of the level's first value; each row has 2 n + 1
    std::vector<std::array<float, 4>> rgba;  ///< linear radiance, and a number without a meaning
};

/// Runs body(0) .. body(count - 1), perhaps side by side.
using ForEachRow = std::function<void(int count, const std::function<void(int)>& body)>;
inline void in_turn(int count, const std::function<void(int)>& body) {
    for (int i = 0; i < count; ++i) body(i);
}

/// Blurs an image. Values above 1e30 count as that.
[[nodiscard]] ReflectionMap make_reflection_map(const sh::EquirectView& image, const ForEachRow& for_each_row);

}  // namespace halflit::shading
