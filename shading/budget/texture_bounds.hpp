// Bounds on the float32 error of a filtered texel.
#pragma once

#include "shading/plan/plan.hpp"

namespace halflit::shading {

/// Knowledge about texels that a bound may use.
struct TexelFacts {
    enum class Measured : std::uint8_t {
        nothing,  ///< neighbours may be 0 and 1, and each level rounded by half a unit of 16 bits
        ranges,   ///< least and largest values, and steps between neighbours: a reading of the texels
        all       ///< the rounding to 16 bits too: as long as making the texture
    };
    Measured measured = Measured::all;
    double largest_uv = 0.0;  ///< the largest texture coordinate; needed where texture coordinates are transformed
};

/// Largest error of channel c, whose range is 0 to 1, against filtering the texels that the texture was made from, not rounded to 16 bits,
/// in exact arithmetic from the same float32 coordinates. Cases where the last bit decides which texel or level is the nearest are not
/// counted.
[[nodiscard]] double filter_error(const TexturePlan& texture, int c, const TexelFacts& facts);

/// The least value of channel c in the whole texture.
[[nodiscard]] double least_value(const TexturePlan& texture, int c, const TexelFacts& facts);

}  // namespace halflit::shading
