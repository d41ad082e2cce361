// Pixels must be the same for every instruction set, thread count, tile size, crop, loop of a host and floating-point environment.
#include "halflit/renderer.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/setup.hpp"

#include "tests/support/catch.hpp"

#include <atomic>
#include <cstring>
#include <thread>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;
using halflit::test::available_isas;

namespace {

constexpr int kWidth = 200, kHeight = 150;  // neither a multiple of a tile

struct Picture {
    int width = kWidth, height = kHeight;
    std::vector<std::uint8_t> rgba8;
    std::vector<float> rgba_linear;
    std::uint64_t nan_pixels = 0, visible = 0, not_finite = 0;

    [[nodiscard]] std::uint64_t hash8() const { return pixel_hash(rgba8); }
    [[nodiscard]] std::uint64_t hash_linear() const {
        return pixel_hash({reinterpret_cast<const std::uint8_t*>(rgba_linear.data()), rgba_linear.size() * sizeof(float)});
    }
    friend bool operator==(const Picture& a, const Picture& b) {
        return a.rgba8 == b.rgba8 && a.rgba_linear.size() == b.rgba_linear.size() &&
               std::memcmp(a.rgba_linear.data(), b.rgba_linear.data(), a.rgba_linear.size() * sizeof(float)) == 0;
    }
};

Picture draw(const NamedScene& s, const halflit::test::Setup& settings, Renderer& renderer) {
    Picture p;
    // Values that show which pixels were not written.
    p.rgba8.assign(4 * kWidth * kHeight, 0xCD);
    p.rgba_linear.assign(4 * kWidth * kHeight, -123.0f);
    const auto report =
        renderer.render(s.scene, s.camera, settings, {kWidth, kHeight, p.rgba8.data(), p.rgba_linear.data()}, settings.execution);
    if (!report) throw std::runtime_error(report.error().message);
    p.nan_pixels = report->nan_pixels;
    p.visible = report->pixels_visible;
    p.not_finite = report->triangles_not_finite;
    return p;
}

Picture draw(const NamedScene& s, const halflit::test::Setup& settings) {
    Renderer renderer;
    return draw(s, settings, renderer);
}

/// A parallel loop with its own threads, as a host might provide it.
ParallelFor host_loop(int thread_count) {
    return [thread_count](int count, const std::function<void(int)>& body) {
        std::atomic<int> next{0};
        std::vector<std::thread> threads;
        for (int t = 0; t < thread_count; ++t)
            threads.emplace_back([&] {
                for (int i = next++; i < count; i = next++) body(i);
            });
        for (std::thread& t : threads) t.join();
    };
}

halflit::test::Setup settings_of(Isa isa, int threads, int tile, int samples) {
    halflit::test::Setup settings;
    settings.execution.isa = isa;
    settings.execution.threads = threads;
    settings.execution.tile_size = tile;
    settings.samples = samples;
    settings.background_linear = {0.02f, 0.05f, 0.1f, 0.5f};
    settings.shadow_size = 64;  // small: the scenes have many lights
    return settings;
}

const std::vector<NamedScene>& scenes() {
    static const std::vector<NamedScene> made = all_scenes();
    return made;
}

}  // namespace

TEST_CASE("determinism: every instruction set, thread count and tile size gives the same pixels", "[raster][determinism]") {
    for (const NamedScene& s : scenes()) {
        for (const int samples : {1, 4, 8, 16}) {
            const Picture first = draw(s, settings_of(Isa::scalar, 1, 64, samples));
            REQUIRE(first.visible > 3000);
            int combinations = 0;
            for (const Isa isa : available_isas())
                for (int t = 0; t < 3; ++t)
                    for (int size = 0; size < 3; ++size) {
                        // One sample: each set with each tile size, the widest with each thread count too. More samples: each set once.
                        const int turn = static_cast<int>(isa) + size;
                        if (samples == 1 ? t != turn % 3 && isa != available_isas().back()
                                         : t != turn % 3 || size != static_cast<int>(isa) % 3)
                            continue;
                        const int threads = t == 2 ? 5 : t + 1, tile = 16 << size;
                        const Picture p = draw(s, settings_of(isa, threads, tile, samples));
                        INFO(s.name << ", samples " << samples << ", " << isa_name(isa) << ", threads " << threads << ", tile " << tile);
                        CHECK(p.hash8() == first.hash8());
                        CHECK(p.hash_linear() == first.hash_linear());
                        CHECK(p.nan_pixels == first.nan_pixels);
                        CHECK(p.visible == first.visible);
                        CHECK(p.not_finite == first.not_finite);
                        ++combinations;
                    }
            CHECK(combinations >= static_cast<int>(available_isas().size()));
        }
    }
}

