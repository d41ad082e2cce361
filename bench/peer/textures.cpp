#include "bench/peer/textures.hpp"

#include "sh/trig.hpp"
#include "tests/support/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace halflit::peer {
namespace {

template <class TexelAt>
Picture picture_of(int side, const TexelAt& texel_at) {
    Picture picture{side, side, {}};
    picture.rgba8.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * 4);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            for (const double value : texel_at(x, y)) picture.rgba8.push_back(static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0)));
            picture.rgba8.push_back(255);
        }
    return picture;
}

}  // namespace

Picture colour_picture(int side) {
    test::Random random(3);
    const auto channel = [&](int x, int y, int c) { return 128 + 70 * sin_cos(0.05 * x * (c + 1) + 0.03 * y).sin + random.real(-25, 25); };
    return picture_of(side, [&](int x, int y) {
        const double red = channel(x, y, 0), green = channel(x, y, 1), blue = channel(x, y, 2);
        return std::array<double, 3>{red, green, blue};
    });
}

Picture normal_picture(int side) {
    return picture_of(side, [](int x, int y) {
        const double a = 0.25 * sin_cos(0.11 * x + 0.02 * y).sin, b = 0.25 * sin_cos(0.09 * y).cos;
        const double half = 127.5 / std::sqrt(1 + a * a + b * b);
        return std::array<double, 3>{127.5 + half * a, 127.5 + half * b, 127.5 + half};
    });
}

}  // namespace halflit::peer
