// The box around what lies closely together, without a little that is far away.
#pragma once

#include "raster/detail/view_math.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace halflit::raster {

/// A box in double; empty while low > high.
struct WideBox {
    double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
    void add(const WideBox& other) {
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], other.low[k]);
            high[k] = std::max(high[k], other.high[k]);
        }
    }
    [[nodiscard]] bool empty() const { return low[0] > high[0]; }
    [[nodiscard]] double radius() const {
        const double x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
        return empty() ? 0.0 : 0.5 * __builtin_sqrt((x * x + y * y) + z * z);
    }
    [[nodiscard]] WideBox widened(double by) const {
        WideBox out = *this;
        for (int k = 0; k < 3; ++k) out.low[k] -= by, out.high[k] += by;
        return out;
    }
    [[nodiscard]] bool holds(const WideBox& other) const {
        bool inside = true;
        for (int k = 0; k < 3; ++k) inside &= other.low[k] >= low[k] && other.high[k] <= high[k];
        return inside;
    }
    [[nodiscard]] bool meets(const WideBox& other) const {
        bool meet = true;
        for (int k = 0; k < 3; ++k) meet &= other.low[k] <= high[k] && other.high[k] >= low[k];
        return meet;
    }
    [[nodiscard]] bool finite() const {
        bool all = true;
        for (int k = 0; k < 3; ++k) all &= high[k] - high[k] == 0.0 && low[k] - low[k] == 0.0;
        return all;
    }
};

/// Finds a box that holds all but a little of the weight, in which the items lie closely together. each(visit) calls visit(box, weight) for
/// each item; whole: around all items. Returns nothing if there is none below least_share of the whole's radius. Outliers at very different
/// distances need rounds: a bin of the farthest one's may hold all others.
template <class Each>
std::optional<WideBox> closest_box(const Each& each, const WideBox& whole, std::uint64_t allowed, double least_share) {
    constexpr int kBins = 256, kMostRounds = 8;
    WideBox kept = whole;
    bool found = false;
    for (int round = 0; round < kMostRounds; ++round) {
        std::array<std::array<std::uint64_t, kBins>, 3> first{}, last{};
        const auto bin = [&](double at, int k) {
            const double width = kept.high[k] - kept.low[k];
            return width > 0.0 ? std::clamp(static_cast<int>((at - kept.low[k]) / width * kBins), 0, kBins - 1) : 0;
        };
        std::uint64_t outside = 0;
        each([&](const WideBox& box, std::uint64_t weight) {
            if (!kept.holds(box)) {
                outside += weight;
                return;
            }
            for (int k = 0; k < 3; ++k) {
                const auto axis = static_cast<std::size_t>(k);
                first[axis][static_cast<std::size_t>(bin(box.low[k], k))] += weight;
                last[axis][static_cast<std::size_t>(bin(box.high[k], k))] += weight;
            }
        });
        if (outside > allowed) return std::nullopt;
        const std::uint64_t left = allowed - outside;
        WideBox trimmed;
        for (int k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            const double step = (kept.high[k] - kept.low[k]) / kBins;
            std::size_t low = 0, high = kBins - 1;
            for (std::uint64_t sum = first[axis][0]; sum <= left && low + 1 < kBins; sum += first[axis][low]) ++low;
            for (std::uint64_t sum = last[axis][kBins - 1]; sum <= left && high > 0; sum += last[axis][high]) --high;
            trimmed.low[k] = low == 0 ? kept.low[k] : kept.low[k] + step * (static_cast<double>(low) - 1e-6);
            trimmed.high[k] = high == kBins - 1 ? kept.high[k] : kept.low[k] + step * (static_cast<double>(high + 1) + 1e-6);
            if (trimmed.low[k] > trimmed.high[k]) return found ? std::optional(kept) : std::nullopt;
        }
        std::uint64_t left_out = 0;
        const auto around_items_in = [&](const WideBox& outer) {
            WideBox box;
            left_out = 0;
            each([&](const WideBox& item, std::uint64_t weight) {
                if (outer.holds(item))
                    box.add(item);
                else
                    left_out += weight;
            });
            return box;
        };
        WideBox inside = around_items_in(trimmed);
        if (inside.empty() || !(inside.radius() < least_share * kept.radius())) break;
        // Trimming cuts off what is outermost, stray or not. What lies near the box belongs to it.
        for (int k = 0; k < kMostRounds; ++k) {
            const WideBox grown = around_items_in(inside.widened(inside.radius()));
            if (inside.holds(grown)) break;
            inside = grown;
        }
        if (left_out > allowed || !(inside.radius() < least_share * kept.radius())) break;
        kept = inside;
        found = true;
    }
    return found && kept.radius() < least_share * whole.radius() ? std::optional(kept) : std::nullopt;
}

}  // namespace halflit::raster
