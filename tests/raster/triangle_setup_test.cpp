// Lists of triangles, which the kernels set up side by side, on every instruction set against scalar: each bit of depth and each number.
#include "raster/kernels/raster_kernels.hpp"
#include "shading/plan/shadow_map_plan.hpp"
#include "tests/raster/kernel_fixture.hpp"
#include "tests/raster/random_triangles.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;
using halflit::test::available_isas;
using halflit::test::Random;

namespace {

/// Two chunks of triangles around a tile; every third vertex is a clip vertex of its chunk.
struct Chunks {
    std::vector<ScreenVertex> vertices, clip_vertices[2];
    std::vector<TriangleRecord> records[2];
    std::vector<std::uint32_t> ids;
    TriangleSource sources[2];
    static constexpr int kLocalBits = 16;

    std::uint32_t add(const FixedPoint& p, float z, std::size_t chunk) {
        const ScreenVertex v{static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y), z, 1.0f};
        auto& list = (vertices.size() + clip_vertices[0].size() + clip_vertices[1].size()) % 3 == 0 ? clip_vertices[chunk] : vertices;
        list.push_back(v);
        return static_cast<std::uint32_t>(list.size() - 1) | (&list == &vertices ? 0u : kClipVertex);
    }
    void add(const FixedTriangle& t, const float (&z)[3], std::size_t chunk) {
        TriangleRecord r{{add(t.corner[0], z[0], chunk), add(t.corner[1], z[1], chunk), add(t.corner[2], z[2], chunk)}, 0};
        if (doubled_area(t) < 0) std::swap(r.vertex[1], r.vertex[2]);
        ids.push_back(static_cast<std::uint32_t>(chunk << kLocalBits | records[chunk].size()));
        records[chunk].push_back(r);
    }
    TriangleTable table() {
        for (std::size_t c = 0; c < 2; ++c)
            sources[c] = {records[c].data(), vertices.data(), clip_vertices[c].data(), static_cast<std::uint32_t>(c << kLocalBits)};
        return {sources, kLocalBits};
    }
};

/// Samples at which a set's depths or numbers differ from scalar's.
std::int64_t differing(const TileBuffers& a, const TileBuffers& b, const SamplePattern& pattern, const TileRect& tile) {
    std::int64_t wrong = 0;
    for (int s = 0; s < pattern.count; ++s)
        for (int y = 0; y < tile.height; ++y)
            for (int x = 0; x < tile.width; ++x) {
                const int at = y * kTileStride + x;
                wrong += a.triangle[s][at] != b.triangle[s][at] || std::memcmp(&a.depth[s][at], &b.depth[s][at], 4) != 0;
            }
    return wrong;
}

std::int64_t count_numbered(const TileBuffers& buffers, const SamplePattern& pattern, const TileRect& tile) {
    std::int64_t count = 0;
    for (int s = 0; s < pattern.count; ++s)
        for (int y = 0; y < tile.height; ++y)
            count += std::count_if(buffers.triangle[s] + y * kTileStride, buffers.triangle[s] + y * kTileStride + tile.width,
                                   [](std::uint32_t id) { return id != kNoTriangle; });
    return count;
}

/// Mostly triangles of a pixel or a few, some as wide as a vector, and some of every difficult kind.
FixedTriangle any_size(Random& random, TriangleSampler& sampler, const TileRect& tile) {
    if (random.chance(0.15)) return sampler.any();
    const std::int64_t reach = random.chance(0.6) ? 400 : random.chance(0.7) ? 2500 : 16500;
    const std::int64_t x = 256 * tile.x + random.integer(-512, 256 * tile.width + 512);
    const std::int64_t y = 256 * tile.y + random.integer(-512, 256 * tile.height + 512);
    const auto near = [&] { return FixedPoint{x + random.integer(-reach, reach), y + random.integer(-reach, reach)}; };
    return {{near(), near(), near()}};
}

}  // namespace

