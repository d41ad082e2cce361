// How a shadow meets wrapped light.
#pragma once

#include <cstdint>

namespace halflit::shading {

/// What a shadow does to a light whose lobe f reaches round the terminator. V is visibility by the shadow map, x = N.L.
enum class ShadowMode : std::uint8_t {
    off,        ///< f
    hard,       ///< V f: a step of f(0) where the surface turns away from the light
    soft_split  ///< V core + W excess, core = min(f, max(0, x)), excess = f - core, W = max(V, T) for each texel; T: raster/README.md
};

}  // namespace halflit::shading
