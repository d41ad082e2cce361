#include "raster/passes/display_alpha.hpp"

#include "shading/model/srgb.hpp"

#include <algorithm>
#include <array>

namespace halflit::raster {
namespace {

constexpr int kGrey = 128;  ///< code of the background between black and white

constexpr std::array<double, 256> kLight = [] {
    std::array<double, 256> light{};
    for (std::size_t code = 0; code < 256; ++code) light[code] = shading::linear_from_srgb(static_cast<double>(code) / 255.0);
    return light;
}();

/// Code of light from 0 to 1, linear between whole codes.
double code_of(double light) {
    const auto above = std::clamp<std::ptrdiff_t>(std::upper_bound(kLight.begin(), kLight.end(), light) - kLight.begin(), 1, 255);
    const double low = kLight[static_cast<std::size_t>(above - 1)], high = kLight[static_cast<std::size_t>(above)];
    return static_cast<double>(above - 1) + std::min((light - low) / (high - low), 1.0);
}

std::uint8_t rounded(double code) { return static_cast<std::uint8_t>(std::clamp(code, 0.0, 255.0) + 0.5); }

}  // namespace

void set_display_alpha(std::uint8_t (&rgba)[4]) {
    if (rgba[3] == 0 || rgba[3] == 255) return;
    const double cover = rgba[3] / 255.0, through = 1.0 - cover;
    double over_white[3], sum = 0.0, most = 1.0;
    for (int c = 0; c < 3; ++c) {
        const double light = kLight[rgba[c]] * cover;
        over_white[c] = code_of(light + through);
        // Share of the background's code: by black it would be (white - black) / 255, by grey (white - grey) / (255 - 128).
        sum += (2.0 * over_white[c] - code_of(light)) - code_of(light + through * kLight[kGrey]);
        most = std::min(most, over_white[c] / 255.0);
    }
    const double alpha = 1.0 - std::min(sum / (3.0 * (255 + 255 - kGrey)), most);
    rgba[3] = rounded(255.0 * alpha);
    for (int c = 0; c < 3; ++c) rgba[c] = rgba[3] == 0 ? std::uint8_t{0} : rounded(255.0 + 255.0 * (over_white[c] - 255.0) / rgba[3]);
}

}  // namespace halflit::raster
