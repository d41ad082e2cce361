// A view: a camera, a window, and the window's tiles. The picture is a view, and so is each face of a shadow map.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/settings.hpp"
#include "raster/kernels/raster_kernels.hpp"
#include "raster/view/point_sizes.hpp"

namespace halflit::raster {

struct View {
    Mat4 clip_from_world;
    Viewport viewport;
    Region region;  ///< the pixels that are drawn: inside the window, never empty
    int tile_size = 64, tiles_x = 0, tiles_y = 0;
    SamplePattern samples;
    /// Width of lines and side of points, in 1/256 pixel; 0: they are not drawn. Faces of shadow maps leave them out.
    int line_width = 0, point_size = 0;
    PointSizes point_sizes;  ///< of points, by their place; point_size is the largest. Empty: all have that
    /// Depths of lines are line_depth_scale * z + line_depth_offset (lift_lines).
    float line_depth_scale = 1.0f, line_depth_offset = 0.0f;
    bool mirrored = false;  ///< clip_from_world mirrors, or the sides of all faces change places: fronts are left out instead of backs

    [[nodiscard]] int tile_count() const { return tiles_x * tiles_y; }
    [[nodiscard]] TileRect tile_rect(int tile) const {
        const int x = region.x + (tile % tiles_x) * tile_size, y = region.y + (tile / tiles_x) * tile_size;
        const int right = region.x + region.width, bottom = region.y + region.height;
        return {x, y, right - x < tile_size ? right - x : tile_size, bottom - y < tile_size ? bottom - y : tile_size};
    }
    friend bool operator==(const View&, const View&) = default;
};

/// The common part of a rectangle and a region; its sizes are 0 if there is none.
[[nodiscard]] inline TileRect intersection(const TileRect& rect, const Region& region) {
    const auto side = [](int a, int a_size, int b, int b_size, int& size) {
        const int first = a > b ? a : b, a_end = a + a_size, b_end = b + b_size, end = a_end < b_end ? a_end : b_end;
        size = end > first ? end - first : 0;
        return first;
    };
    TileRect both{};
    both.x = side(rect.x, rect.width, region.x, region.width, both.width);
    both.y = side(rect.y, rect.height, region.y, region.height, both.height);
    return both;
}

/// View of a camera through a window of width x height pixels, of which only `region` is drawn. samples: 1, 4, 8 or 16.
[[nodiscard]] View make_view(const Camera& camera, int width, int height, const Region& region, int tile_size, int samples);

/// The same of any matrix.
[[nodiscard]] View make_view(const Mat4& clip_from_world, int width, int height, const Region& region, int tile_size, int samples);

/// Draws another region of the window.
void set_region(View& view, const Region& region);

/// Lets lines of this width, in pixels, lie before the surfaces that they lie on: nearer by as much as such a surface, tilted by up to 63
/// degrees, rises within half the width of the line. In perspective that is a share of the distance.
void lift_lines(View& view, const Camera& camera, double width_px);

}  // namespace halflit::raster
