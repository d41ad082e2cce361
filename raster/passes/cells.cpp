// Light in cells: the fragments of a material in one cell of the picture are a block of their own, and the light that changes little over a
// cell is fitted once for it (shading/light_cell.hpp). Cells are those of the whole picture, and a cell's fragments are taken in the order
// of its pixels, so tiles and regions change no pixel.
#include "raster/passes/count_work.hpp"
#include "raster/passes/picture_tile.hpp"

namespace halflit::raster {
namespace {

using shading::CellBatch, shading::kCellLanes;

static_assert(kCellLanes <= 16, "a light's cells are bits of 16");
static_assert(16 % shading::kCellSide == 0, "tiles begin at cells");

/// The box of a batch's positions, slightly larger.
PositionBox box_of(const CellBatch& batch) {
    PositionBox box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
    for (int cell = 0; cell < batch.count; ++cell)
        for (int axis = 0; axis < 3; ++axis) {
            const double middle = batch.position[axis][cell], radius = 1.001 * batch.position_radius[cell];
            box.low[axis] = std::min(box.low[axis], middle - radius);
            box.high[axis] = std::max(box.high[axis], middle + radius);
        }
    return box;
}

void take_cell(const CellBatch& batch, int i, shading::LightCell& cell) {
    for (int axis = 0; axis < 3; ++axis) {
        cell.normal[axis] = batch.normal[axis][i];
        cell.position[axis] = batch.position[axis][i];
    }
    const float radius = batch.position_radius[i];
    cell.inv_position_radius = radius > 1e-30f && radius < shading::kNoCell ? 1.0f / radius : 0.0f;
    cell.flat = batch.normal_radius[i] == 0.0f;
    for (int t = 0; t < shading::kCellTerms; ++t)
        for (int c = 0; c < 3; ++c) cell.term[t][c] = batch.term[t][c][i];
    cell.shines = (batch.shining >> i & 1) != 0;
    if (!cell.shines) return;
    for (int t = 0; t < shading::kCellTerms; ++t)
        for (int c = 0; c < 3; ++c) cell.highlight[t][c] = batch.highlight[t][c][i];
}

}  // namespace

bool PictureTile::has_cells(int material) const {
    return plan_.shading.materials[static_cast<std::size_t>(material)].cells.relative > 0.0f;
}

void PictureTile::close_cell() {
    FragmentQueue& queue = scratch_.queue;
    for (std::size_t i = 0; i < queue.size(); ++i)
        if (queue[i].count > 0 && has_cells(queue[i].material)) queue.close(queue[i]);
}

void PictureTile::shade_cells() {
    const auto lists = scratch_.queue.closed();
    if (lists.empty()) return;
    if (scratch_.cells == nullptr) scratch_.cells = std::make_unique<CellScratch>();
    for (std::size_t first = 0; first < lists.size();) {
        std::size_t end = first + 1;
        while (end < lists.size() && end - first < kCellLanes && lists[end]->material == lists[first]->material) ++end;
        shade_cells(lists.subspan(first, end - first));
        first = end;
    }
}

void PictureTile::shade_cells(std::span<std::unique_ptr<FragmentList>> lists) {
    CellScratch& scratch = *scratch_.cells;
    const shading::ShadingPlan& shading = plan_.shading;
    const shading::MaterialPlan& material = shading.materials[static_cast<std::size_t>(lists[0]->material)];
    CellBatch& batch = scratch.batch;
    batch.count = static_cast<int>(lists.size());
    for (int i = 0; i < kCellLanes; ++i) {
        if (i >= batch.count) {
            for (int axis = 0; axis < 3; ++axis) {
                batch.normal[axis][i] = axis == 2 ? 1.0f : 0.0f;
                batch.position[axis][i] = 0.0f;
            }
            batch.normal_radius[i] = batch.position_radius[i] = shading::kNoCell;
            continue;
        }
        FragmentList& list = *lists[static_cast<std::size_t>(i)];
        if (pass_.surface != nullptr) write_surface(list);
        interpolate(pass_.view, list, scratch.blocks[i]);
        pass_.view.shade.measure_cell(material, scratch.blocks[i], list.count, batch, i);
    }
    const shading::LightList lights = plan_.light_culler.select(shading.lights, box_of(batch), scratch_.lights);
    scratch.exact.assign(static_cast<std::size_t>(lights.count), 0);
    pass_.view.shade.fit_cells(shading, material, lights, batch, scratch.exact.data());
    for (int i = 0; i < batch.count; ++i) {
        take_cell(batch, i, scratch.cell);
        scratch.of_pixels.clear();
        for (int l = 0; l < lights.count; ++l)
            if ((scratch.exact[static_cast<std::size_t>(l)] >> i & 1) != 0) scratch.of_pixels.push_back(lights.lights[l]);
        const FragmentList& list = *lists[static_cast<std::size_t>(i)];
        shade(list, {scratch.of_pixels.data(), static_cast<int>(scratch.of_pixels.size()), &scratch.cell}, scratch.blocks[i]);
        write(list, scratch.blocks[i]);
    }
}

}  // namespace halflit::raster
