// Triangles in fixed point that are hard to rasterize, near a window of the picture.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "reference.hpp"
#include "tests/support/random.hpp"

#include <algorithm>
#include <iterator>

namespace halflit::raster::test {

using halflit::test::Random;
using reference::FixedPoint;
using reference::FixedTriangle;

/// A window of at most `tile` x `tile` pixels, anywhere in a picture of any size that the renderer takes.
struct Place {
    int picture_width, picture_height;
    TileRect window;

    Place(Random& random, int tile) {
        static constexpr int kSides[] = {64, 1080, 1920, 8192, 2 * kGuardBandPx};
        picture_width = kSides[random.index(std::size(kSides))];
        picture_height = kSides[random.index(std::size(kSides))];
        window.width = random.chance(0.75) ? tile : static_cast<int>(random.integer(1, tile));
        window.height = random.chance(0.75) ? tile : static_cast<int>(random.integer(1, tile));
        window.x = static_cast<int>(random.integer(0, picture_width - window.width));
        window.y = static_cast<int>(random.integer(0, picture_height - window.height));
    }
    /// The guard band around the middle of the picture, fixed point: window position p is (p - 0.5) * 256.
    [[nodiscard]] std::int64_t low_x() const { return 128 * picture_width - 128 - 256 * kGuardBandPx; }
    [[nodiscard]] std::int64_t low_y() const { return 128 * picture_height - 128 - 256 * kGuardBandPx; }
    [[nodiscard]] std::int64_t high_x() const { return low_x() + 512 * kGuardBandPx; }
    [[nodiscard]] std::int64_t high_y() const { return low_y() + 512 * kGuardBandPx; }
    [[nodiscard]] FixedPoint in_guard_band(FixedPoint p) const {
        return {std::clamp(p.x, low_x(), high_x()), std::clamp(p.y, low_y(), high_y())};
    }
};

class TriangleSampler {
public:
    enum Kind { near_window, tiny, sliver, on_grid, axis_aligned, huge, off_screen, extreme, kKinds };

    TriangleSampler(Random& random, const Place& place) : random_(random), place_(place) {}

    FixedTriangle any() { return of(static_cast<Kind>(random_.index(kKinds))); }

    FixedTriangle of(Kind kind) {
        const std::int64_t w = 256 * place_.window.width, h = 256 * place_.window.height;
        switch (kind) {
            case near_window:
                return held(around(w, h), around(w, h), around(w, h));
            case tiny: {
                const FixedPoint p = around(0, 0);
                return held(p, step(p, 300), step(p, 300));
            }
            case sliver: {
                // The third corner lies within two units of the line through the other two, anywhere along it.
                const std::int64_t reach = random_.chance(0.5) ? 2 * std::max(w, h) : 256 * kGuardBandPx;
                const FixedPoint p = around(0, 0), a = step(p, reach), b = through(a, p);
                const double t = random_.real(-0.2, 1.2);
                const FixedPoint on{a.x + static_cast<std::int64_t>(t * static_cast<double>(b.x - a.x)),
                                    a.y + static_cast<std::int64_t>(t * static_cast<double>(b.y - a.y))};
                return held(a, b, step(on, 2));
            }
            case on_grid: {
                // Corners on multiples of a pixel, of half a pixel or of a sixteenth, where pixel centres and samples lie; often edges too.
                const std::int64_t grid = random_.chance(0.5) ? 256 : random_.chance(0.5) ? 128 : 16;
                return held(snapped(around(w, h), grid), snapped(around(w, h), grid), snapped(around(w, h), grid));
            }
            case axis_aligned: {
                const std::int64_t grid = random_.chance(0.5) ? 256 : 1;
                const FixedPoint a = snapped(around(w, h), grid), b = snapped(around(w, h), grid);
                return random_.chance(0.5) ? held(a, {b.x, a.y}, {a.x, b.y}) : held({b.x, a.y}, b, {a.x, a.y});
            }
            case huge: {
                const FixedPoint p = around(0, 0), a = anywhere();
                return held(a, through(a, p), anywhere());
            }
            case off_screen: {
                const std::int64_t dx = random_.integer(-2, 2) * w, dy = random_.integer(-2, 2) * h;
                FixedTriangle t = held(around(w, h), around(w, h), around(w, h));
                for (FixedPoint& p : t.corner) p = place_.in_guard_band({p.x + dx, p.y + dy});
                return t;
            }
            default:
                return held(extreme_point(), extreme_point(), random_.chance(0.5) ? extreme_point() : anywhere());
        }
    }

private:
    FixedTriangle held(FixedPoint a, FixedPoint b, FixedPoint c) const {
        return {{place_.in_guard_band(a), place_.in_guard_band(b), place_.in_guard_band(c)}};
    }
    /// Point in the window, or up to (margin_x, margin_y) outside of it.
    FixedPoint around(std::int64_t margin_x, std::int64_t margin_y) {
        const TileRect& r = place_.window;
        return {random_.integer(256 * r.x - 128 - margin_x, 256 * (r.x + r.width) - 128 + margin_x),
                random_.integer(256 * r.y - 128 - margin_y, 256 * (r.y + r.height) - 128 + margin_y)};
    }
    FixedPoint step(FixedPoint p, std::int64_t most) { return {p.x + random_.integer(-most, most), p.y + random_.integer(-most, most)}; }
    FixedPoint anywhere() { return {random_.integer(place_.low_x(), place_.high_x()), random_.integer(place_.low_y(), place_.high_y())}; }
    /// Point on the other side of p, so that the edge from a to it crosses the window.
    FixedPoint through(FixedPoint a, FixedPoint p) {
        const double t = random_.real(0.1, 1.0);
        return {p.x + static_cast<std::int64_t>(t * static_cast<double>(p.x - a.x)),
                p.y + static_cast<std::int64_t>(t * static_cast<double>(p.y - a.y))};
    }
    static FixedPoint snapped(FixedPoint p, std::int64_t grid) { return {p.x / grid * grid, p.y / grid * grid}; }
    FixedPoint extreme_point() {
        FixedPoint p{random_.chance(0.5) ? place_.low_x() : place_.high_x(), random_.chance(0.5) ? place_.low_y() : place_.high_y()};
        if (random_.chance(0.3)) p = {p.x, random_.integer(place_.low_y(), place_.high_y())};
        return p;
    }

    Random& random_;
    const Place& place_;
};

}  // namespace halflit::raster::test
