// Procedural pictures for textures.
#pragma once

#include "bench/peer/scenes.hpp"

namespace halflit::peer {

/// Waves in each channel with noise over them, sRGB.
[[nodiscard]] Picture colour_picture(int side);

/// Normals of a surface of gentle waves.
[[nodiscard]] Picture normal_picture(int side);

}  // namespace halflit::peer
