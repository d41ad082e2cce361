// Bounds on the float32 error of a filtered texel.
#pragma once

#include "shading/plan/plan.hpp"

namespace halflit::shading {

/// Largest error of channel c, whose range is 0 to 1, against filtering the texels that the texture was made from, not rounded to 16 bits,
/// in exact arithmetic from the same float32 coordinates. These are within +-largest_uv. Cases where the last bit decides which texel or
/// level is the nearest are not counted. measured: false: the rounding to 16 bits counts as the most that it may be, about half a unit a
/// level, instead of what it is, which takes as long as making the texture.
[[nodiscard]] double filter_error(const TexturePlan& texture, int c, double largest_uv, bool measured = true);

/// The least value of channel c in the whole texture.
[[nodiscard]] double least_value(const TexturePlan& texture, int c);

}  // namespace halflit::shading
