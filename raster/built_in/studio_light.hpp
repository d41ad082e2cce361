// The studio's light, ready to use. It takes longer to make than a small picture to draw, so a program of the build makes it
// (make_studio_table.cpp) and writes it into a source file, unless that program cannot run where halflit is built.
#pragma once

#include "shading/image_light.hpp"

#include <cstddef>
#include <cstdint>

namespace halflit::raster {

/// Lobes of which the parts hold what is known.
inline constexpr std::size_t kStudioLobes = 3;

/// The light of studio_image().
[[nodiscard]] shading::ImageLightParts computed_studio_parts();

/// The same bits, from the table where there is one.
[[nodiscard]] shading::ImageLightParts studio_parts();

/// The table: the bits of all numbers, in the order of for_each_number().
extern const std::uint32_t kStudioSizes[], kStudioFloats[];
extern const std::uint64_t kStudioDoubles[];

/// Calls on_size with each number that the others' count depends on, then on_float and on_double with the others. make_room: called
/// between.
template <class Parts, class OnSize, class MakeRoom, class OnFloat, class OnDouble>
void for_each_number(Parts& parts, const OnSize& on_size, const MakeRoom& make_room, const OnFloat& on_float, const OnDouble& on_double) {
    on_size(parts.width), on_size(parts.height), on_size(parts.radiance.bands);
    for (auto& rows : parts.reflections.rows) on_size(rows);
    for (auto& first : parts.reflections.first) on_size(first);
    make_room();
    for (auto& value : parts.rgb) on_float(value);
    for (auto& value : parts.reflections.rgba)
        for (auto& channel : value) on_float(channel);
    const auto on_vector = [&](auto& v) { on_double(v.x), on_double(v.y), on_double(v.z); };
    for (auto& coefficient : parts.radiance.c) on_vector(coefficient);
    for (auto& [lobe, bounds, errors, map] : parts.lobes) {
        on_double(lobe.wrap), on_double(lobe.power), on_double(lobe.scale);
        for (auto& bound : bounds->by_order) on_vector(bound);
        for (auto& bound : errors->absolute) on_vector(bound);
        for (auto& share : errors->relative) on_double(share);
        on_vector(errors->least), on_vector(bounds->beyond);
    }
}

}  // namespace halflit::raster
