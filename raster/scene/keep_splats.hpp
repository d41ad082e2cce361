// Some of a mesh's splats.
#pragma once

#include "halflit/splats.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace halflit::raster {

/// Drops the splats i for which keep(i) is false, and their positions; the others keep their order. keep(i) is asked in order, and may read
/// the arrays at i and behind it.
template <class Keep>
void keep_splats(std::vector<Vec3f>& positions, Splats& s, const Keep& keep) {
    const std::size_t coefficients = harmonics_per_splat(s.degree), all = s.opacities.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < all; ++i) {
        if (!keep(i)) continue;
        if (kept != i) {
            positions[kept] = positions[i], s.rotations[kept] = s.rotations[i], s.scales[kept] = s.scales[i];
            s.opacities[kept] = s.opacities[i];
            std::copy_n(s.harmonics.begin() + static_cast<std::ptrdiff_t>(coefficients * i), coefficients,
                        s.harmonics.begin() + static_cast<std::ptrdiff_t>(coefficients * kept));
        }
        ++kept;
    }
    positions.resize(kept), s.rotations.resize(kept), s.scales.resize(kept), s.opacities.resize(kept);
    s.harmonics.resize(coefficients * kept);
}

}  // namespace halflit::raster
