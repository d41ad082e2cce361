#include "bench/peer/compare.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace halflit::peer {

void PictureDifference::add(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
    for (std::size_t i = 0; i + 3 < a.size(); i += 4) {
        int most = 0;
        for (std::size_t c = i; c < i + 4; ++c) most = std::max(most, std::abs(int{a[c]} - int{b[c]}));
        largest = std::max(largest, most);
        above_2 += most > 2;
        ++pixels;
    }
}

Spread spread_of(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {  // interpolated between neighbours
        const double place = share * static_cast<double>(values.size() - 1);
        const auto low = static_cast<std::size_t>(place);
        const std::size_t high = std::min(low + 1, values.size() - 1);
        return values[low] + (place - static_cast<double>(low)) * (values[high] - values[low]);
    };
    return {values[0], at(0.25), at(0.5), at(0.75)};
}

}  // namespace halflit::peer
