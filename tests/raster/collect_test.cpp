// Fragments of rows of pixels, by every instruction set, against a search through the samples of each pixel.
#include "raster/kernels/raster_kernels.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <memory>
#include <vector>

using namespace halflit;
using namespace halflit::raster;

namespace {

struct Fragment {
    std::uint32_t id;
    std::int32_t x_px, samples;
    friend bool operator==(const Fragment&, const Fragment&) = default;
};

std::vector<Fragment> expected(const TileBuffers& buffers, int samples, int at, int x_px, int count) {
    std::vector<Fragment> out;
    for (int x = 0; x < count; ++x) {
        const auto first = static_cast<std::ptrdiff_t>(out.size());
        for (int s = 0; s < samples; ++s) {
            const std::uint32_t id = buffers.triangle[s][at + x];
            if (id == kNoTriangle) continue;
            auto same = std::find_if(out.begin() + first, out.end(), [&](const Fragment& f) { return f.id == id; });
            if (same == out.end()) same = out.insert(out.end(), {id, x_px + x, 0});
            same->samples |= 1 << s;
        }
    }
    return out;
}

}  // namespace

TEST_CASE("collect: every triangle of every pixel once, in order, with its samples", "[raster][coverage]") {
    halflit::test::Random random(8);
    const auto buffers = std::make_unique<TileBuffers>();
    std::int64_t wrong = 0, several = 0;
    for (int round = 0; round < 6000; ++round) {
        const int samples = round % 3 == 0 ? 1 : round % 3 == 1 ? 4 : round % 2 == 0 ? 8 : 16;
        const int at = static_cast<int>(random.integer(0, 10)) * kTileStride + static_cast<int>(random.integer(0, kMaxTileSize - 1));
        const int count = static_cast<int>(random.integer(1, std::min(kPixelsARow, kMaxTileSize - at % kTileStride)));
        const int x_px = static_cast<int>(random.integer(0, 30000));
        // From one triangle all over to another one in each sample, with holes.
        const double change = random.real(0, 1), hole = random.chance(0.5) ? 0.0 : random.real(0, 1);
        const int triangles = random.chance(0.5) ? 3 : 1000;
        std::uint32_t id = 7;
        for (int i = at; i < at + kPixelsARow; ++i)
            for (int s = 0; s < samples; ++s) {
                if (random.chance(change * change)) id = static_cast<std::uint32_t>(random.index(triangles)) << random.index(20);
                buffers->triangle[s][i] = random.chance(hole * hole) ? kNoTriangle : id;
            }
        const std::vector<Fragment> want = expected(*buffers, samples, at, x_px, count);
        int pixels = 0;
        for (std::size_t i = 0; i < want.size(); ++i) pixels += i == 0 || want[i].x_px != want[i - 1].x_px;
        several += static_cast<int>(want.size()) > pixels;
        for (const Isa isa : halflit::test::available_isas()) {
            PixelFragments got;
            raster_kernels(isa).collect(*buffers, samples, at, x_px, count, got);
            wrong += got.pixels != pixels || got.count != static_cast<int>(want.size());
            for (std::size_t i = 0; i < want.size() && i < static_cast<std::size_t>(got.count); ++i)
                wrong += Fragment{got.id[i], got.x_px[i], got.samples[i]} != want[i];
        }
    }
    CHECK(wrong == 0);
    CHECK(several > 1000);
}
