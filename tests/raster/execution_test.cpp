// How a frame is computed: stopping, progress, the host's own loop, and what is refused. Nothing of it changes a pixel.
#include "halflit/prepared_scene.hpp"
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "raster/detail/executor.hpp"
#include "sh/time_limit.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <atomic>
#include <cstring>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <type_traits>

using namespace halflit;
using halflit::raster::test::NamedScene;

namespace {

constexpr int kWidth = 150, kHeight = 100;
using Bytes = std::vector<std::uint8_t>;

const NamedScene& scene() {
    static const NamedScene made = raster::test::layers_scene();
    return made;
}

Settings usual() {
    Settings s;
    s.shadow_size = 64;
    return s;
}

Result<RenderReport> draw(Bytes& pixels, const Settings& settings, const Execution& execution) {
    pixels.assign(std::size_t{4} * kWidth * kHeight, 0xCD);
    return render(scene().scene, scene().camera, settings, {.width = kWidth, .height = kHeight, .pixels = pixels.data()}, execution);
}

const Bytes& expected() {
    static const Bytes pixels = [] {
        Bytes p;
        REQUIRE(draw(p, usual(), {}));
        return p;
    }();
    return pixels;
}

bool one_line(const Error& error) { return !error.message.empty() && error.message.find('\n') == std::string::npos; }

}  // namespace

TEST_CASE("execution: a frame that is cancelled says so, and the next one is drawn", "[raster][execution]") {
    Renderer renderer;
    Bytes pixels(std::size_t{4} * kWidth * kHeight);
    const Target target{.width = kWidth, .height = kHeight, .pixels = pixels.data()};
    for (const int threads : {1, 3})
        for (const int after : {0, 1, 7}) {
            std::atomic<int> asked{0}, told{0};
            Execution e{.threads = threads, .tile_size = 16};
            e.cancelled = [&] { return asked++ >= after; };
            e.on_tile = [&](const Region&) { ++told; };
            double last = 0;
            e.progress = [&](double share) { last = share; };
            const auto stopped = renderer.render(scene().scene, scene().camera, usual(), target, e);
            REQUIRE(!stopped);
            CHECK(stopped.error().code == ErrorCode::cancelled);
            CHECK(one_line(stopped.error()));
            CHECK(told <= after);  // no tile is final that was not drawn
            CHECK(last < 1);
            e.cancelled = [] { return false; };
            REQUIRE(renderer.render(scene().scene, scene().camera, usual(), target, e));
            CHECK(pixels == expected());
        }
}

TEST_CASE("execution: the tiles told cover the region once, and their pixels are final", "[raster][execution]") {
    for (const Region r : {Region{}, Region{0, 0, 1, 1}, Region{17, 9, 100, 77}, Region{149, 99, 1, 1}})
        for (const int tile : {16, 32, 64})
            for (const bool alone : {false, true})
                for (const bool reversed : {false, true}) {
                    INFO("region " << r.x << "," << r.y << "," << r.width << "," << r.height << ", tile " << tile << ", alone " << alone);
                    const Region full = r.width == 0 ? Region{0, 0, kWidth, kHeight} : r;
                    Settings settings = usual();
                    settings.region = r;
                    const int row = alone ? full.width : kWidth, x0 = alone ? full.x : 0, y0 = alone ? full.y : 0;
                    Bytes pixels(std::size_t{4} * kWidth * kHeight, 0xCD);
                    std::vector<int> told(std::size_t{kWidth} * kHeight);
                    int wrong = 0;
                    Execution e{.threads = 1, .tile_size = tile};
                    if (reversed)
                        e.parallel_for = [](int count, const std::function<void(int)>& body) {
                            for (int i = count - 1; i >= 0; --i) body(i);
                        };
                    e.on_tile = [&](const Region& t) {
                        wrong += t.width < 1 || t.height < 1 || t.width > tile || t.height > tile;
                        for (int y = t.y; y < t.y + t.height; ++y)
                            for (int x = t.x; x < t.x + t.width; ++x) {
                                if (x < full.x || y < full.y || x >= full.x + full.width || y >= full.y + full.height) {
                                    ++wrong;
                                    continue;
                                }
                                ++told[static_cast<std::size_t>(y * kWidth + x)];
                                wrong += std::memcmp(&pixels[static_cast<std::size_t>(4 * ((y - y0) * row + x - x0))],
                                                     &expected()[static_cast<std::size_t>(4 * (y * kWidth + x))], 4) != 0;
                            }
                    };
                    REQUIRE(render(scene().scene, scene().camera, settings,
                                   {.width = kWidth, .height = kHeight, .pixels = pixels.data(), .region_alone = alone}, e));
                    CHECK(wrong == 0);
                    int not_once = 0;
                    for (int y = 0; y < kHeight; ++y)
                        for (int x = 0; x < kWidth; ++x) {
                            const bool in = x >= full.x && y >= full.y && x < full.x + full.width && y < full.y + full.height;
                            not_once += told[static_cast<std::size_t>(y * kWidth + x)] != (in ? 1 : 0);
                        }
                    CHECK(not_once == 0);
                }
}

