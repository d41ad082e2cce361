// Which triangle each sample of a tile shows.
#include "raster/passes/count_work.hpp"
#include "raster/passes/tile_renderer.hpp"

#include <cstring>

namespace halflit::raster {

bool TileRenderer::has_triangles() const {
    for (std::size_t c = 0; c < frame_.chunk_count; ++c) {
        const auto& begin = frame_.chunks[c]->tile_begin;
        if (begin[static_cast<std::size_t>(tile_)] != begin[static_cast<std::size_t>(tile_) + 1]) return true;
    }
    return false;
}

void TileRenderer::draw_visibility() {
    const std::size_t used = static_cast<std::size_t>(rect_.height) * kTileStride;
    for (int s = 0; s < frame_.pattern.count; ++s) {
        std::memset(buffers_.depth[s], 0, used * sizeof(float));
        std::memset(buffers_.triangle[s], 0xff, used * sizeof(std::uint32_t));
    }
    const bool all_plain = !frame_.has_mask && !frame_.has_blend;
    for (std::size_t c = 0; c < frame_.chunk_count; ++c) {
        const Chunk& chunk = *frame_.chunks[c];
        const std::uint32_t* list = chunk.tile_list.data();
        const std::uint32_t begin = chunk.tile_begin[static_cast<std::size_t>(tile_)],
                            end = chunk.tile_begin[static_cast<std::size_t>(tile_) + 1];
        const TriangleSource& source = frame_.sources[c];
        counts_.triangles += end - begin;
        if (all_plain) {
            if (begin != end)
                frame_.raster->rasterize(rect_, frame_.pattern, buffers_, source, list + begin, static_cast<int>(end - begin));
            continue;
        }
        // Runs of plain triangles go to the kernel as one list; masked ones are tested one by one, blended ones come later.
        for (std::uint32_t i = begin; i < end;) {
            std::uint32_t run = i;
            while (run < end && !draw_of(source.records[list[run]]).mask && !draw_of(source.records[list[run]]).blend) ++run;
            if (run > i) frame_.raster->rasterize(rect_, frame_.pattern, buffers_, source, list + i, static_cast<int>(run - i));
            if (run < end && draw_of(source.records[list[run]]).mask) draw_masked(source, list[run]);
            i = run + 1;
        }
    }
}

template <class Flush>
void TileRenderer::collect_covered(const CoverBox& box, std::uint32_t id, const Flush& flush) {
    FragmentList& list = scratch_.list;
    list.material = draw_of(frame_.record(id)).material;
    list.count = 0;
    for (int y = box.y0; y <= box.y1; ++y) {
        for (int x = box.x0; x <= box.x1; ++x) {
            const int at = y * kTileStride + x;
            if (buffers_.coverage[at] == 0) continue;
            list.push(id, rect_.x + x, rect_.y + y, at, buffers_.coverage[at]);
            if (!list.full()) continue;
            flush(list);
            list.count = 0;
        }
    }
    if (list.count > 0) flush(list);
}

void TileRenderer::draw_masked(const TriangleSource& source, std::uint32_t record) {
    const CoverBox box = frame_.raster->cover(rect_, frame_.pattern, buffers_, source, record);
    bool any = false;
    collect_covered(box, source.id_base + record, [&](FragmentList& list) {
        const shading::MaterialPlan& plan = frame_.plan.materials[static_cast<std::size_t>(list.material)];
        interpolate(frame_, list, scratch_.block);
        frame_.shade->alpha(plan, scratch_.block, list.count);
        count_alpha_test(counts_.work, plan, list.count);
        for (int l = 0; l < list.count; ++l) {
            if (scratch_.block.alpha[l] >= plan.alpha_cutoff)
                any = true;
            else
                buffers_.coverage[list.at[l]] = 0;
        }
    });
    if (any) frame_.raster->draw_covered(rect_, frame_.pattern, buffers_, source, record);
    for (int y = box.y0; y <= box.y1; ++y)
        std::memset(buffers_.coverage + y * kTileStride + box.x0, 0, static_cast<std::size_t>(box.x1 - box.x0 + 1));
}

void TileRenderer::blend_layers() {
    for (std::size_t c = 0; c < frame_.chunk_count; ++c) {
        const Chunk& chunk = *frame_.chunks[c];
        for (std::uint32_t i = chunk.tile_begin[static_cast<std::size_t>(tile_)]; i < chunk.tile_begin[static_cast<std::size_t>(tile_) + 1];
             ++i)
            if (draw_of(chunk.records[chunk.tile_list[i]]).blend) blend_triangle(frame_.sources[c], chunk.tile_list[i]);
    }
}

void TileRenderer::blend_triangle(const TriangleSource& source, std::uint32_t record) {
    const CoverBox box = frame_.raster->cover(rect_, frame_.pattern, buffers_, source, record);
    collect_covered(box, source.id_base + record, [&](FragmentList& list) {
        shade(list);
        write_samples(list, true);
    });
    for (int y = box.y0; y <= box.y1; ++y)
        std::memset(buffers_.coverage + y * kTileStride + box.x0, 0, static_cast<std::size_t>(box.x1 - box.x0 + 1));
}

}  // namespace halflit::raster
