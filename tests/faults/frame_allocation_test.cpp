// Allocations of frames of random scenes fail in turn: materials, skies, shadows, layers, error budgets.
#include "tests/faults/allocation_counter.hpp"
#include "tests/raster/metamorphic_shots.hpp"

#include "tests/support/catch.hpp"

#include <optional>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;
using halflit::test::AllocationFault;

namespace {

/// Prepares, draws, changes and draws again. Returns the code of the first call that failed.
std::optional<ErrorCode> draw_twice(const Shot& shot, const SceneChanges& changes, Renderer& renderer,
                                    std::optional<PreparedScene>& prepared, Pixels& pixels) {
    const Target target = pixels.target();
    auto made = PreparedScene::make(shot.scene);
    if (!made) return made.error().code;
    prepared.emplace(std::move(*made));
    for (int frame = 0; frame < 2; ++frame) {
        if (frame == 1)
            if (const auto updated = prepared->update(changes); !updated) return updated.error().code;
        const auto report = renderer.render(*prepared, shot.camera, shot.settings, target, {.threads = 1});
        if (!report) return report.error().code;
    }
    return std::nullopt;
}

}  // namespace

TEST_CASE("faults: each failed allocation of a frame is a limit, leaks nothing and leaves the Renderer usable", "[faults]") {
    long points = 0;
    const SceneChanges changes{.changed_instances = {0}, .deformed_meshes = {0}, .materials = true, .lights = true};
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        Shot shot = any_shot(seed);
        if (seed % 4 == 0) {
            shot.settings.shading = {};
            shot.settings.shading.max_error_codes = 0.5;
        }
        const Pixels expected = draw(shot);
        long count = 0;
        for (long at = 0; at <= count; at += at < 200 ? 1 : 7) {  // 0: counts
            const long before = halflit::test::live_allocations();
            {
                Renderer renderer;
                std::optional<PreparedScene> prepared;
                Pixels pixels;
                std::optional<ErrorCode> error;
                {
                    const AllocationFault fault(at);
                    error = draw_twice(shot, changes, renderer, prepared, pixels);
                    if (at == 0) count = AllocationFault::made();
                }
                INFO("seed " << seed << ", allocation " << at << " of " << count);
                CHECK((!error || *error == ErrorCode::limit));
                if (!error) CHECK(differing(expected, pixels) == 0);
                CHECK(differing(expected, draw(shot, renderer)) == 0);
                ++points;
            }
            if (at > 0 && halflit::test::live_allocations() != before) FAIL_CHECK("seed " << seed << ", allocation " << at << ": leak");
        }
    }
    CHECK(points > 2000);
}
