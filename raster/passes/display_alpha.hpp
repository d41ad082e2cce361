// Alpha for programs that blend codes, as browsers and most libraries do, in place of the share of light that a pixel covers.
#pragma once

#include <cstdint>

namespace halflit::raster {

/// Changes colour and alpha of a pixel with straight alpha. Over white, a blend of codes then has the codes that a blend of light has; over
/// black and over the code 128 it is as near as one alpha can be: within 4.5 codes for shadows up to 0.85. Opaque pixels and empty ones
/// stay.
void set_display_alpha(std::uint8_t (&rgba)[4]);

}  // namespace halflit::raster