TEST_CASE("execution: progress rises to exactly 1, one call at a time", "[raster][execution]") {
    for (const int threads : {1, 4})
        for (const int tile : {16, 64})
            for (const Scene* s : {&scene().scene, static_cast<const Scene*>(nullptr)}) {
                double last = 0;
                int calls = 0, wrong = 0;
                std::atomic<int> inside{0}, tiles{0};
                Execution e{.threads = threads, .tile_size = tile};
                e.on_tile = [&](const Region&) { ++tiles; };
                e.progress = [&](double share) {
                    wrong += inside++ != 0 || !(share > last) || !(share <= 1);
                    last = share;
                    ++calls;
                    --inside;
                };
                Bytes pixels(std::size_t{4} * kWidth * kHeight);
                REQUIRE(render(s != nullptr ? *s : Scene{}, scene().camera, usual(),
                               {.width = kWidth, .height = kHeight, .pixels = pixels.data()}, e));
                CHECK(wrong == 0);
                CHECK(last == 1.0);
                CHECK(calls == tiles);
                CHECK(calls == ((kWidth + tile - 1) / tile) * ((kHeight + tile - 1) / tile));
            }
}

TEST_CASE("execution: a loop of the host that leaves items out is an error", "[raster][execution]") {
    const auto check = [](const char* what, const ParallelFor& loop) {
        INFO(what);
        Renderer renderer;
        Bytes pixels(std::size_t{4} * kWidth * kHeight);
        const Target target{.width = kWidth, .height = kHeight, .pixels = pixels.data()};
        const PreparedScene prepared = PreparedScene::make(scene().scene).value();
        double last = 0;
        Execution e{.tile_size = 16, .parallel_for = loop};
        e.progress = [&](double share) { last = share; };
        for (const bool from_scene : {false, true}) {
            const auto failed = from_scene ? renderer.render(scene().scene, scene().camera, usual(), target, e)
                                           : renderer.render(prepared, scene().camera, usual(), target, e);
            REQUIRE(!failed);
            CHECK(failed.error().code == ErrorCode::usage);
            CHECK(failed.error().message.find("parallel_for") != std::string::npos);
            CHECK(one_line(failed.error()));
            CHECK(last <= 1);
        }
        CHECK(!PreparedScene::make(scene().scene, e));
        REQUIRE(renderer.render(prepared, scene().camera, usual(), target));
        CHECK(pixels == expected());
    };
    check("nothing runs", [](int, const std::function<void(int)>&) {});
    check("the last is left out", [](int count, const std::function<void(int)>& body) {
        for (int i = 0; i + 1 < count; ++i) body(i);
    });
    check("the first runs twice instead of the second", [](int count, const std::function<void(int)>& body) {
        for (int i = 0; i < count; ++i) body(i == 1 ? 0 : i);
        if (count == 1) body(0);
    });
    check("all run twice", [](int count, const std::function<void(int)>& body) {
        for (int i = 0; i < 2 * count; ++i) body(i / 2);
    });
    check("one item too many", [](int count, const std::function<void(int)>& body) {
        for (int i = 0; i <= count; ++i) body(i);
    });
    check("an item before the first", [](int count, const std::function<void(int)>& body) {
        for (int i = -1; i < count; ++i) body(i);
    });
}

