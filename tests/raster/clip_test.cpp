// Corners of clipped triangles on the window's grid.
#include "raster/passes/clip.hpp"
#include "tests/support/catch.hpp"

#include <limits>

using namespace halflit;
using namespace halflit::raster;

TEST_CASE("clip: a corner that a rounding put far away is at the guard band's side, on every machine", "[raster]") {
    const Viewport viewport{.half_width = 32, .half_height = 7, .guard_x = kGuardBandPx / 32.0f, .guard_y = kGuardBandPx / 7.0f};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::int32_t left = (32 - kGuardBandPx) * 256 - 128, right = (32 + kGuardBandPx) * 256 - 128,
                       top = (7 - kGuardBandPx) * 256 - 128, bottom = (7 + kGuardBandPx) * 256 - 128;
    struct Row {
        double x, y;
        std::int32_t window_x, window_y;
    };
    for (const Row& row : {Row{0, 0, 32 * 256 - 128, 7 * 256 - 128},
                           {1, -1, 64 * 256 - 128, 14 * 256 - 128},
                           {1e16, 1e16, right, top},
                           {-1e300, -1e300, left, bottom},
                           {3e9, 2.5e9, right, top},
                           {nan, nan, left, top}}) {
        const ScreenVertex found = project({row.x, row.y, 0.5, 1}, viewport);
        CHECK(found.x == row.window_x);
        CHECK(found.y == row.window_y);
    }
}
