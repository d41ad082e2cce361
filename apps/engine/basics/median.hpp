// Median of measured times.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace halflit::engine {

/// The middle value, or the mean of the two in the middle. Requires: not empty.
inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

}  // namespace halflit::engine
