#include "raster/built_in/studio_light.hpp"

#include <bit>

namespace halflit::raster {

#ifdef HALFLIT_STUDIO_TABLE

shading::ImageLightParts studio_parts() {
    shading::ImageLightParts parts;
    const std::uint32_t *sizes = kStudioSizes, *floats = kStudioFloats;
    const std::uint64_t* doubles = kStudioDoubles;
    for_each_number(
        parts, [&](std::int32_t& size) { size = static_cast<std::int32_t>(*sizes++); },
        [&] {
            constexpr int kLast = shading::kReflectionLevels - 1;
            const std::int32_t rows = parts.reflections.rows[kLast];
            parts.rgb.resize(static_cast<std::size_t>(3 * parts.width * parts.height));
            parts.reflections.rgba.resize(static_cast<std::size_t>(parts.reflections.first[kLast] + (rows + 1) * (2 * rows + 1)));
            parts.lobes.resize(kStudioLobes, {{}, sh::OrderBounds{}, shading::BandErrors{}, {}});
        },
        [&](float& value) { value = std::bit_cast<float>(*floats++); }, [&](double& value) { value = std::bit_cast<double>(*doubles++); });
    return parts;
}

#else

shading::ImageLightParts studio_parts() { return computed_studio_parts(); }

#endif

}  // namespace halflit::raster