TEST_CASE("execution: an item runs once, however often the host's loop asks", "[raster][execution]") {
    raster::Executor executor;
    executor.configure({.threads = 1, .parallel_for = [](int count, const std::function<void(int)>& body) {
                            for (int i = -2; i < 3 * count; ++i) body(i / 2);
                        }});
    std::vector<int> runs(10);
    CHECK_THROWS(executor.run(10, [&](int i) { ++runs.at(static_cast<std::size_t>(i)); }));
    CHECK(runs == std::vector<int>(10, 1));
}

TEST_CASE("execution: a host's thread that waits within one render may run tiles of another, which keep their own limit",
          "[raster][execution]") {
    raster::Executor executor;
    executor.configure({.threads = 1, .parallel_for = [](int count, const std::function<void(int)>& body) {
                            const TimeLimit of_another_render(1e-9);
                            for (int i = 0; i < count; ++i) body(i);
                        }});
    int done = 0;
    CHECK_NOTHROW(executor.run(4, [&](int) {
        check_time();
        ++done;
    }));
    CHECK(done == 4);
    const TimeLimit own(1e-9);
    CHECK_THROWS_AS(executor.run(4, [](int) { check_time(); }), OutOfTime);
}

TEST_CASE("execution: loops of many threads, and loops within loops, share the process's threads", "[raster][execution]") {
    constexpr int kHosts = 5, kRounds = 40, kOuter = 7, kInner = 5;
    std::atomic<int> inner_items{0}, caught{0}, wrong{0};
    std::vector<std::thread> hosts;
    for (int h = 0; h < kHosts; ++h)
        hosts.emplace_back([&, h] {
            raster::Executor executor;
            for (int round = 0; round < kRounds; ++round) {
                executor.configure({.threads = 1 + (h + round) % 4});
                std::vector<std::atomic<int>> taken(kOuter);
                executor.run(kOuter, [&](int i) {
                    ++taken[static_cast<std::size_t>(i)];
                    raster::Executor within;
                    within.configure({.threads = 3});
                    within.run(kInner, [&](int) { ++inner_items; });
                });
                for (const std::atomic<int>& count : taken) wrong += count != 1;
                try {
                    executor.run(kOuter, [](int i) {
                        if (i == 3) throw std::bad_alloc();
                    });
                } catch (const std::bad_alloc&) {
                    ++caught;
                }
            }
        });
    for (std::thread& host : hosts) host.join();
    CHECK(wrong == 0);
    CHECK(inner_items == kHosts * kRounds * kOuter * kInner);
    CHECK(caught == kHosts * kRounds);
}

TEST_CASE("execution: what cancels a thread's work cancels that of threads and limits inside of it", "[raster][execution]") {
    bool is_cancelled = false;
    const TimeLimit::Cancelled asked = [&] { return is_cancelled; };
    const auto thrown = [] {
        try {
            check_time();
            return 0;
        } catch (const OutOfTime& found) {
            return found.is_cancelled ? 2 : 1;
        }
    };
    {
        const TimeLimit outer(0.0, &asked);
        const TimeLimit inner(1000.0);
        CHECK(thrown() == 0);
        is_cancelled = true;
        CHECK(thrown() == 2);
        int elsewhere = 0;
        std::thread([&, bounds = TimeLimit::bounds()] {
            const TimeLimit taken_along(bounds);
            elsewhere = thrown();
        }).join();
        CHECK(elsewhere == 2);
    }
    CHECK(thrown() == 0);
    const TimeLimit late(1e-9);
    CHECK(thrown() == 1);
}

