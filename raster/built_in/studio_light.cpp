#include "raster/built_in/studio_light.hpp"

#include "halflit/scene.hpp"
#include "shading/environment.hpp"

namespace halflit::raster {

shading::ImageLightParts computed_studio_parts() {
    EnvironmentImage image = studio_image();
    const sh::Projection projection(shading::view_of(image));
    const sh::BandGrid grid(projection);
    shading::ImageLightParts parts;
    parts.radiance = projection.radiance();
    constexpr sh::WrapLobe kLobes[kStudioLobes] = {{0.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, {1.0, 2.0, 1.0}};  // Lambert, half-Lambert, Valve
    for (const sh::WrapLobe& lobe : kLobes)
        parts.lobes.push_back({lobe, grid.order_bounds(sh::lobe_spectrum(lobe)), shading::band_errors(parts.radiance, lobe), {}});
    parts.reflections = shading::make_reflection_map(shading::view_of(image), shading::in_turn);
    parts.width = image.width, parts.height = image.height;
    parts.rgb = std::move(image.rgb);
    return parts;
}

}  // namespace halflit::raster
