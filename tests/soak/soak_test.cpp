// One Renderer over many frames of random scenes that change, with frames between them that are cancelled or refused: its memory stays, and
// each good frame equals that of a new Renderer and a newly prepared scene.
#include "tests/raster/metamorphic_shots.hpp"

#include "tests/support/catch.hpp"

#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

constexpr int kScenes = 60;  // then they come again, so that memory for the largest one is soon there

struct Memory {
    double allocated = 0, resident = 0;  ///< MiB; allocated: on the heap, 0 where the C library does not tell
};

Memory memory_now() {
    Memory now;
#if defined(__GLIBC__)
    const struct mallinfo2 info = mallinfo2();
    now.allocated = static_cast<double>(info.uordblks + info.hblkhd) / (1 << 20);
    malloc_trim(0);  // what is free does not count as resident
#endif
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmRSS:")) now.resident = std::stod(line.substr(6)) / 1024;
    return now;
}

/// Scene, and its prepared form that is told of changes.
struct Stand {
    Shot shot;
    std::optional<PreparedScene> prepared;

    void set(Shot next) {
        prepared.reset();
        shot = std::move(next);
        auto made = PreparedScene::make(shot.scene);
        REQUIRE(made);
        prepared.emplace(std::move(*made));
    }
};

/// Changes parts of the scene, and returns what update() is to be told.
SceneChanges change(Random& random, Scene& scene) {
    SceneChanges changes;
    if (random.chance(0.5)) {
        const auto i = static_cast<std::size_t>(random.index(static_cast<int>(scene.instances.size())));
        scene.instances[i].world_from_object = random_place(random, 2);
        changes.changed_instances.push_back(i);
    }
    if (random.chance(0.3)) {
        const auto i = static_cast<std::size_t>(random.index(static_cast<int>(scene.meshes.size())));
        for (Vec3f& p : scene.meshes[i].positions) p = p + random_point(random, 0.02);
        changes.deformed_meshes.push_back(i);
    }
    if (random.chance(0.3)) {
        Material& material = scene.materials[static_cast<std::size_t>(random.index(static_cast<int>(scene.materials.size())))];
        material.roughness = random.real32(0.2, 1);
        material.double_sided = random.chance(0.5);
        changes.materials = true;
    }
    if (random.chance(0.3)) {
        if (scene.lights.size() > 1 && random.chance(0.3)) scene.lights.pop_back();
        scene.lights.back() = random_light(random);
        changes.lights = true;
    }
    return changes;
}

/// A frame that must fail, and does nothing else.
void fail_one(Random& random, Renderer& renderer, Stand& stand) {
    Pixels pixels;
    Settings settings = stand.shot.settings;
    Target target = pixels.target();
    Execution execution = execution_of(1 + random.index(2), 16, *default_isa());
    ErrorCode expected = ErrorCode::usage;
    int tiles = random.index(20);
    switch (random.index(7)) {
        case 0:
        case 1:
            execution.cancelled = [&tiles] { return tiles-- <= 0; };
            execution.threads = 1;
            execution.parallel_for = {};
            expected = ErrorCode::cancelled;
            break;
        case 2:
            settings.samples = 3;
            break;
        case 3:
            target.width = 40000;
            expected = ErrorCode::limit;
            break;
        case 4:
            settings.region = {0, 0, kViewWidth + 1, 1};
            break;
        case 5:
            execution.parallel_for = [](int count, const std::function<void(int)>& body) {
                for (int i = 1; i < count; ++i) body(i);  // leaves one out
            };
            break;
        default: {
            // The scene is broken, then repaired: until then no frame is drawn.
            Scene& scene = stand.shot.scene;
            const auto mesh = static_cast<std::size_t>(random.index(static_cast<int>(scene.meshes.size())));
            const std::vector<std::uint32_t> whole = scene.meshes[mesh].indices;
            scene.meshes[mesh].indices.push_back(0);
            const auto broken = stand.prepared->update({.deformed_meshes = {mesh}});
            REQUIRE_FALSE(broken);
            CHECK(broken.error().code == ErrorCode::bad_input);
            CHECK_FALSE(renderer.render(*stand.prepared, stand.shot.camera, settings, target, execution));
            scene.meshes[mesh].indices = whole;
            REQUIRE(stand.prepared->update({.deformed_meshes = {mesh}}));
            return;
        }
    }
    const auto report = renderer.render(*stand.prepared, stand.shot.camera, settings, target, execution);
    REQUIRE_FALSE(report);
    CHECK(report.error().code == expected);
}