TEST_CASE("execution: preparing a scene of one large mesh is cancelled in its midst", "[raster][execution]") {
    Scene scene;
    scene.meshes.push_back(make_sphere_of(1.0f, 400000));
    scene.instances.push_back({});
    std::atomic<int> asked{0};
    Execution execution;
    execution.threads = 1;
    execution.cancelled = [&] {
        ++asked;
        return false;
    };
    REQUIRE(PreparedScene::make(scene, execution));
    const int whole = asked;
    CHECK(whole > 4);
    for (const int last : {1, whole / 2, whole - 1}) {
        asked = 0;
        execution.cancelled = [&] { return ++asked >= last; };
        const auto made = PreparedScene::make(scene, execution);
        REQUIRE(!made);
        CHECK(made.error().code == ErrorCode::cancelled);
    }
}

TEST_CASE("execution: a function of the host that throws ends the frame with an error, and no exception leaves", "[raster][execution]") {
    Renderer renderer;
    Bytes pixels(std::size_t{4} * kWidth * kHeight);
    const Target target{.width = kWidth, .height = kHeight, .pixels = pixels.data()};
    const auto check = [&](const char* what, const Execution& e) {
        INFO(what);
        const auto failed = renderer.render(scene().scene, scene().camera, usual(), target, e);
        REQUIRE(!failed);
        CHECK(one_line(failed.error()));
        REQUIRE(renderer.render(scene().scene, scene().camera, usual(), target));
        CHECK(pixels == expected());
    };
    for (const int threads : {1, 3}) {
        Execution e{.threads = threads, .tile_size = 16};
        e.parallel_for = [](int, const std::function<void(int)>&) { throw std::runtime_error("no threads today"); };
        check("parallel_for", e);
        e.parallel_for = [](int count, const std::function<void(int)>& body) {
            for (int i = 0; i < count; ++i) body(i);
            throw 7;
        };
        check("parallel_for, afterwards, and no std::exception", e);
        e.parallel_for = {};
        e.cancelled = []() -> bool { throw std::runtime_error("cancelled"); };
        check("cancelled", e);
        e.cancelled = {};
        e.on_tile = [](const Region&) { throw 1; };
        check("on_tile", e);
        e.on_tile = {};
        e.progress = [](double) { throw std::bad_alloc(); };
        check("progress", e);
    }
}

TEST_CASE("execution: tile sizes and instruction sets that are not offered are refused", "[raster][execution]") {
    Bytes pixels;
    for (const int tile : {17, 0, -16, 8, 128, std::numeric_limits<int>::max()}) {
        const auto refused = draw(pixels, usual(), {.tile_size = tile});
        REQUIRE(!refused);
        CHECK(refused.error().code == ErrorCode::usage);
        CHECK(one_line(refused.error()));
        CHECK(pixels == Bytes(pixels.size(), 0xCD));
    }
    int missing = 0;
    for (const Isa isa : {Isa::scalar, Isa::sse2, Isa::sse41, Isa::avx2, Isa::avx512, Isa::neon64, Isa::wasm128, static_cast<Isa>(77)}) {
        const auto drawn = draw(pixels, usual(), {.isa = isa});
        INFO(isa_name(isa));
        REQUIRE(drawn.has_value() == isa_available(isa));
        if (drawn) {
            CHECK(pixels == expected());
            CHECK(drawn->isa == isa);
            continue;
        }
        ++missing;
        CHECK(drawn.error().code == ErrorCode::usage);
        CHECK(one_line(drawn.error()));
        CHECK(pixels == Bytes(pixels.size(), 0xCD));
    }
    CHECK(missing > 0);  // no CPU runs both NEON and SSE
}

