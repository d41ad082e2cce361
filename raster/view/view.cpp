#include "raster/view/view.hpp"

#include "raster/view/projection.hpp"

namespace halflit::raster {
namespace {

SamplePattern sample_pattern(int samples) {
    // Standard sample positions of graphics hardware, rotated grids, in 1/16 pixel.
    static constexpr std::int8_t k4[4][2] = {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}};
    static constexpr std::int8_t k8[8][2] = {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}};
    SamplePattern p;
    p.count = samples;
    for (int s = 0; s < samples && samples > 1; ++s) {
        p.x[s] = static_cast<std::int16_t>(16 * (samples == 4 ? k4[s][0] : k8[s][0]));
        p.y[s] = static_cast<std::int16_t>(16 * (samples == 4 ? k4[s][1] : k8[s][1]));
    }
    return p;
}

}  // namespace

View make_view(const Camera& camera, int width, int height, const Region& region, int tile_size, int samples) {
    View view;
    view.clip_from_world = clip_from_world(camera, static_cast<float>(width) / static_cast<float>(height));
    view.viewport.half_width = static_cast<float>(width) * 0.5f;
    view.viewport.half_height = static_cast<float>(height) * 0.5f;
    view.viewport.guard_x = static_cast<float>(kGuardBandPx) / view.viewport.half_width;
    view.viewport.guard_y = static_cast<float>(kGuardBandPx) / view.viewport.half_height;
    view.region = region.width != 0 ? region : Region{0, 0, width, height};
    view.tile_size = tile_size;
    view.tiles_x = (view.region.width + tile_size - 1) / tile_size;
    view.tiles_y = (view.region.height + tile_size - 1) / tile_size;
    view.samples = sample_pattern(samples);
    return view;
}

}  // namespace halflit::raster
