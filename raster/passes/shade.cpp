// The shade pass: shades each visible pixel once for each triangle that it shows, packed by material into full blocks.
#include "raster/passes/count_work.hpp"
#include "raster/passes/picture_tile.hpp"
#include "raster/passes/shading_rate.hpp"

namespace halflit::raster {

TileCounts PictureTile::draw() {
    direct_ = samples_ == 1 && !pass_.view.geometry.has(AlphaMode::blend);
    const bool empty = pass_.view.geometry.tile_is_empty(tile_);
    if (empty) {
        fill_background();
    } else {
        draw_visibility(pass_.view, tile_, scratch_, counts_);
        clear();
    }
    if (pass_.output.has_planes()) write_planes(empty);
    if (empty) return counts_;
    shade_visible();
    if (!direct_) {
        blend_layers();
        resolve();
    }
    return counts_;
}

void PictureTile::shade_visible() {
    FragmentQueue& queue = scratch_.queue;
    queue.begin(pass_.view.materials.size());
    const auto flush = [&](FragmentList& list) {
        if (pass_.normals != nullptr) write_normals(list);
        shade(list);
        write(list);
        list.count = 0;
    };
    const ViewGeometry& geometry = pass_.view.geometry;
    const TileBuffers& buffers = scratch_.buffers;
    std::uint32_t last_id = kNoTriangle;
    FragmentList* list = nullptr;
    const auto push = [&](std::uint32_t id, int x, int y, int at, unsigned samples) {
        if (id != last_id) {
            last_id = id;
            list = &queue.of(geometry.draw_of(geometry.record(id)).material);
        }
        list->push(id, rect_.x + x, rect_.y + y, at, samples);
        if (list->full()) flush(*list);
    };
    for (int y = 0; y < rect_.height; ++y) {
        for (int x = 0; x < rect_.width; ++x) {
            const int at = y * kTileStride + x;
            if (samples_ == 1) {
                const std::uint32_t id = buffers.triangle[0][at];
                if (id == kNoTriangle) continue;
                ++counts_.pixels_visible;
                push(id, x, y, at, 1u);
                continue;
            }
            const unsigned all = (1u << samples_) - 1u;
            const std::uint32_t first = buffers.triangle[0][at];
            std::uint32_t mixed = 0;
            for (int s = 1; s < samples_; ++s) mixed |= buffers.triangle[s][at] ^ first;
            if (mixed == 0) {
                if (first == kNoTriangle) continue;
                ++counts_.pixels_visible;
                push(first, x, y, at, all);
                continue;
            }
            unsigned left = all;
            bool visible = false;
            while (left != 0) {
                const std::uint32_t id = buffers.triangle[__builtin_ctz(left)][at];
                unsigned samples = 0;
                for (int s = 0; s < samples_; ++s) samples |= buffers.triangle[s][at] == id ? 1u << s : 0u;
                left &= ~samples;
                if (id == kNoTriangle) continue;
                visible = true;
                push(id, x, y, at, samples);
            }
            counts_.pixels_visible += visible ? 1 : 0;
        }
    }
    for (std::size_t i = 0; i < queue.size(); ++i)
        if (queue[i].count > 0) flush(queue[i]);
}

void PictureTile::shade(FragmentList& list) {
    shading::FragmentBlock& block = scratch_.block;
    const shading::ShadingPlan& shading = plan_.shading;
    const shading::MaterialPlan& material = shading.materials[static_cast<std::size_t>(list.material)];
    interpolate(pass_.view, list, block);
    shading::LightList lights;
    if ((material.stages & kStagePrelit) != 0) {
        if (plan_.options.rate == ShadingRate::flat) light_triangles(pass_.view, shading, list, block, counts_.work);
    } else if ((material.stages & kStageLights) != 0) {
        lights = plan_.light_culler.select(shading.lights, block, list.count, scratch_.lights);
        count_lights(counts_.work, material, lights, list.count);
    }
    count_shading(counts_.work, material, list.count);
    if (pass_.reference != nullptr)
        pass_.reference->shade(pass_.view.shade, shading, list.material, block, list.count);
    else
        pass_.view.shade.shade(shading, material, lights, block, list.count);
    counts_.fragments_shaded += static_cast<std::uint64_t>(list.count);
    for (int l = 0; l < list.count; ++l) {
        const float sum = (block.red[l] + block.green[l]) + (block.blue[l] + block.alpha[l]);
        // A sum of infinities may be NaN although no term is: the terms are tested only if the sum is NaN.
        if (sum != sum && (block.red[l] != block.red[l] || block.green[l] != block.green[l] || block.blue[l] != block.blue[l] ||
                           block.alpha[l] != block.alpha[l]))
            ++counts_.nan_pixels;
    }
}

}  // namespace halflit::raster
