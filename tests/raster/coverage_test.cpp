// The visibility kernels of every instruction set against the brute-force reference: no pixel may differ.
#include "raster/kernels/raster_kernels.hpp"
#include "reference.hpp"
#include "tests/raster/kernel_fixture.hpp"
#include "tests/raster/random_triangles.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;
using halflit::test::available_isas;
using halflit::test::Random;

namespace {

constexpr std::uint32_t kIdBase = 3 * TriangleList::kChunk;

/// Coverage of every sample of a window, by the reference.
class Expected {
public:
    void compute(const FixedTriangle& t, const TileRect& window, const SamplePattern& pattern) {
        width_ = window.width;
        height_ = window.height;
        for (int s = 0; s < pattern.count; ++s)
            reference::cover_window(t, {window.x, window.y, window.width, window.height}, pattern.x[s], pattern.y[s], plane_[s]);
    }
    [[nodiscard]] bool at(int s, int x, int y) const { return plane_[s][y * width_ + x] != 0; }
    /// Number of wrong pixels of sample s: covered, but not by `id`; or not covered, but not kNoTriangle.
    [[nodiscard]] int differing(int s, const std::uint32_t* triangle, std::uint32_t id) const {
        int wrong = 0;
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) wrong += triangle[y * kTileStride + x] != (plane_[s][y * width_ + x] ? id : kNoTriangle);
        return wrong;
    }
    [[nodiscard]] int covered(int s) const {
        return static_cast<int>(std::count(plane_[s], plane_[s] + width_ * height_, std::uint8_t{1}));
    }

private:
    int width_ = 0, height_ = 0;
    std::uint8_t plane_[kMaxSamples][kMaxTileSize * kMaxTileSize];
};

struct Tally {
    std::int64_t triangles = 0, covered_samples = 0, differing_pixels = 0, skipped_without_area = 0;
};

/// `count` random triangles, each alone in a tile, on every instruction set.
Tally compare_rasterize(std::uint64_t seed, int tile, int samples, int count) {
    Random random(seed);
    Tally tally;
    const SamplePattern pattern = standard_samples(samples);
    const auto buffers = std::make_unique<TileBuffers>();
    const auto expected = std::make_unique<Expected>();
    const auto isas = available_isas();
    TriangleList list(kIdBase);
    while (tally.triangles < count) {
        const Place place(random, tile);
        TriangleSampler sampler(random, place);
        for (int i = 0; i < 50; ++i) {
            const FixedTriangle t = sampler.any();
            if (doubled_area(t) == 0) {
                ++tally.skipped_without_area;  // set-up drops these before any kernel sees them
                continue;
            }
            expected->compute(t, place.window, pattern);
            list.clear();
            list.add(t, {0.25f, 0.5f, 0.75f});
            for (const Isa isa : isas) {
                clear_tile(*buffers, pattern, place.window.height);
                raster_kernels(isa).rasterize(place.window, pattern, *buffers, list.table(), list.ids(), 1);
                for (int s = 0; s < samples; ++s) tally.differing_pixels += expected->differing(s, buffers->triangle[s], kIdBase);
            }
            ++tally.triangles;
            for (int s = 0; s < samples; ++s) tally.covered_samples += expected->covered(s);
        }
    }
    return tally;
}

}  // namespace

TEST_CASE("reference: the top-left rule on a square of two triangles", "[raster][coverage]") {
    // Corners on the centres of pixels 0 and 4: left and top edges are in, right and bottom ones are out.
    const FixedPoint a{0, 0}, b{1024, 0}, c{1024, 1024}, d{0, 1024};
    for (const bool flip : {false, true}) {
        const FixedTriangle upper = flip ? FixedTriangle{{a, c, b}} : FixedTriangle{{a, b, c}};
        const FixedTriangle lower = flip ? FixedTriangle{{d, c, a}} : FixedTriangle{{a, c, d}};
        for (int y = -1; y <= 5; ++y)
            for (int x = -1; x <= 5; ++x) {
                const bool in_square = x >= 0 && x < 4 && y >= 0 && y < 4;
                const bool in_upper = reference::covers(upper, {256 * x, 256 * y}), in_lower = reference::covers(lower, {256 * x, 256 * y});
                CHECK((in_upper || in_lower) == in_square);
                CHECK_FALSE((in_upper && in_lower));
                // The diagonal is a left edge of the upper triangle: the triangle lies to its right.
                if (in_square) CHECK(in_upper == (x >= y));
            }
    }
    CHECK_FALSE(reference::covers({{a, c, {512, 512}}}, {256, 256}));
}

