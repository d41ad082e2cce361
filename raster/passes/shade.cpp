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
    last_id_ = kNoTriangle;
    std::fill(std::begin(scratch_.materials), std::end(scratch_.materials), TileScratch::MaterialOf{});
    if (plan_.cells) {
        constexpr int kSide = shading::kCellSide;  // tiles begin at cells
        for (int y0 = 0; y0 < rect_.height; y0 += kSide)
            for (int x0 = 0; x0 < rect_.width; x0 += kSide) {
                const int y1 = std::min(y0 + kSide, rect_.height), x1 = std::min(x0 + kSide, rect_.width);
                for (int y = y0; y < y1; ++y) collect(y, x0, x1);
                close_cell();
            }
        shade_cells();
    } else {
        for (int y = 0; y < rect_.height; ++y) collect(y, 0, rect_.width);
    }
    for (std::size_t i = 0; i < queue.size(); ++i)
        if (queue[i].count > 0) flush(queue[i]);
}

void PictureTile::collect(int y, int x0, int x1) {
    if (samples_ > 1) {
        for (int x = x0; x < x1; ++x) collect_samples(x, y);
        return;
    }
    const std::uint32_t* const ids = scratch_.buffers.triangle[0] + y * kTileStride;
    for (int x = x0; x < x1; ++x) {
        const std::uint32_t id = ids[x];
        if (id == kNoTriangle) continue;
        counts_.pixels_visible += is_written(rect_.x + x, rect_.y + y) ? 1 : 0;
        push(id, x, y, 1u);
    }
}

void PictureTile::collect_samples(int x, int y) {
    const int at = y * kTileStride + x;
    const auto& triangle = scratch_.buffers.triangle;
    const std::uint32_t first = triangle[0][at];
    std::uint32_t mixed = 0;
    for (int s = 1; s < samples_; ++s) mixed |= triangle[s][at] ^ first;
    const unsigned all = (1u << samples_) - 1u;
    if (mixed == 0) {
        if (first == kNoTriangle) return;
        counts_.pixels_visible += is_written(rect_.x + x, rect_.y + y) ? 1 : 0;
        push(first, x, y, all);
        return;
    }
    bool visible = false;
    for (unsigned left = all; left != 0;) {
        const std::uint32_t id = triangle[__builtin_ctz(left)][at];
        unsigned samples = 0;
        for (int s = 0; s < samples_; ++s) samples |= triangle[s][at] == id ? 1u << s : 0u;
        left &= ~samples;
        if (id == kNoTriangle) continue;
        visible = true;
        push(id, x, y, samples);
    }
    counts_.pixels_visible += visible && is_written(rect_.x + x, rect_.y + y) ? 1 : 0;
}

void PictureTile::take_triangle(std::uint32_t id) {
    last_id_ = id;
    last_list_ = &scratch_.queue.of(material_of(id));
}

int PictureTile::material_of(std::uint32_t id) {
    // Neighbouring rows show the same triangles again.
    auto& [known, material] = scratch_.materials[id % std::size(scratch_.materials)];
    if (known != id) {
        const ViewGeometry& geometry = pass_.view.geometry;
        known = id;
        material = geometry.draw_of(geometry.record(id)).material;
    }
    return material;
}

void PictureTile::flush_full() {
    if (has_cells(last_list_->material))
        last_list_ = &scratch_.queue.close(*last_list_);
    else
        flush(*last_list_);
}

void PictureTile::flush(FragmentList& list) {
    if (pass_.normals != nullptr) write_normals(list);
    shade(list);
    write(list, scratch_.block);
    list.count = 0;
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
    }
    shade(list, lights, block);
}

void PictureTile::shade(const FragmentList& list, const shading::LightList& lights, shading::FragmentBlock& block) {
    const shading::ShadingPlan& shading = plan_.shading;
    const shading::MaterialPlan& material = shading.materials[static_cast<std::size_t>(list.material)];
    count_lights(counts_.work, material, lights, list.count);
    count_shading(counts_.work, material, list.count);
    if (pass_.reference != nullptr)
        pass_.reference->shade(pass_.view.shade, shading, list.material, block, list.count);
    else
        pass_.view.shade.shade(shading, material, lights, block, list.count);
    counts_.fragments_shaded += static_cast<std::uint64_t>(list.count);
    for (int l = 0; l < list.count; ++l) {
        const float sum = (block.red[l] + block.green[l]) + (block.blue[l] + block.alpha[l]);
        // A sum of infinities may be NaN although no term is: the terms are tested only if the sum is NaN.
        if (sum != sum &&
            (block.red[l] != block.red[l] || block.green[l] != block.green[l] || block.blue[l] != block.blue[l] ||
             block.alpha[l] != block.alpha[l]) &&
            is_written(list.x_px[l], list.y_px[l]))
            ++counts_.nan_pixels;
    }
}

}  // namespace halflit::raster
