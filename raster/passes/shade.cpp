// The shade pass: shades each visible pixel once for each surface that it shows, packed by material into full blocks.
#include "raster/passes/count_work.hpp"
#include "raster/passes/picture_tile.hpp"
#include "raster/passes/shading_rate.hpp"

namespace halflit::raster {

TileCounts PictureTile::draw() {
    if (pass_.only != nullptr) {
        bool any = false;
        for (int y = 0; y < rect_.height && !any; ++y) any = pass_.only->has_any(rect_.x, rect_.y + y, rect_.width);
        if (!any) return counts_;
    }
    const bool empty = pass_.view.geometry.tile_is_empty(tile_), layered = !empty && has_layers();
    direct_ = samples_ == 1 && !layered;
    transmits_ = plan_.transmits && layered;
    shades_ = pass_.output.has_colors();
    has_contact_shadow_ = !pass_.view.behind && plan_.contact_shadow.touches({rect_.x, rect_.y, rect_.width, rect_.height});
    scratch_.shadow.known = 0;
    joins_ = shades_ && plan_.options.rate == ShadingRate::pixel && pass_.view.geometry.few_vertices();
    has_whole_ = samples_ > 1 && !layered && !empty && pass_.reference == nullptr;
    if (!empty) draw_visibility(pass_.view, tile_, scratch_, counts_);
    if (pass_.eye_dome != nullptr) pass_.eye_dome->keep(rect_, empty ? nullptr : &scratch_.buffers, pass_.view.geometry);
    if (pass_.splats != nullptr && !empty) pass_.splats->keep(rect_, scratch_.buffers);
    if (shades_ && empty) fill_background();
    if (shades_ && !empty) clear();
    if (pass_.output.has_planes()) write_planes(empty);
    if (empty) return counts_;
    if (!shades_ && pass_.surface == nullptr && pass_.only == nullptr) {
        count_visible();
        return counts_;
    }
    shade_visible();
    if (!shades_) return counts_;
    if (layered) blend_layers();
    if (!direct_) resolve();
    return counts_;
}

void PictureTile::keep_depths() {
    if (pass_.view.geometry.tile_is_empty(tile_)) return;
    draw_visibility(pass_.view, tile_, scratch_, counts_);
    pass_.eye_dome->keep(rect_, &scratch_.buffers, pass_.view.geometry);
}

void PictureTile::shade_visible() {
    FragmentQueue& queue = scratch_.queue;
    queue.begin(pass_.view.materials.size());
    std::fill(std::begin(scratch_.materials), std::end(scratch_.materials), TileScratch::MaterialOf{});
    if (samples_ > 1 && joins_) scratch_.pairs = {};
    if (plan_.cells && shades_) {
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
    PixelFragments& row = scratch_.fragments;
    const bool all_written = written_.width == rect_.width && written_.height == rect_.height;
    for (int x = x0; x < x1; x += kPixelsARow) {
        const int at = y * kTileStride + x, count = std::min(kPixelsARow, x1 - x);
        if (pass_.only != nullptr && !pass_.only->has_any(rect_.x + x, rect_.y + y, count)) continue;
        pass_.view.raster.collect(scratch_.buffers, samples_, at, rect_.x + x, count, row);
        if (pass_.only != nullptr) keep_only(row, rect_.y + y);
        if (row.count == 0) continue;
        if (row.count > row.pixels && joins_) join(row, rect_.y + y);
        if (all_written)
            counts_.pixels_visible += static_cast<std::uint64_t>(row.pixels);
        else
            for (int i = 0; i < row.count; ++i)
                counts_.pixels_visible += (i == 0 || row.x_px[i] != row.x_px[i - 1]) && is_written(row.x_px[i], rect_.y + y) ? 1 : 0;
        sort(row, rect_.y + y);
    }
}

void PictureTile::keep_only(PixelFragments& row, int y_px) const {
    keep_fragments(row, [&](int i) { return pass_.only->has(row.x_px[i], y_px); });
    row.pixels = 0;
    for (int i = 0; i < row.count; ++i) row.pixels += i == 0 || row.x_px[i] != row.x_px[i - 1] ? 1 : 0;
}

void PictureTile::sort(const PixelFragments& row, int y_px) {
    for (int i = 0; i < row.count;) {
        // Neighbours mostly have the same material.
        const int material = material_of(row.id[i]);
        int end = i + 1;
        if (pass_.view.geometry.one_material() >= 0)
            end = row.count;
        else
            while (end < row.count && (row.id[end] == row.id[end - 1] || material_of(row.id[end]) == material)) ++end;
        for (FragmentList* list = &scratch_.queue.of(material); i < end;) {
            const int n = std::min(end - i, shading::kBlockSize - list->count);
            list->append(row, i, n, y_px);
            i += n;
            if (list->full()) flush_full(list);
        }
    }
}

int PictureTile::material_of(std::uint32_t id) {
    const ViewGeometry& geometry = pass_.view.geometry;
    if (const int one = geometry.one_material(geometry.chunk_of(id)); one >= 0) return one;
    // Neighbouring rows show the same triangles again.
    auto& [known, material] = scratch_.materials[id % std::size(scratch_.materials)];
    if (known != id) {
        known = id;
        material = geometry.draw_of(geometry.record(id)).material;
    }
    return material;
}

void PictureTile::flush_full(FragmentList*& list) {
    if (shades_ && has_cells(list->material))
        list = &scratch_.queue.close(*list);
    else
        flush(*list);
}

void PictureTile::flush(FragmentList& list) {
    if (pass_.surface != nullptr) write_surface(list);
    if (shades_) {
        shade(list);
        write(list, scratch_.block);
    }
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
    constexpr int kManyLights = 64;
    if (lights.count > kManyLights) pass_.view.stop.check();  // a tile of a thousand soft lights takes a second
    count_lights(counts_.work, material, lights, list.count);
    count_shading(counts_.work, material, list.count);
    if (pass_.reference != nullptr)
        pass_.reference->shade(pass_.view.shade, shading, list.material, block, list.count, pass_.view.stop);
    else
        pass_.view.shade.shade(shading, material, lights, block, list.count);
    counts_.fragments_shaded += static_cast<std::uint64_t>(list.count);
    count_nan_pixels(list, block);
}

void PictureTile::count_nan_pixels(const FragmentList& list, const shading::FragmentBlock& block) {
    int nan = 0;  // without a branch, so that lanes are tested side by side
    for (int l = 0; l < list.count; ++l)
        nan |= static_cast<int>(block.red[l] != block.red[l]) | static_cast<int>(block.green[l] != block.green[l]) |
               static_cast<int>(block.blue[l] != block.blue[l]) | static_cast<int>(block.alpha[l] != block.alpha[l]);
    if (nan == 0) return;
    for (int l = 0; l < list.count; ++l)
        if ((block.red[l] != block.red[l] || block.green[l] != block.green[l] || block.blue[l] != block.blue[l] ||
             block.alpha[l] != block.alpha[l]) &&
            is_written(list.x_px[l], list.y_px[l]))
            ++counts_.nan_pixels;
}

}  // namespace halflit::raster
