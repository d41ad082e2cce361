// The reference's integral over an environment.
#include "shading/reference/irradiance.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
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
    CHECK(worst < 2e-3);
    CHECK(worst > 0);
}