Pixels draw_prepared(Renderer& renderer, const PreparedScene& prepared, const Shot& shot, const Execution& execution) {
    Pixels pixels;
    const auto report = renderer.render(prepared, shot.camera, shot.settings, pixels.target(), execution);
    if (!report) throw std::runtime_error(report.error().message);
    pixels.visible = report->pixels_visible;
    return pixels;
}

void soak(int frames) {
#if defined(__GLIBC__)
    // One heap for all threads: mallinfo2 counts no other, and with several what is free in one of them is lost to the others.
    mallopt(M_ARENA_MAX, 1);
#endif
    Random random(1);
    const Shot always = separate_bodies(1);
    (void)draw(always, execution_of(3, 16, *default_isa()));  // starts what the process keeps
    const Memory before = memory_now();
    std::optional<Renderer> renderer(std::in_place);
    Stand stand;
    int wrong = 0, first_wrong = 0, good = 0, failed = 0, scenes = 0;
    std::uint64_t visible = 0;
    std::optional<Memory> early;
    for (int frame = 1; frame <= frames; ++frame) {
        if (frame == 1 || random.chance(0.2)) {
            stand.set(any_shot(static_cast<std::uint64_t>(scenes++ % kScenes)));
        } else if (random.chance(0.7)) {
            REQUIRE(stand.prepared->update(change(random, stand.shot.scene)));
        }
        if (random.chance(0.25)) {
            fail_one(random, *renderer, stand);
            ++failed;
        }
        if (random.chance(0.05)) renderer->forget_frames();
        const Execution execution = execution_of(1 + random.index(3), 16 << random.index(3), *default_isa());
        const Pixels kept = draw_prepared(*renderer, *stand.prepared, stand.shot, execution);
        const bool same = pixel_hash(kept.rgba8) == pixel_hash(draw(stand.shot).rgba8);
        wrong += !same;
        ++good;
        visible += kept.visible;
        if (!same && first_wrong == 0) first_wrong = frame;
        if (frame != 100 && frame != 300 && frame % 1000 != 0) continue;
        // The same scene both times, so that only what the Renderer keeps of others can differ.
        stand.set(always);
        (void)draw_prepared(*renderer, *stand.prepared, stand.shot, execution);
        const Memory now = memory_now();
        std::printf("frame %d: %.1f MiB allocated, %.1f MiB resident\n", frame, now.allocated, now.resident);
        // A long run compares its halves: scenes of all sizes have come by then.
        if (!early && (frames < 1000 || frame >= frames / 2)) early = now;
    }
    [[maybe_unused]] const Memory late = memory_now();
    renderer.reset();
    stand.prepared.reset();
    stand.shot = {};
    const Memory after = memory_now();
    std::printf("without the Renderer: %.1f MiB allocated before, %.1f after\n", before.allocated, after.allocated);
    INFO(good << " frames, " << failed << " failed ones, " << scenes << " scenes, first wrong frame " << first_wrong);
    CHECK(wrong == 0);
    CHECK(failed > frames / 8);
    CHECK(visible > static_cast<std::uint64_t>(frames) * kViewWidth * kViewHeight / 10);
    REQUIRE(early);
    // A Renderer keeps memory for the largest frame, which comes later than frame 100. Nothing stays without it, but for what the standard
    // library keeps for its threads. Three threads have working memory of their own, if they meet: 6 to 9 MiB. The sanitizers keep what was
    // freed, and have allocators of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    CHECK(late.allocated <= early->allocated + 12);
    CHECK(late.resident <= early->resident + (frames < 1000 ? 16 : 4));
    CHECK(after.allocated <= before.allocated + 0.5);
#endif
}

}  // namespace

TEST_CASE("soak: 300 frames of changing scenes, cancels and errors keep pixels and memory", "[soak]") { soak(300); }

TEST_CASE("soak: 10,000 frames of changing scenes, cancels and errors keep pixels and memory", "[soak][deep]") { soak(10'000); }
