#include "raster/scene/grounds.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::raster {
namespace {

constexpr double kLeastShare = 1.0 / 16.0;  ///< of the whole's radius
constexpr double kFlat = 0.01;              ///< height of a ground over its width

double radius_of(const PlacedTriangles& box) {
    const double x = box.high[0] - box.low[0], y = box.high[1] - box.low[1], z = box.high[2] - box.low[2];
    return box.low[0] > box.high[0] ? 0.0 : 0.5 * std::sqrt((x * x + y * y) + z * z);
}

}  // namespace

std::vector<std::size_t> grounds_of(const std::vector<PlacedTriangles>& all) {
    std::vector<std::size_t> grounds;
    std::vector<bool> left_out(all.size(), false);
    while (grounds.size() + 1 < all.size()) {
        // The box around all others but one that is left out.
        const auto around = [&](std::size_t without) {
            PlacedTriangles sum{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}, 0};
            for (std::size_t i = 0; i < all.size(); ++i) {
                if (left_out[i] || i == without) continue;
                for (int k = 0; k < 3; ++k) {
                    sum.low[k] = std::min(sum.low[k], all[i].low[k]);
                    sum.high[k] = std::max(sum.high[k], all[i].high[k]);
                }
                sum.triangles += all[i].triangles;
            }
            return sum;
        };
        std::size_t largest = all.size();
        for (std::size_t i = 0; i < all.size(); ++i)
            if (!left_out[i] && (largest == all.size() || radius_of(all[i]) > radius_of(all[largest]))) largest = i;
        const PlacedTriangles &ground = all[largest], rest = around(largest);
        const double width = std::max(ground.high[0] - ground.low[0], ground.high[2] - ground.low[2]);
        if (!(radius_of(rest) < kLeastShare * radius_of(around(all.size()))) || !(ground.high[1] - ground.low[1] <= kFlat * width) ||
            ground.triangles >= rest.triangles || !(ground.high[1] <= 0.5 * (rest.low[1] + rest.high[1])))
            break;
        left_out[largest] = true;
        grounds.push_back(largest);
    }
    return grounds;
}

}  // namespace halflit::raster