TEST_CASE("determinism: shading once a triangle or once a vertex gives the same pixels everywhere too", "[raster][determinism]") {
    for (const NamedScene& s : scenes()) {
        for (const ShadingRate rate : {ShadingRate::flat, ShadingRate::gouraud}) {
            halflit::test::Setup settings = settings_of(Isa::scalar, 1, 64, 4);
            settings.shading.rate = rate;
            const Picture first = draw(s, settings);
            Picture pixel_rate = draw(s, settings_of(Isa::scalar, 1, 64, 4));
            CHECK_FALSE(first == pixel_rate);
            int tile = 16;
            for (const Isa isa : available_isas()) {
                settings = settings_of(isa, 2, tile, 4);
                settings.shading.rate = rate;
                INFO(s.name << ", rate " << static_cast<int>(rate) << ", " << isa_name(isa) << ", tile " << tile);
                CHECK(draw(s, settings) == first);
                tile = tile == 64 ? 16 : 2 * tile;
            }
        }
    }
}

TEST_CASE("determinism: error budgets and coarser texture filters give the same pixels everywhere too", "[raster][determinism]") {
    struct Variant {
        const char* name;
        double codes;
        TextureDetail detail;
    };
    constexpr Variant kVariants[] = {{"at most half a code", 0.5, TextureDetail::full},
                                     {"at most 8 codes", 8, TextureDetail::full},
                                     {"nearest texels", 0, TextureDetail::nearest}};
    int changed = 0;
    for (const NamedScene& s : scenes()) {
        const Picture exact = draw(s, settings_of(Isa::scalar, 1, 64, 1));
        for (const Variant& variant : kVariants) {
            const auto draw_by = [&](Isa isa, int threads, int tile) {
                halflit::test::Setup settings = settings_of(isa, threads, tile, 1);
                settings.shading.max_error_codes = variant.codes;
                settings.shading.texture_detail = variant.detail;
                return draw(s, settings);
            };
            const Picture first = draw_by(Isa::scalar, 1, 64);
            changed += first == exact ? 0 : 1;
            const auto check = [&](Isa isa, int threads, int tile) {
                INFO(s.name << ", " << variant.name << ", " << isa_name(isa) << ", threads " << threads << ", tile " << tile);
                const Picture p = draw_by(isa, threads, tile);
                CHECK(p.hash8() == first.hash8());
                CHECK(p.hash_linear() == first.hash_linear());
            };
            int tile = 16;
            for (const Isa isa : available_isas()) {
                check(isa, 2, tile);
                tile = tile == 64 ? 16 : 2 * tile;
            }
            for (const int threads : {1, 3, 5}) check(available_isas().back(), threads, threads == 3 ? 32 : 16);
        }
    }
    CHECK(changed >= 9);  // 18 in all: the variants have an effect
}

TEST_CASE("determinism: a region is the same part of the whole picture, and nothing else is written", "[raster][determinism]") {
    constexpr Region kRegions[] = {{0, 0, 1, 1}, {199, 149, 1, 1}, {37, 21, 100, 77}, {0, 149, 200, 1}, {63, 0, 2, 150}, {130, 60, 70, 90}};
    for (const NamedScene& s : scenes()) {
        for (const int samples : {1, 4}) {
            const Picture whole = draw(s, settings_of(*default_isa(), 2, 64, samples));
            for (const Region& r : kRegions) {
                halflit::test::Setup settings =
                    settings_of(available_isas()[static_cast<std::size_t>(r.width) % available_isas().size()], 1 + r.x % 2, 32, samples);
                settings.region = r;
                const Picture part = draw(s, settings);
                int differing = 0, touched = 0;
                for (int y = 0; y < kHeight; ++y)
                    for (int x = 0; x < kWidth; ++x) {
                        const auto at = static_cast<std::size_t>(4 * (y * kWidth + x));
                        if (x >= r.x && x < r.x + r.width && y >= r.y && y < r.y + r.height)
                            differing += std::memcmp(&part.rgba8[at], &whole.rgba8[at], 4) != 0 ||
                                         std::memcmp(&part.rgba_linear[at], &whole.rgba_linear[at], 16) != 0;
                        else
                            for (std::size_t c = 0; c < 4; ++c)
                                touched += part.rgba8[at + c] != 0xCD || part.rgba_linear[at + c] != -123.0f;
                    }
                INFO(s.name << ", samples " << samples << ", region " << r.x << "," << r.y << "," << r.width << "," << r.height);
                CHECK(differing == 0);
                CHECK(touched == 0);
            }
        }
    }
}

