// Shadow maps of a frame, and the views that they are drawn from.
#pragma once

#include "halflit/mesh.hpp"
#include "halflit/settings.hpp"
#include "raster/scene/prepared_data.hpp"
#include "raster/view/shadow_cut.hpp"
#include "raster/view/view.hpp"
#include "shading/plan/light_plan.hpp"
#include "shading/plan/shadow_map_plan.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace halflit::raster {

/// View of one face of a map, and the constants that turn its depths into distances.
struct ShadowView {
    View view;
    bool perspective = false;
    float near_z = 0, far_z = 0;  ///< planes of its camera
    std::size_t first_texel = 0;  ///< index of its first texel in those of all maps
    std::size_t first_wide = 0;   ///< the same of the widest filter's (ShadowMapPlan::wide), if there is a penumbra
    bool penumbra = false;
    bool sees_casters = true;  ///< false: nothing that casts a shadow is in view, or nothing that one falls on, and nothing is drawn
    friend bool operator==(const ShadowView&, const ShadowView&) = default;
};

struct ShadowViews {
    std::vector<shading::ShadowMapPlan> maps;  ///< without the pointers to their texels
    std::vector<std::size_t> first_texel;      ///< per map: index of its first texel
    std::vector<std::size_t> first_wide;       ///< per map: index of its first texel of the widest filter, in those of all maps
    std::vector<std::int32_t> map_of_light;    ///< per light: its map, the finest of its cascades, or -1
    std::vector<ShadowView> views;             ///< in the order of the maps; a cube has six
    std::size_t texel_count = 0, wide_count = 0;
    [[nodiscard]] std::size_t bytes() const { return (texel_count + wide_count) * sizeof(float); }
    std::string warning;  ///< says that maps were made smaller; empty: they were not
};

/// Sides of maps are multiples of it.
inline constexpr int kShadowSizeStep = 64;
/// Sides of a frame's maps, texels.
struct ShadowSizes {
    int most = 2048;
    double texel_px = 0;  ///< width of a texel in the picture where that is enough, pixels; 0: all maps have `most`
};
inline constexpr int kLeastShadowSize = 256;  ///< of maps sized by pixels
[[nodiscard]] ShadowSizes shadow_sizes(const Settings& settings, int width_px, int height_px);
[[nodiscard]] constexpr int halved_shadow_size(int size) {
    return size < 2 * kShadowSizeStep ? kShadowSizeStep : size / 2 / kShadowSizeStep * kShadowSizeStep;
}

/// Plans a map for every light that reaches the scene's bounds and that something casts a shadow of, fitted to the casters: directional
/// maps, and those of point lights that see all of them within 127 degrees. Spots see no more than their cone. Other points, and spots
/// beyond 75 degrees, get six faces of half the size, unless one cut view shows all that the picture needs. The largest are halved until
/// all fit Settings::shadow_memory_limit. seen: the volume that the picture shows. Maps cover no more than it, casters whose shadows
/// cannot fall into it are left out, and directional lights get finer maps near the camera where these gain enough (shadow_cascades.hpp).
/// Null: maps cover the whole scene, and have ShadowSizes::most.
[[nodiscard]] Result<ShadowViews> plan_shadow_views(std::span<const shading::LightPlan> lights, const PreparedData& scene,
                                                    const SeenVolume* seen, const Settings& settings, const ShadowSizes& sizes);

/// Appends the maps of one list of views to another one. Returns the number of maps before.
std::size_t append(ShadowViews& to, ShadowViews&& more);

}  // namespace halflit::raster
