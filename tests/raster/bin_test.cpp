// Culling and binning of triangles side by side, on every instruction set: no triangle that a sample shows is dropped or misses its tile.
#include "raster/kernels/raster_kernels.hpp"
#include "tests/raster/kernel_fixture.hpp"
#include "tests/raster/random_triangles.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;
using halflit::test::available_isas;
using halflit::test::Random;

namespace {

struct Tally {
    std::int64_t lost = 0, wrong_tile = 0, wrong_side = 0, differs = 0, useless = 0, kept = 0, dropped = 0, left_to_caller = 0;
};

bool bit(std::uint64_t bits, std::size_t i) { return (bits >> i & 1) != 0; }

/// One batch around a region of at most a tile, binned into smaller tiles.
void compare(Random& random, Tally& tally) {
    const Place place(random, 64);
    const TileRect& region = place.window;
    const SamplePattern pattern = standard_samples(random.chance(0.5) ? 1 : random.chance(0.5) ? 4 : random.chance(0.5) ? 8 : 16);
    BinArgs args{};
    args.mirrored = random.chance(0.5);
    args.cull_back = random.chance(0.5);
    args.region_x = region.x, args.region_y = region.y, args.region_width = region.width, args.region_height = region.height;
    args.sample_min_x = std::min<int>(0, *std::min_element(pattern.x, pattern.x + pattern.count));
    args.sample_max_x = std::max<int>(0, *std::max_element(pattern.x, pattern.x + pattern.count));
    args.sample_min_y = std::min<int>(0, *std::min_element(pattern.y, pattern.y + pattern.count));
    args.sample_max_y = std::max<int>(0, *std::max_element(pattern.y, pattern.y + pattern.count));
    args.tile_shift = static_cast<int>(random.integer(4, 6));
    args.samples = pattern;
    const int count = static_cast<int>(random.integer(1, kBinnedAtOnce));
    std::vector<FixedTriangle> triangles;
    std::vector<ScreenVertex> screen;
    std::vector<std::uint8_t> outcodes;
    std::vector<std::uint32_t> index;
    TriangleSampler sampler(random, place);
    const bool codes = random.chance(0.3);
    for (int i = 0; i < count; ++i) {
        FixedTriangle t = sampler.any();
        const std::int64_t reach = random.chance(0.7) ? 300 : 3000;
        if (random.chance(0.7))
            for (int k = 1; k < 3; ++k)
                t.corner[k] =
                    place.in_guard_band({t.corner[0].x + random.integer(-reach, reach), t.corner[0].y + random.integer(-reach, reach)});
        triangles.push_back(t);
        for (const FixedPoint& p : t.corner) {
            index.push_back(static_cast<std::uint32_t>(screen.size()));
            screen.push_back({static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y), 0.5f, 1.0f});
            outcodes.push_back(codes && random.chance(0.3) ? static_cast<std::uint8_t>(1 << random.index(8)) : std::uint8_t{0});
        }
    }
    args.screen = screen.data();
    args.outcodes = outcodes.data();
    BinnedTriangles want{}, got{};
    raster_kernels(Isa::scalar).bin_triangles(args, index.data(), count, want);
    std::vector<std::uint8_t> plane(kMaxTileSize * kMaxTileSize);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const FixedTriangle& t = triangles[i];
        const unsigned c0 = outcodes[3 * i], c1 = outcodes[3 * i + 1], c2 = outcodes[3 * i + 2];
        const bool rejected = (c0 & c1 & c2 & kRejectWhenAll) != 0, clipped = ((c0 | c1 | c2) & (kNear | kGuard | kNotFinite)) != 0;
        const bool keep = bit(want.keep, i), other = bit(want.other, i);
        if (rejected || clipped) {
            tally.differs += keep || other == rejected;
            continue;
        }
        tally.left_to_caller += other;
        tally.kept += keep;
        tally.dropped += !keep && !other;
        if (other) continue;
        const std::int64_t area = doubled_area(t);
        const bool back = (area > 0) != args.mirrored, culled = area == 0 || (back && args.cull_back);
        if (culled) {
            tally.differs += keep;
            continue;
        }
        if (keep) tally.wrong_side += bit(want.back, i) != back || bit(want.swap, i) != (area < 0);
        int covered = 0;
        for (int s = 0; s < pattern.count; ++s) {
            reference::cover_window(t, {region.x, region.y, region.width, region.height}, pattern.x[s], pattern.y[s], plane);
            for (int y = 0; y < region.height; ++y)
                for (int x = 0; x < region.width; ++x) {
                    if (plane[static_cast<std::size_t>(y * region.width + x)] == 0) continue;
                    ++covered;
                    const int tx = x >> args.tile_shift, ty = y >> args.tile_shift;
                    tally.wrong_tile +=
                        keep && (tx < want.tile_x0[i] || tx > want.tile_x1[i] || ty < want.tile_y0[i] || ty > want.tile_y1[i]);
                }
        }
        tally.lost += !keep && covered > 0;
        // A triangle within half a pixel has a box of at most 2 x 2 pixels, of which it must cover a sample.
        const auto [x0, x1] = std::minmax({t.corner[0].x, t.corner[1].x, t.corner[2].x});
        const auto [y0, y1] = std::minmax({t.corner[0].y, t.corner[1].y, t.corner[2].y});
        tally.useless += keep && covered == 0 && x1 - x0 < 128 && y1 - y0 < 128;
    }
    for (const Isa isa : available_isas()) {
        raster_kernels(isa).bin_triangles(args, index.data(), count, got);
        tally.differs += got.keep != want.keep || got.other != want.other || got.back != want.back || got.swap != want.swap;
        for (std::size_t i = 0; i < triangles.size(); ++i)
            tally.differs += bit(want.keep, i) && (got.tile_x0[i] != want.tile_x0[i] || got.tile_x1[i] != want.tile_x1[i] ||
                                                   got.tile_y0[i] != want.tile_y0[i] || got.tile_y1[i] != want.tile_y1[i]);
    }
}

}  // namespace

TEST_CASE("bin: triangles that a sample shows are kept, with all of their tiles, alike on every set", "[raster][coverage]") {
    Random random(99);
    Tally tally;
    for (int round = 0; round < 1500; ++round) compare(random, tally);
    CHECK(tally.lost == 0);
    CHECK(tally.wrong_tile == 0);
    CHECK(tally.wrong_side == 0);
    CHECK(tally.differs == 0);
    CHECK(tally.useless == 0);
    CHECK(tally.kept > 3000);
    CHECK(tally.dropped > 5000);
    CHECK(tally.left_to_caller > 5000);
}
