// Shadows of lights with maps that are read without a filter: a surface asks one texel, so only the texels that are asked for are found.
#pragma once

#include "halflit/fixed_function.hpp"
#include "raster/passes/view_geometry.hpp"

#include <span>
#include <vector>

namespace halflit::raster {

/// A place in a light's map. hidden: -1 if a caster is nearer to the light.
struct MapPlace {
    std::int32_t x, y;  ///< texel; y down, as in all views
    float z;            ///< reversed depth
    std::int32_t hidden;
};

/// A fragment that has some of a light, and where it looks its shadow up.
struct ShadowLookup {
    std::uint32_t fragment, code;
    MapPlace place;
};

/// A light's map: the view that it is drawn from, and where surfaces look it up.
class LightMap {
public:
    explicit LightMap(const FixedLight& light);
    /// The place of a point of the world.
    [[nodiscard]] MapPlace of(Vec3f position_ws) const;
    /// The whole map.
    [[nodiscard]] const View& view() const { return view_; }

private:
    Mat4 clip_from_world_;
    View view_;
    float size_;
};

/// Finds which lookups are hidden. Lookups come in groups, of tiles of the picture.
class LightOcclusion {
public:
    Result<void> find(const PreparedData& casters, const LightMap& map, const ShadowRule& rule,
                      std::span<const std::span<ShadowLookup>> groups, const RasterKernels& kernels, Executor& executor);

private:
    ViewGeometry geometry_;
    std::vector<OcclusionTile> tiles_;          ///< one more at the end
    std::vector<std::int32_t> x_, y_, hidden_;  ///< of lookups by tile
    std::vector<float> z_;
    std::vector<std::uint32_t> place_;  ///< of each lookup, group after group
};

}  // namespace halflit::raster
