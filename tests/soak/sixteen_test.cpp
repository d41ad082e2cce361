// Sixteen Renderers at once, on threads of their own, share a Scene and a PreparedScene.
#include "tests/raster/metamorphic_shots.hpp"

#include "tests/support/catch.hpp"

#include <atomic>
#include <thread>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

constexpr int kThreads = 16, kFrames = 4;

/// Camera and settings of one frame: each thread has others.
Shot seen_by(Shot shot, int thread, int frame) {
    shot.scene = {};
    shot.settings.samples = thread % 2 == 0 ? 1 : 4;
    shot.settings.shadows = static_cast<ShadowMode>((thread + frame) % 3);
    shot.settings.exposure = 1.0f + 0.125f * static_cast<float>(thread);
    shot.camera.fov_y_rad *= 1.0f - 0.05f * static_cast<float>(frame);
    return shot;
}

template <class Source>
std::uint64_t hash_of(Renderer& renderer, const Source& scene, const Shot& shot, const Execution& execution) {
    Pixels pixels;
    const auto report = renderer.render(scene, shot.camera, shot.settings, pixels.target(), execution);
    return report ? pixel_hash(pixels.rgba8) : 0;
}

}  // namespace

TEST_CASE("soak: sixteen Renderers at once draw a shared scene as one does", "[soak][threads]") {
    const Shot shot = separate_bodies(7);
    const auto prepared = PreparedScene::make(shot.scene);
    REQUIRE(prepared);
    std::vector<std::uint64_t> expected;
    for (int thread = 0; thread < kThreads; ++thread)
        for (int frame = 0; frame < kFrames; ++frame) {
            Renderer renderer;
            expected.push_back(hash_of(renderer, *prepared, seen_by(shot, thread, frame), execution_of(1, 64, *default_isa())));
        }
    std::atomic<int> wrong{0}, drawn{0};
    {
        std::vector<std::jthread> threads;
        for (int thread = 0; thread < kThreads; ++thread)
            threads.emplace_back([&, thread] {
                Renderer renderer;
                for (int frame = 0; frame < kFrames; ++frame) {
                    const Shot seen = seen_by(shot, thread, frame);
                    const Execution execution = execution_of(1 + thread % 3, 16 << thread % 3, *default_isa());
                    // Some prepare the shared scene again.
                    const std::uint64_t hash = (thread + frame) % 4 == 0 ? hash_of(renderer, shot.scene, seen, execution)
                                                                         : hash_of(renderer, *prepared, seen, execution);
                    wrong += hash != expected[static_cast<std::size_t>(thread * kFrames + frame)];
                    ++drawn;
                }
            });
    }
    CHECK(wrong == 0);
    CHECK(drawn == kThreads * kFrames);
    // The frames differ from each other, so one cannot pass for another.
    std::sort(expected.begin(), expected.end());
    CHECK(std::unique(expected.begin(), expected.end()) - expected.begin() > kThreads);
}
