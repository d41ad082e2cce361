// Threads, tiles, instruction sets, regions and earlier frames never show, over random scenes.
#include "tests/raster/metamorphic_shots.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

constexpr int kScenes = 60;

}  // namespace

TEST_CASE("metamorphic: random scenes have the same bits by every instruction set, with 1, 2 and 5 threads and all tiles",
          "[raster][metamorphic]") {
    std::uint64_t visible = 0;
    for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
        const Shot shot = any_shot(seed);
        const Pixels expected = draw(shot, execution_of(1, 64, Isa::scalar));
        visible += expected.visible;
        int turn = static_cast<int>(seed);
        for (const Isa isa : halflit::test::available_isas())
            for (const int threads : {1, 2, 5}) {
                const int tile = 16 << (turn++ % 3);
                INFO("seed " << seed << ", " << isa_name(isa) << ", threads " << threads << ", tiles " << tile);
                CHECK(differing(expected, draw(shot, execution_of(threads, tile, isa))) == 0);
            }
    }
    CHECK(visible > std::uint64_t{kScenes} * kViewWidth * kViewHeight / 10);
}

TEST_CASE("metamorphic: a region of a random scene is the same part of the whole picture", "[raster][metamorphic]") {
    for (std::uint64_t seed = 101; seed <= 100 + kScenes; ++seed) {
        check_regions(seed, any_shot(seed));
    }
}

TEST_CASE("metamorphic: a Renderer draws a random scene a second time, and after others, with the same bits", "[raster][metamorphic]") {
    Renderer kept;
    std::vector<Shot> shots;
    std::vector<Pixels> expected;
    for (std::uint64_t seed = 201; seed <= 200 + kScenes; ++seed) {
        shots.push_back(any_shot(seed));
        expected.push_back(draw(shots.back()));
    }
    for (int round = 0; round < 2; ++round)
        for (std::size_t i = 0; i < shots.size(); ++i)
            for (int again = 0; again < 2; ++again) {
                INFO("seed " << 201 + i << ", round " << round << ", again " << again);
                CHECK(differing(expected[i], draw(shots[i], kept)) == 0);
            }
}