TEST_CASE("execution: equal settings give equal pixels, whatever the execution", "[raster][execution]") {
    int tile = 16;
    for (const int samples : {1, 4})
        for (const double codes : {0.0, 2.0})
            for (const ShadowMode shadows : {ShadowMode::off, ShadowMode::soft_split}) {
                Settings a = usual();
                a.samples = samples;
                a.shading.max_error_codes = codes;
                a.shadows = shadows;
                a.shading.lobe = Lobe::valve();
                const Settings b = a;
                REQUIRE(a == b);
                Bytes first, second;
                REQUIRE(draw(first, a, {.threads = 1}));
                REQUIRE(draw(second, b, {.threads = 2, .tile_size = tile, .isa = Isa::scalar}));
                CHECK(first == second);
                tile = tile == 64 ? 16 : 2 * tile;
            }
    // Each setting takes part in the comparison.
    const Settings usual_settings = usual();
    const auto differs = [&](auto change) {
        Settings s = usual_settings;
        change(s);
        return !(s == usual_settings);
    };
    CHECK(differs([](Settings& s) { s.region.width = 3; }));
    CHECK(differs([](Settings& s) { s.samples = 4; }));
    CHECK(differs([](Settings& s) { s.background_linear.w = 1; }));
    CHECK(differs([](Settings& s) { s.background_environment = true; }));
    CHECK(differs([](Settings& s) { s.exposure = 2; }));
    CHECK(differs([](Settings& s) { s.shading.lobe = Lobe{}; }));
    CHECK(differs([](Settings& s) { s.shading.environment_bands = 2; }));
    CHECK(differs([](Settings& s) { s.shading.texture_detail = TextureDetail::nearest; }));
    CHECK(differs([](Settings& s) { s.shadows = ShadowMode::hard; }));
    CHECK(differs([](Settings& s) { s.shadow_size = 128; }));
    CHECK(differs([](Settings& s) { s.shadow_memory_limit = 1; }));
    CHECK(differs([](Settings& s) { s.shadow_fade = 1; }));
    CHECK(differs([](Settings& s) { s.point_size = 1; }));
    CHECK(differs([](Settings& s) { s.line_width = 1; }));
    CHECK(differs([](Settings& s) { s.shadow_terminator_offset = true; }));
}

TEST_CASE("execution: an error budget with settings whose error has no bound is refused", "[raster][execution]") {
    const auto check = [](auto change, const std::string& words) {
        Settings s = usual();
        s.shading.max_error_codes = 2;
        CHECK(check_settings(s, 10, 10));
        change(s.shading);
        Bytes pixels;
        const auto checked = check_settings(s, kWidth, kHeight);
        const auto drawn = draw(pixels, s, {});
        REQUIRE(!checked);
        REQUIRE(!drawn);
        CHECK(checked.error().code == ErrorCode::usage);
        CHECK(checked.error().message == words);  // the command line prints this after two dashes
        CHECK(drawn.error().code == ErrorCode::usage);
        CHECK(drawn.error().message == words);
        CHECK(pixels == Bytes(pixels.size(), 0xCD));
    };
    const std::string accuracy = "max-error: cannot be combined with an accuracy other than exact";
    check([](ShadingSettings& s) { s.accuracy = Accuracy::reference; }, accuracy);
    check([](ShadingSettings& s) { s.rate = ShadingRate::gouraud; },
          "max-error: expected shading pixel; the error of other rates has no bound");
    check([](ShadingSettings& s) { s.rate = ShadingRate::flat; },
          "max-error: expected shading pixel; the error of other rates has no bound");
    const std::string filter = "max-error: expected texture-filter full; the error of other filters has no bound";
    check([](ShadingSettings& s) { s.texture_detail = TextureDetail::nearest; }, filter);
    check([](ShadingSettings& s) { s.texture_detail = TextureDetail::bilinear; }, filter);
    for (const auto& [codes, text] : {std::pair{-1.0, "-1"},
                                      {256.0, "256"},
                                      {std::numeric_limits<double>::quiet_NaN(), "nan"},
                                      {std::numeric_limits<double>::infinity(), "inf"}})
        check([&, codes = codes](ShadingSettings& s) { s.max_error_codes = codes; },
              std::string("max_error_codes: expected 0, or a number above 0 to 255, found '") + text + "'");
    // For the command line as for a host: the budget belongs to accuracy exact alone, and reference measures, it has no budget.
    check([](ShadingSettings& s) { s.accuracy = Accuracy::reference; }, accuracy);
}