TEST_CASE("coverage: a million random triangles, every pixel equals the reference", "[raster][coverage]") {
    struct Part {
        int tile, samples, triangles;
    };
    // Small windows allow many triangles; large windows run the code paths for large triangles.
    constexpr Part kParts[] = {{16, 1, 650'000}, {16, 4, 60'000}, {16, 8, 30'000}, {32, 1, 150'000}, {32, 4, 15'000},
                               {32, 8, 8'000},   {64, 1, 75'000}, {64, 4, 7'000},  {64, 8, 5'000}};
    std::int64_t triangles = 0;
    for (const Part& part : kParts) {
        const Tally tally =
            compare_rasterize(1000 + static_cast<std::uint64_t>(10 * part.tile + part.samples), part.tile, part.samples, part.triangles);
        INFO("tile " << part.tile << ", samples " << part.samples);
        CHECK(tally.differing_pixels == 0);
        CHECK(tally.covered_samples > 10 * tally.triangles);  // enough covered samples to compare
        triangles += tally.triangles;
    }
    CHECK(triangles >= 1'000'000);
}

TEST_CASE("coverage: each kind of difficult triangle equals the reference, in every tile size", "[raster][coverage]") {
    for (int kind = 0; kind < TriangleSampler::kKinds; ++kind) {
        Random random(77 + static_cast<std::uint64_t>(kind));
        const auto buffers = std::make_unique<TileBuffers>();
        const auto expected = std::make_unique<Expected>();
        std::int64_t wrong = 0, drawn = 0;
        for (int i = 0; i < 300; ++i) {
            const int tile = 16 << (i % 3);
            const SamplePattern pattern = standard_samples(i % 2 ? 1 : 4);
            const Place place(random, tile);
            const FixedTriangle t = TriangleSampler(random, place).of(static_cast<TriangleSampler::Kind>(kind));
            if (doubled_area(t) == 0) continue;
            TriangleList list(kIdBase);
            list.add(t, {0.25f, 0.5f, 0.75f});
            expected->compute(t, place.window, pattern);
            for (const Isa isa : available_isas()) {
                clear_tile(*buffers, pattern, place.window.height);
                raster_kernels(isa).rasterize(place.window, pattern, *buffers, list.table(), list.ids(), 1);
                for (int s = 0; s < pattern.count; ++s) wrong += expected->differing(s, buffers->triangle[s], kIdBase);
            }
            ++drawn;
        }
        INFO("kind " << kind);
        CHECK(wrong == 0);
        CHECK(drawn > 100);
    }
}

TEST_CASE("coverage: triangles drawn where they cover have the depths of opaque ones", "[raster][coverage]") {
    Random random(11);
    const auto opaque = std::make_unique<TileBuffers>(), masked = std::make_unique<TileBuffers>();
    TriangleList list(kIdBase);
    std::int64_t wrong = 0, drawn = 0;
    for (int i = 0; i < 12'000; ++i) {
        const SamplePattern pattern = standard_samples(i % 5 == 0 ? (i % 2 == 0 ? 8 : 16) : i % 5 < 3 ? 1 : 4);
        const Place place(random, 16 << (i % 3));
        const FixedTriangle t = TriangleSampler(random, place).any();
        if (doubled_area(t) == 0) continue;
        list.clear();
        list.add(t, {random.real32(0.0, 1.0), random.real32(0.0, 1.0), random.real32(0.0, 1.0)});
        for (const Isa isa : available_isas()) {
            const RasterKernels& kernels = raster_kernels(isa);
            for (TileBuffers* buffers : {opaque.get(), masked.get()}) clear_tile(*buffers, pattern, place.window.height);
            std::memset(masked->coverage, 0, sizeof masked->coverage);
            kernels.rasterize(place.window, pattern, *opaque, list.table(), list.ids(), 1);
            kernels.cover(place.window, pattern, *masked, list.source(), 0);
            kernels.draw_covered(place.window, pattern, *masked, list.source(), 0);
            for (int s = 0; s < pattern.count; ++s)
                for (int y = 0; y < place.window.height; ++y)
                    for (int x = 0; x < place.window.width; ++x) {
                        const int at = y * kTileStride + x;
                        wrong += std::memcmp(&opaque->depth[s][at], &masked->depth[s][at], sizeof(float)) != 0;
                        drawn += opaque->triangle[s][at] == kIdBase;
                    }
        }
    }
    CHECK(wrong == 0);
    CHECK(drawn > 100'000);
}

TEST_CASE("coverage: cover marks exactly the samples, within its box, and draw_covered draws no others", "[raster][coverage]") {
    Random random(5);
    const auto buffers = std::make_unique<TileBuffers>();
    const auto expected = std::make_unique<Expected>();
    TriangleList list(kIdBase);
    std::int64_t wrong_bits = 0, outside_box = 0, wrong_draws = 0, covered = 0;
    for (int i = 0; i < 12'000; ++i) {
        const int tile = 16 << (i % 3);
        const SamplePattern pattern = standard_samples(i % 5 == 0 ? (i % 2 == 0 ? 8 : 16) : i % 5 < 3 ? 1 : 4);
        const Place place(random, tile);
        const FixedTriangle t = TriangleSampler(random, place).any();
        if (doubled_area(t) == 0) continue;
        expected->compute(t, place.window, pattern);
        list.clear();
        list.add(t, {0.25f, 0.5f, 0.75f});
        const std::uint64_t keep_seed = static_cast<std::uint64_t>(random.integer(0, 1 << 30));
        for (const Isa isa : available_isas()) {
            const RasterKernels& kernels = raster_kernels(isa);
            clear_tile(*buffers, pattern, place.window.height);
            std::memset(buffers->coverage, 0, sizeof buffers->coverage);
            const CoverBox box = kernels.cover(place.window, pattern, *buffers, list.source(), 0);
            Random keep(keep_seed);
            std::vector<std::uint16_t> kept(kTilePixels, 0);
            for (int at = 0; at < kTilePixels; ++at) {
                const int x = at % kTileStride, y = at / kTileStride;
                unsigned want = 0;
                if (x < place.window.width && y < place.window.height)
                    for (int s = 0; s < pattern.count; ++s) want |= expected->at(s, x, y) ? 1u << s : 0u;
                wrong_bits += buffers->coverage[at] != want;
                if (want == 0) continue;
                outside_box += x < box.x0 || x > box.x1 || y < box.y0 || y > box.y1;
                covered += 1;
                // Drops half of the pixels, as an alpha test does.
                if (keep.chance(0.5)) buffers->coverage[at] = 0;
                kept[static_cast<std::size_t>(at)] = buffers->coverage[at];
            }
            kernels.draw_covered(place.window, pattern, *buffers, list.source(), 0);
            for (int s = 0; s < pattern.count; ++s)
                for (int y = 0; y < place.window.height; ++y)
                    for (int x = 0; x < place.window.width; ++x) {
                        const int at = y * kTileStride + x;
                        const bool drawn = buffers->triangle[s][at] == kIdBase;
                        wrong_draws += drawn != (((kept[static_cast<std::size_t>(at)] >> s) & 1u) != 0);
                        wrong_draws += !drawn && buffers->depth[s][at] != 0.0f;
                    }
        }
    }
    CHECK(wrong_bits == 0);
    CHECK(outside_box == 0);
    CHECK(wrong_draws == 0);
    CHECK(covered > 100'000);
}

TEST_CASE("coverage: triangles that share edges cover every sample once", "[raster][coverage]") {
    Random random(11);
    const auto buffers = std::make_unique<TileBuffers>();
    std::int64_t samples_checked = 0, not_once = 0;
    const auto isas = available_isas();
    for (int round = 0; round < 120; ++round) {
        const int tile = 16 << (round % 3);
        const SamplePattern pattern = standard_samples(round % 4 == 0 ? 4 : 1);
        const Place place(random, tile);
        const RasterKernels& kernels = raster_kernels(isas[static_cast<std::size_t>(round) % isas.size()]);
        // Grid of cells with random diagonals. The corners are moved by less than a quarter cell, so that no triangle turns over. Cells are
        // from smaller than a pixel to larger than the tile; some grids lie exactly on pixel centres.
        const std::int64_t cell = random.chance(0.3) ? 256 * random.integer(1, 8) : random.integer(40, 256 * 24);
        const std::int64_t shake = random.chance(0.3) ? 0 : cell / 4 - 1;
        const std::int64_t x0 = 256 * (place.window.x - 1) - cell, y0 = 256 * (place.window.y - 1) - cell;
        const auto columns = (256 * (place.window.width + 2)) / cell + 3, rows = (256 * (place.window.height + 2)) / cell + 3;
        if (columns * rows > 8000) continue;
        std::vector<FixedPoint> grid;
        for (std::int64_t j = 0; j <= rows; ++j)
            for (std::int64_t i = 0; i <= columns; ++i)
                grid.push_back({x0 + i * cell + random.integer(-shake, shake), y0 + j * cell + random.integer(-shake, shake)});
        const auto corner = [&](std::int64_t i, std::int64_t j) { return grid[static_cast<std::size_t>(j * (columns + 1) + i)]; };

        std::vector<int> times(static_cast<std::size_t>(kMaxSamples * kTilePixels), 0);
        TriangleList list(kIdBase);
        for (std::int64_t j = 0; j < rows; ++j)
            for (std::int64_t i = 0; i < columns; ++i) {
                const FixedPoint q[4] = {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
                const int d = random.index(2);
                for (int half = 0; half < 2; ++half) {
                    const int turn = random.index(3);
                    const FixedPoint p[3] = {q[d], q[(d + 1 + half) % 4], q[(d + 2 + half) % 4]};
                    const FixedTriangle t{{p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3]}};
                    if (doubled_area(t) == 0) continue;
                    REQUIRE(doubled_area(t) > 0);
                    list.clear();
                    list.add(t, {0.25f, 0.5f, 0.75f});
                    clear_tile(*buffers, pattern, place.window.height);
                    kernels.rasterize(place.window, pattern, *buffers, list.table(), list.ids(), 1);
                    for (int s = 0; s < pattern.count; ++s)
                        for (int y = 0; y < place.window.height; ++y)
                            for (int x = 0; x < place.window.width; ++x)
                                times[static_cast<std::size_t>(s * kTilePixels + y * kTileStride + x)] +=
                                    buffers->triangle[s][y * kTileStride + x] == kIdBase;
                }
            }
        for (int s = 0; s < pattern.count; ++s)
            for (int y = 0; y < place.window.height; ++y)
                for (int x = 0; x < place.window.width; ++x) {
                    ++samples_checked;
                    not_once += times[static_cast<std::size_t>(s * kTilePixels + y * kTileStride + x)] != 1;
                }
    }
    CHECK(not_once == 0);
    CHECK(samples_checked > 50'000);
}

TEST_CASE("coverage: a fan around a pixel centre covers that pixel once", "[raster][coverage]") {
    Random random(23);
    const auto buffers = std::make_unique<TileBuffers>();
    const SamplePattern pattern = standard_samples(1);
    const TileRect window{480, 272, 16, 16};
    const FixedPoint hub{256 * 487, 256 * 280};
    for (int round = 0; round < 400; ++round) {
        const int spokes = 3 + random.index(12);
        std::vector<FixedPoint> rim;
        for (int i = 0; i < spokes; ++i) {
            const double angle = 6.283185307179586 * (i + random.real(0.05, 0.95)) / spokes, r = random.real(20, 4000);
            rim.push_back({hub.x + static_cast<std::int64_t>(r * std::cos(angle)), hub.y + static_cast<std::int64_t>(r * std::sin(angle))});
        }
        int times = 0;
        bool around = true;  // every sector is below half a turn, else the triangles are no fan
        for (int i = 0; i < spokes; ++i)
            around &= doubled_area({{hub, rim[static_cast<std::size_t>(i)], rim[static_cast<std::size_t>((i + 1) % spokes)]}}) > 0;
        if (!around) continue;
        for (int i = 0; i < spokes; ++i) {
            TriangleList list(kIdBase);
            list.add({{hub, rim[static_cast<std::size_t>(i)], rim[static_cast<std::size_t>((i + 1) % spokes)]}}, {0.5f, 0.5f, 0.5f});
            clear_tile(*buffers, pattern, window.height);
            const auto isas = available_isas();
            raster_kernels(isas[static_cast<std::size_t>(round) % isas.size()])
                .rasterize(window, pattern, *buffers, list.table(), list.ids(), 1);
            times += buffers->triangle[0][8 * kTileStride + 7] == kIdBase;
        }
        CHECK(times == 1);
    }
}

TEST_CASE("visibility: each sample shows the nearest of many triangles, and of equally near ones the first", "[raster][coverage]") {
    Random random(31);
    const auto one = std::make_unique<TileBuffers>(), all = std::make_unique<TileBuffers>();
    const auto expected = std::make_unique<Expected>();
    std::int64_t wrong = 0, contested = 0;
    for (int round = 0; round < 250; ++round) {
        const int tile = 16 << (round % 3);
        const SamplePattern pattern = standard_samples(round % 8 == 0 ? 16 : round % 4 == 0 ? 8 : round % 4 == 1 ? 4 : 1);
        const Place place(random, tile);
        TriangleSampler sampler(random, place);
        TriangleList list(kIdBase);
        std::vector<FixedTriangle> triangles;
        while (triangles.size() < 30) {
            FixedTriangle t = sampler.any();
            if (!triangles.empty() && random.chance(0.3))
                t = triangles[static_cast<std::size_t>(random.index(static_cast<int>(triangles.size())))];
            if (doubled_area(t) == 0) continue;
            // Few different depths, so that ties are common. Some triangles have one depth, others do not.
            const float z = 0.125f * static_cast<float>(1 + random.index(6));
            if (random.chance(0.7))
                list.add(t, {z, z, z});
            else
                list.add(t, {z, random.real32(0.01, 1), random.real32(0.01, 1)});
            triangles.push_back(t);
        }
        for (const Isa isa : available_isas()) {
            const RasterKernels& kernels = raster_kernels(isa);
            std::vector<float> nearest(static_cast<std::size_t>(kMaxSamples) * kTilePixels, 0.0f);
            std::vector<std::uint32_t> first(nearest.size(), kNoTriangle);
            for (int i = 0; i < list.count(); ++i) {
                expected->compute(triangles[static_cast<std::size_t>(i)], place.window, pattern);
                clear_tile(*one, pattern, place.window.height);
                kernels.rasterize(place.window, pattern, *one, list.table(), list.ids() + i, 1);
                for (int s = 0; s < pattern.count; ++s)
                    for (int y = 0; y < place.window.height; ++y)
                        for (int x = 0; x < place.window.width; ++x) {
                            if (!expected->at(s, x, y)) continue;
                            const auto at = static_cast<std::size_t>(s * kTilePixels + y * kTileStride + x);
                            const float z = one->depth[s][y * kTileStride + x];
                            contested += first[at] != kNoTriangle;
                            if (!(z > nearest[at])) continue;
                            nearest[at] = z;
                            first[at] = kIdBase + static_cast<std::uint32_t>(i);
                        }
            }
            clear_tile(*all, pattern, place.window.height);
            kernels.rasterize(place.window, pattern, *all, list.table(), list.ids(), list.count());
            for (int s = 0; s < pattern.count; ++s)
                for (int y = 0; y < place.window.height; ++y)
                    for (int x = 0; x < place.window.width; ++x) {
                        const auto at = static_cast<std::size_t>(s * kTilePixels + y * kTileStride + x);
                        wrong += all->triangle[s][y * kTileStride + x] != first[at] || all->depth[s][y * kTileStride + x] != nearest[at];
                    }
        }
    }
    CHECK(wrong == 0);
    CHECK(contested > 100'000);
}
