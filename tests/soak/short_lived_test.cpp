// Renderers that draw one frame each: their memory is given back.
#include "tests/raster/metamorphic_shots.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <fstream>
#include <string>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

double resident_mb() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024;
    return 0;
}

}  // namespace

TEST_CASE("soak: thousands of Renderers that draw one frame each keep no memory", "[soak]") {
    Shot shot = separate_bodies(7);
    shot.settings.shadows = ShadowMode::off;
    Pixels pixels;
    std::uint64_t expected = 0;
    int frames = 0;
    const auto draw = [&](int count) {
        const double before = resident_mb();
        for (int i = 0; i < count; ++i, ++frames) {
            Renderer renderer;
            const auto report =
                renderer.render(shot.scene, shot.camera, shot.settings, pixels.target(), execution_of(i % 2 * 2, 16, *default_isa()));
            REQUIRE(report);
            const std::uint64_t hash = pixel_hash(pixels.rgba8);
            if (expected == 0) expected = hash;
            REQUIRE(hash == expected);
        }
        return resident_mb() - before;
    };
    (void)draw(200);
    double least = 1e9;  // the allocator may take more once
    for (int round = 0; round < 3; ++round) least = std::min(least, draw(1000));
    INFO(frames << " frames");
    CHECK(least < 2.0);  // measured -0.7 to 0
}