TEST_CASE("execution: check_settings refuses whatever a frame refuses", "[raster][execution]") {
    const auto check = [](auto change) {
        Settings s = usual();
        change(s);
        Bytes pixels;
        const auto checked = check_settings(s, kWidth, kHeight);
        const auto drawn = draw(pixels, s, {});
        REQUIRE(!checked);
        REQUIRE(!drawn);
        CHECK(checked.error().code == ErrorCode::usage);
        CHECK(drawn.error().code == ErrorCode::usage);
        CHECK(drawn.error().message == checked.error().message);
        CHECK(one_line(drawn.error()));
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (const int samples : {0, 2, 12, 32}) check([&](Settings& s) { s.samples = samples; });
    for (const int sky_shadows : {-1, 2, 15, 1025}) check([&](Settings& s) { s.sky_shadows = sky_shadows; });
    for (const int anisotropy : {-1, 0, 17}) check([&](Settings& s) { s.shading.anisotropy = anisotropy; });
    for (const int side : {-64, 32, 63, 100, 8192, std::numeric_limits<int>::min()}) check([&](Settings& s) { s.shadow_size = side; });
    for (const float fade : {-1.0f, kNan, std::numeric_limits<float>::infinity()}) check([&](Settings& s) { s.shadow_fade = fade; });
    for (const float exposure : {0.0f, -1.0f, kNan}) check([&](Settings& s) { s.exposure = exposure; });
    check([](Settings& s) { s.region = {0, 0, kWidth + 1, 1}; });
    check([](Settings& s) { s.shading.lobe = Lobe{2, 1, false}; });
    check([](Settings& s) { s.shading.environment_bands = 11; });
    check([&](Settings& s) { s.shading.environment_tolerance = kNan; });
    CHECK(!check_settings({}, 0, 1));
    CHECK(check_settings({}, 32769, 1).error().code == ErrorCode::limit);
    CHECK(check_settings({}, 32768, 32768));
}

// ---- the handle of a prepared scene --------------------------------------------------------------------------------------

template <class S>
concept Preparable = requires(S&& s) {
    PreparedScene::make(static_cast<S&&>(s));
};
static_assert(Preparable<Scene&> && Preparable<const Scene&>);
static_assert(!Preparable<Scene>);  // it would not outlive the call
static_assert(std::is_nothrow_move_constructible_v<PreparedScene> && std::is_nothrow_move_assignable_v<PreparedScene>);
static_assert(!std::is_copy_constructible_v<PreparedScene> && !std::is_copy_assignable_v<PreparedScene>);
static_assert(std::is_nothrow_move_constructible_v<Renderer> && std::is_nothrow_move_assignable_v<Renderer>);

TEST_CASE("prepared scene: a moved one draws as before, and can be updated", "[raster][prepared]") {
    Scene other;
    other.meshes.push_back(make_box({1, 1, 1}));
    other.instances.push_back({0, {}});
    PreparedScene first = PreparedScene::make(scene().scene).value();
    const std::uint64_t triangles = first.triangle_count();
    Renderer renderer;
    Bytes pixels(std::size_t{4} * kWidth * kHeight);
    const Target target{.width = kWidth, .height = kHeight, .pixels = pixels.data()};
    const auto draws_right = [&](const PreparedScene& prepared) {
        pixels.assign(pixels.size(), 0xCD);
        REQUIRE(renderer.render(prepared, scene().camera, usual(), target));
        return pixels == expected();
    };
    CHECK(draws_right(first));
    PreparedScene second(std::move(first));
    CHECK(draws_right(second));
    CHECK(&second.scene() == &scene().scene);
    CHECK(second.triangle_count() == triangles);
    PreparedScene third = PreparedScene::make(other).value();
    CHECK(third.triangle_count() == 12);
    third = std::move(second);
    CHECK(draws_right(third));
    CHECK(third.triangle_count() == triangles);
    REQUIRE(third.update({.changed_instances = {0}, .lights = true}));
    CHECK(draws_right(third));
    // A moved-from Renderer or scene may be assigned to again.
    second = PreparedScene::make(other).value();
    CHECK(second.triangle_count() == 12);
    Renderer moved(std::move(renderer));
    renderer = std::move(moved);
    CHECK(draws_right(third));
}
