#include "apps/engine/pictures/picture_diff.hpp"

#include "sh/config.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace halflit::engine {

double PictureDiff::mean() const { return pixels == 0 ? 0.0 : static_cast<double>(sum) / (4.0 * static_cast<double>(pixels)); }

std::optional<double> PictureDiff::psnr() const {
    if (sum_squares == 0) return std::nullopt;
    const double mean_square = static_cast<double>(sum_squares) / (4.0 * static_cast<double>(pixels));
    return 10.0 * std::log10(255.0 * 255.0 / mean_square);
}

std::uint64_t PictureDiff::count_above(int codes) const {
    return std::accumulate(pixels_by_codes.begin() + std::clamp(codes + 1, 0, 256), pixels_by_codes.end(), std::uint64_t{0});
}

bool passes(const PictureDiff& diff, const DiffTolerance& tolerance) {
    return static_cast<double>(diff.count_above(tolerance.max_codes)) <= tolerance.max_share * static_cast<double>(diff.pixels);
}

PictureDiff compare_pictures(const Image& a, const Image& b) {
    HALFLIT_ASSERT(a.rgba8.size() == b.rgba8.size());
    PictureDiff diff;
    diff.pixels = a.rgba8.size() / 4;
    for (std::size_t i = 0; i < a.rgba8.size(); i += 4) {
        int largest = 0;
        for (std::size_t c = 0; c < 4; ++c) {
            const int difference = std::abs(a.rgba8[i + c] - b.rgba8[i + c]);
            largest = std::max(largest, difference);
            diff.sum += static_cast<std::uint64_t>(difference);
            diff.sum_squares += static_cast<std::uint64_t>(difference * difference);
        }
        diff.max = std::max(diff.max, largest);
        diff.count += largest > 0;
        ++diff.pixels_by_codes[static_cast<std::size_t>(largest)];
    }
    return diff;
}

Image difference_image(const Image& a, const Image& b) {
    HALFLIT_ASSERT(a.rgba8.size() == b.rgba8.size());
    std::vector<int> differences;
    differences.reserve(a.rgba8.size());
    for (std::size_t i = 0; i < a.rgba8.size(); ++i) differences.push_back(std::abs(a.rgba8[i] - b.rgba8[i]));
    const auto shown = [&](std::size_t pixel, std::size_t channel) { return differences[pixel + channel] + differences[pixel + 3]; };
    int largest = 1;
    for (std::size_t i = 0; i < differences.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, shown(i, c));
    Image image{a.width, a.height, {}, {}};
    image.rgba8.reserve(a.rgba8.size());
    for (std::size_t i = 0; i < differences.size(); i += 4) {
        for (std::size_t c = 0; c < 3; ++c) image.rgba8.push_back(static_cast<std::uint8_t>((shown(i, c) * 255 + largest / 2) / largest));
        image.rgba8.push_back(255);
    }
    return image;
}

}  // namespace halflit::engine
