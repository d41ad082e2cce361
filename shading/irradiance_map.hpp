// An environment's light through one lobe as a map, for environments that ten bands do not hold.
#pragma once

#include "sh/order.hpp"

#include <array>
#include <vector>

namespace halflit::shading {

/// Light that a white surface reflects, by its normal: the sum of 64 bands, summed in double. Laid out as a level of ReflectionMap: polar
/// angles pi j / rows, longitudes pi i / rows, i = 0 .. 2 rows.
struct IrradianceMap {
    int rows = 0;
    std::vector<std::array<float, 4>> rgba;  ///< never below 0; the fourth float is not used
    Vec3d error;                             ///< estimate of that of the bilinear function through the values, channel by channel
};

/// Has as many rows, 64 to 512, as keep the error of its steps below `tolerance`.
[[nodiscard]] IrradianceMap make_irradiance_map(const sh::Projection& environment, const sh::WrapLobe& lobe, double tolerance);

}  // namespace halflit::shading