TEST_CASE("triangle set-up: lists of every size of triangle have scalar's depths and numbers, bit for bit", "[raster][coverage]") {
    Random random(2024);
    const auto want = std::make_unique<TileBuffers>(), got = std::make_unique<TileBuffers>();
    std::int64_t wrong = 0, covered = 0, numbered = 0;  // numbered: samples whose number depth alone should not write
    for (int round = 0; round < 600; ++round) {
        const Place place(random, 16 << (round % 3));
        const SamplePattern pattern = standard_samples(round % 5 == 0 ? (round % 2 == 0 ? 8 : 16) : round % 5 < 3 ? 4 : 1);
        TriangleSampler sampler(random, place);
        Chunks chunks;
        const auto count = static_cast<std::size_t>(random.integer(1, 150));
        while (chunks.ids.size() < count) {
            FixedTriangle t = any_size(random, sampler, place.window);
            for (FixedPoint& p : t.corner) p = place.in_guard_band(p);
            if (doubled_area(t) == 0) continue;
            // Few different depths, so that ties occur.
            const float z = 0.25f * static_cast<float>(1 + random.index(3));
            const bool flat = random.chance(0.3);
            chunks.add(t, {z, flat ? z : random.real32(0, 1), flat ? z : random.real32(0, 1)}, random.index(2) == 0 ? 0u : 1u);
        }
        const TriangleTable table = chunks.table();
        clear_tile(*want, pattern, place.window.height);
        // One at a time, so that no triangle has neighbours in a vector.
        for (const std::uint32_t id : chunks.ids) raster_kernels(Isa::scalar).rasterize(place.window, pattern, *want, table, &id, 1);
        for (const Isa isa : available_isas()) {
            clear_tile(*got, pattern, place.window.height);
            raster_kernels(isa).rasterize(place.window, pattern, *got, table, chunks.ids.data(), static_cast<int>(count));
            wrong += differing(*want, *got, pattern, place.window);
            clear_tile(*got, pattern, place.window.height);
            raster_kernels(isa).rasterize_depth(place.window, pattern, *got, table, chunks.ids.data(), static_cast<int>(count));
            numbered += count_numbered(*got, pattern, place.window);
            for (int s = 0; s < pattern.count; ++s) std::memcpy(got->triangle[s], want->triangle[s], sizeof got->triangle[s]);
            wrong += differing(*want, *got, pattern, place.window);
        }
        for (int y = 0; y < place.window.height; ++y)
            covered += std::count_if(want->triangle[0] + y * kTileStride, want->triangle[0] + y * kTileStride + place.window.width,
                                     [](std::uint32_t id) { return id != kNoTriangle; });
    }
    CHECK(wrong == 0);
    CHECK(numbered == 0);
    CHECK(covered > 100'000);
}

TEST_CASE("shadow map distances: every set has scalar's, bit for bit, and no blocker where nothing was drawn", "[raster][kernels]") {
    constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> depths{0.0f, -0.0f, 1.0f, -1.0f, 1e-45f, 1e-38f, 3e38f, kInf, -kInf, kNan};
    Random random(77);
    while (depths.size() < 67) depths.push_back(random.real32(0, 1));
    for (const DepthRange range : {DepthRange{0.01f, 100.0f, true}, DepthRange{1e-30f, 1e30f, true}, DepthRange{-5.0f, 20.0f, false}}) {
        std::vector<float> want(depths.size());
        raster_kernels(Isa::scalar).distances(range, depths.data(), static_cast<int>(depths.size()), want.data());
        CHECK(want[0] == shading::kNoBlocker);
        CHECK(want[1] == shading::kNoBlocker);
        CHECK(want[2] == (range.perspective ? range.near_z : -5.0f));
        CHECK(want[9] == shading::kNoBlocker);
        for (const Isa isa : available_isas())
            for (const std::size_t count : {std::size_t{1}, std::size_t{16}, depths.size()}) {
                std::vector<float> got(depths.size() + 1, 7.0f);
                raster_kernels(isa).distances(range, depths.data(), static_cast<int>(count), got.data());
                CHECK(std::memcmp(got.data(), want.data(), count * sizeof(float)) == 0);
                CHECK(got[count] == 7.0f);
            }
    }
}