TEST_CASE("determinism: a host's own loop gives the same pixels, in any order and on any threads", "[raster][determinism]") {
    for (const NamedScene& s : scenes()) {
        halflit::test::Setup settings = settings_of(*default_isa(), 1, 32, 4);
        const Picture expected = draw(s, settings);
        int calls = 0;
        settings.execution.parallel_for = [&calls](int count, const std::function<void(int)>& body) {
            ++calls;
            for (int i = count - 1; i >= 0; --i) body(i);
        };
        CHECK(draw(s, settings) == expected);
        CHECK(calls > 0);
        settings.execution.parallel_for = host_loop(3);
        CHECK(draw(s, settings) == expected);
    }
}

TEST_CASE("determinism: a Renderer that drew other things before draws the same", "[raster][determinism]") {
    Renderer renderer;
    for (int round = 0; round < 2; ++round)
        for (const int samples : {8, 1, 4})
            for (const NamedScene& s : scenes()) {
                const halflit::test::Setup settings = settings_of(*default_isa(), 2, samples == 4 ? 64 : 16, samples);
                INFO(s.name << ", samples " << samples);
                CHECK(draw(s, settings, renderer) == draw(s, settings));
            }
}

TEST_CASE("determinism: three Renderers at once draw the same", "[raster][determinism]") {
    std::vector<Picture> expected;
    for (const NamedScene& s : scenes()) expected.push_back(draw(s, settings_of(*default_isa(), 1, 64, 1)));
    std::atomic<int> wrong{0}, drawn{0};
    const auto work = [&](std::size_t shift, int threads) {
        Renderer renderer;
        for (std::size_t i = 0; i < 2 * expected.size(); ++i) {
            const std::size_t which = (i + shift) % expected.size();
            wrong += !(draw(scenes()[which], settings_of(*default_isa(), threads, 64, 1), renderer) == expected[which]);
            ++drawn;
        }
    };
    std::thread a(work, 0, 2), b(work, 2, 3), c(work, 3, 1);
    a.join();
    b.join();
    c.join();
    CHECK(wrong == 0);
    CHECK(drawn == static_cast<int>(6 * expected.size()));
}

#if defined(__x86_64__)
TEST_CASE("determinism: the caller's floating-point environment neither matters nor changes", "[raster][determinism]") {
    constexpr unsigned kDefault = 0x1f80, kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
    constexpr unsigned kRoundDown = 0x2000, kRoundUp = 0x4000, kRoundToZero = 0x6000, kMaskAll = 0x1f80;
    struct Case {
        const char* name;
        unsigned csr;
    };
    // Exceptions that trap: invalid operation, division by zero, overflow (the mask bits are cleared).
    const Case cases[] = {{"flush to zero", kDefault | kFlushToZero | kDenormalsAreZero},
                          {"round up", kDefault | kRoundUp},
                          {"round down", kDefault | kRoundDown},
                          {"round to zero, flush", kDefault | kRoundToZero | kFlushToZero},
                          {"traps", kDefault & ~(0x0080u | 0x0200u | 0x0400u)}};
    const unsigned before = _mm_getcsr();
    for (const NamedScene& s : scenes()) {
        for (const int threads : {1, 2}) {
            const halflit::test::Setup settings = settings_of(*default_isa(), threads, 32, 4);
            const Picture expected = draw(s, settings);
            for (const Case& c : cases) {
                Picture p;
                p.rgba8.assign(4 * kWidth * kHeight, 0xCD);
                p.rgba_linear.assign(4 * kWidth * kHeight, -123.0f);
                Renderer renderer;
                _mm_setcsr(c.csr);
                const auto report = renderer.render(s.scene, s.camera, settings, {kWidth, kHeight, p.rgba8.data(), p.rgba_linear.data()},
                                                    settings.execution);
                const unsigned after = _mm_getcsr();
                _mm_setcsr(before);
                INFO(s.name << ", " << c.name << ", threads " << threads);
                REQUIRE(report);
                CHECK((after & (kMaskAll | kRoundToZero | kFlushToZero | kDenormalsAreZero)) == c.csr);
                CHECK(p == expected);
            }
        }
    }
}

TEST_CASE("determinism: a host's loop on threads with another floating-point environment gives the same pixels", "[raster][determinism]") {
    const NamedScene& s = scenes()[1];
    halflit::test::Setup settings = settings_of(*default_isa(), 1, 32, 1);
    const Picture expected = draw(s, settings);
    std::atomic<int> kept{0}, tasks{0};
    settings.execution.parallel_for = [&](int count, const std::function<void(int)>& body) {
        std::thread worker([&] {
            const unsigned csr = 0x1f80 | 0x8040 | 0x4000;
            _mm_setcsr(csr);
            for (int i = 0; i < count; ++i) {
                body(i);
                kept += (_mm_getcsr() & ~0x3fu) == (csr & ~0x3fu);
                ++tasks;
            }
        });
        worker.join();
    };
    CHECK(draw(s, settings) == expected);
    CHECK(kept == tasks);
    CHECK(tasks > 10);
}
#endif
