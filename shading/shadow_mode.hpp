// Shadow modes: the effect of a shadow on wrapped light.
#pragma once

#include <cstdint>

namespace halflit::shading {

/// Effect of a shadow on light through a lobe f that reaches past the terminator, where x = N.L = 0. V is the visibility by the shadow map.
enum class ShadowMode : std::uint8_t {
    off,        ///< f
    hard,       ///< V f: a step of f(0) where the surface turns away from the light
    soft_split  ///< V core + W excess, core = min(f, max(0, x)), excess = f - core, W = max(V, T) for each texel; T: raster/README.md
};

}  // namespace halflit::shading
