// The reference's integral over an environment.
#include "shading/reference/irradiance.hpp"
#include "sh/equirect.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

using namespace halflit;
using namespace halflit::shading;

TEST_CASE("reference: under a uniform sky a normalised lobe gets the sky's light, up to the sharpest power that is resolved",
          "[shading][environment]") {
    const std::vector<float> rgb(std::size_t{3} * 64 * 32, 0.5f);
    EnvironmentOptions options;
    options.keep_light = true;
    options.extract_suns = false;
    const Environment sky = shading::make_environment(sh::EquirectView{64, 32, rgb}, options);
    const reference::DirectIrradiance light(sky, Lobe::mcauley(0.0f, reference::kSharpestIntegrated));
    double worst = 0;
    for (int i = 0; i <= 40; ++i)
        for (int j = 0; j < 8; ++j) {
            const double polar = kPi * i / 40, turn = 2 * kPi * j / 8 + 0.1;
            const Vec3d normal{std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn)};
            worst = std::max(worst, std::fabs(light.at(normal).x / 0.5 - 1));
        }
    INFO("off by " << worst);
    CHECK(worst < 2e-5);
    CHECK(worst > 0);
}

TEST_CASE("reference: the integral over an image is that of its constant pixels, however few they are", "[shading][environment]") {
    double worst[3] = {0, 0, 0};
    int size = 0;
    for (const auto& [width, height] : {std::pair{8, 2}, {64, 32}, {256, 128}}) {
        std::vector<float> rgb;
        std::uint32_t state = 7;
        for (int i = 0; i < 3 * width * height; ++i) {
            state = state * 1664525u + 1013904223u;
            rgb.push_back(static_cast<float>(state >> 8) * 0x1p-24f * ((state & 63u) == 0 ? 20.0f : 1.0f));
        }
        EnvironmentOptions options;
        options.keep_light = true;
        options.extract_suns = false;
        const sh::EquirectView image{width, height, rgb};
        const Environment sky = shading::make_environment(image, options);
        constexpr int kColumns = 2048, kRows = 1024;
        const Lobe lobes[] = {Lobe::lambert(), Lobe::sloan(0.5f), Lobe::valve()};
        Vec3d normals[6];
        for (int i = 0; i < 6; ++i) {
            const double polar = 0.3 + 0.41 * i, turn = 1.7 * i;
            normals[i] = {std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn)};
        }
        double sums[3][6] = {}, most = 0;
        for (int y = 0; y < kRows; ++y) {
            const double solid = 2 * kPi / kColumns * (std::cos(kPi * y / kRows) - std::cos(kPi * (y + 1) / kRows));
            for (int x = 0; x < kColumns; ++x) {
                const Vec3d from = sh::equirect_direction((x + 0.5) / kColumns, (y + 0.5) / kRows);
                const double radiance = image.at(x * width / kColumns, y * height / kRows).x;
                for (int l = 0; l < 3; ++l)
                    for (int i = 0; i < 6; ++i)
                        sums[l][i] += radiance * solid / kPi * reference::lobe_value(lobes[l], dot(from, normals[i]));
                most = std::max(most, radiance);
            }
        }
        for (int l = 0; l < 3; ++l) {
            const reference::DirectIrradiance light(sky, lobes[l]);
            for (int i = 0; i < 6; ++i) worst[size] = std::max(worst[size], std::fabs(light.at(normals[i]).x - sums[l][i]) / most);
        }
        ++size;
    }
    INFO("off by " << worst[0] << ", " << worst[1] << ", " << worst[2] << " of the largest value");
    CHECK(worst[0] < 2e-6);
    CHECK(worst[1] < 2e-6);
    CHECK(worst[2] < 2e-6);
}
