// The tiles that a triangle touches.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "raster/view/view.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace halflit::raster {

class TileGrid {
public:
    explicit TileGrid(const View& view) : view_(view), shift_(std::countr_zero(static_cast<unsigned>(view.tile_size))) {
        for (int s = 0; s < view.samples.count; ++s) {
            sample_min_x_ = std::min<int>(sample_min_x_, view.samples.x[s]);
            sample_max_x_ = std::max<int>(sample_max_x_, view.samples.x[s]);
            sample_min_y_ = std::min<int>(sample_min_y_, view.samples.y[s]);
            sample_max_y_ = std::max<int>(sample_max_y_, view.samples.y[s]);
        }
    }

    /// The pixels of the region, first and last, one of whose samples may lie in a triangle's box.
    struct Pixels {
        int x0, x1, y0, y1;
        [[nodiscard]] bool empty() const { return x0 > x1 || y0 > y1; }
    };
    [[nodiscard]] Pixels pixels(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) const {
        const int least_x = std::min({a.x, b.x, c.x}), most_x = std::max({a.x, b.x, c.x});
        const int least_y = std::min({a.y, b.y, c.y}), most_y = std::max({a.y, b.y, c.y});
        const Region& r = view_.region;
        return {std::max((least_x - sample_max_x_ + 255) >> 8, r.x), std::min((most_x - sample_min_x_) >> 8, r.x + r.width - 1),
                std::max((least_y - sample_max_y_ + 255) >> 8, r.y), std::min((most_y - sample_min_y_) >> 8, r.y + r.height - 1)};
    }

    /// The view's part of a kernel's arguments.
    void describe(BinArgs& args) const {
        const Region& r = view_.region;
        args.region_x = r.x;
        args.region_y = r.y;
        args.region_width = r.width;
        args.region_height = r.height;
        args.sample_min_x = sample_min_x_;
        args.sample_max_x = sample_max_x_;
        args.sample_min_y = sample_min_y_;
        args.sample_max_y = sample_max_y_;
        args.tile_shift = shift_;
        args.samples = view_.samples;
    }

    /// Columns and rows of tiles, first and last.
    struct Tiles {
        int x0, x1, y0, y1;
    };
    [[nodiscard]] Tiles tiles(const Pixels& p) const {
        const Region& r = view_.region;
        return {(p.x0 - r.x) >> shift_, (p.x1 - r.x) >> shift_, (p.y0 - r.y) >> shift_, (p.y1 - r.y) >> shift_};
    }

    /// True if a tile lies wholly outside one of the edges. a, b, c: in the order of positive area.
    [[nodiscard]] bool outside(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, int tx, int ty) const {
        const ScreenVertex* corner[4] = {&a, &b, &c, &a};
        const std::int64_t span = std::int64_t{256} * view_.tile_size;
        // From half a pixel before the first centre to half a pixel behind the last: all samples of the tile.
        const std::int64_t left = 256 * (view_.region.x + static_cast<std::int64_t>(tx) * view_.tile_size) - 128;
        const std::int64_t top = 256 * (view_.region.y + static_cast<std::int64_t>(ty) * view_.tile_size) - 128;
        bool outside = false;
        for (int k = 0; k < 3; ++k) {
            const ScreenVertex &p = *corner[k], &q = *corner[k + 1];
            const std::int64_t ea = p.y - q.y, eb = q.x - p.x;
            const std::int64_t x = ea > 0 ? left + span : left, y = eb > 0 ? top + span : top;
            outside |= ea * (x - p.x) + eb * (y - p.y) < 0;
        }
        return outside;
    }

    [[nodiscard]] int number(int tx, int ty) const { return ty * view_.tiles_x + tx; }

    /// Calls visit(tile number) for each tile that a triangle touches, row by row. a, b, c: in the order of positive area. box: its whole
    /// box counts.
    template <class Visit>
    void for_each(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, const Tiles& t, bool box, const Visit& visit) const {
        const bool all = box || t.x0 == t.x1 || t.y0 == t.y1;
        for (int ty = t.y0; ty <= t.y1; ++ty)
            for (int tx = t.x0; tx <= t.x1; ++tx)
                if (all || !outside(a, b, c, tx, ty)) visit(number(tx, ty));
    }

    /// True if for_each() would visit the tile.
    [[nodiscard]] bool touches(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, bool box, int tile) const {
        const Tiles t = tiles(pixels(a, b, c));
        const int tx = tile % view_.tiles_x, ty = tile / view_.tiles_x;
        if (tx < t.x0 || tx > t.x1 || ty < t.y0 || ty > t.y1) return false;
        return box || t.x0 == t.x1 || t.y0 == t.y1 || !outside(a, b, c, tx, ty);
    }

private:
    const View& view_;
    int sample_min_x_ = 0, sample_max_x_ = 0, sample_min_y_ = 0, sample_max_y_ = 0;
    int shift_;
};

}  // namespace halflit::raster
