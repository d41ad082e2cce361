// A million instances, in bounded memory.
#include "halflit/prepared_scene.hpp"
#include "halflit/renderer.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>

using namespace halflit;
using namespace halflit::raster;

namespace {

/// Value of the line `name` in /proc/self/status, in bytes.
std::optional<std::uint64_t> status_bytes(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind(name + ":", 0) == 0) return 1024 * std::stoull(line.substr(name.size() + 1));
    return {};
}

/// Restarts the measurement of the peak; false if that is not possible.
bool reset_peak() {
    std::ofstream clear("/proc/self/clear_refs");
    clear << "5" << std::flush;
    if (!clear) return false;
    const auto peak = status_bytes("VmHWM"), now = status_bytes("VmRSS");
    return peak && now && *peak < *now + (std::uint64_t{64} << 20);
}

}  // namespace

TEST_CASE("renderer: a million instances are prepared and drawn in less than 1 GB", "[raster][slow]") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    HALFLIT_SKIP("sanitizers need more memory");
#endif
    if (!reset_peak()) HALFLIT_SKIP("no peak of memory in /proc");
    constexpr int kSide = 1000, kSize = 256;
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].unlit = true;
    Mesh mesh;
    mesh.positions = {{-0.4f, 0, 0.4f}, {0.4f, 0, 0.4f}, {0, 0, -0.4f}};
    mesh.indices = {0, 1, 2};
    mesh.material = 0;
    scene.meshes.push_back(mesh);
    scene.instances.reserve(std::size_t{kSide} * kSide);
    for (int z = 0; z < kSide; ++z)
        for (int x = 0; x < kSide; ++x)
            scene.instances.push_back({0, translation({static_cast<float>(x - kSide / 2), 0, static_cast<float>(z - kSide / 2)})});
    // View from above that shows all instances: each pixel has some 15 triangles.
    Camera camera = halflit::test::camera_at({0, 100, 0}, {0, 0, 0});
    camera.orthographic = true;
    camera.half_height = 0.5f * kSide;
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    CHECK(prepared->triangle_count() == std::uint64_t{kSide} * kSide);
    CHECK(prepared->bounds().max.x == 0.4f + 0.5f * kSide - 1);
    std::vector<std::uint8_t> pixels(std::size_t{4} * kSize * kSize);
    Renderer renderer;
    const auto report = renderer.render(*prepared, camera, {}, {kSize, kSize, pixels.data(), nullptr});
    REQUIRE(report);
    CHECK(report->triangles_submitted == std::uint64_t{kSide} * kSide);
    // A triangle covers 0.32 of its square, so it covers a pixel's centre with that probability.
    CHECK(report->pixels_visible == Approx(0.32 * kSize * kSize).epsilon(0.1));
    const std::uint64_t peak = status_bytes("VmHWM").value_or(0);
    INFO("peak " << peak / 1'000'000 << " MB");
    CHECK(peak > 72'000'000);  // the instances themselves
    CHECK(peak < 1'000'000'000);
}
