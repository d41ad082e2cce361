// What float32 makes of a filtered texel, at most.
#pragma once

#include "shading/plan/plan.hpp"

namespace halflit::shading {

/// Largest error of channel c, of its range from 0 to 1, against filtering in exact arithmetic from the same float32 coordinates, where
/// these are within +-largest_uv. Not counted is where a nearest texel or a nearest level is another one by a last bit.
[[nodiscard]] double filter_error(const TexturePlan& texture, int c, double largest_uv);

/// The least that channel c is anywhere.
[[nodiscard]] double least_value(const TexturePlan& texture, int c);

}  // namespace halflit::shading
