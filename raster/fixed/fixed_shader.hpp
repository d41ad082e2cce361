// Shades the fragments of one tile of a FixedPass.
#pragma once

#include "raster/fixed/codes.hpp"
#include "raster/fixed/fixed_pass.hpp"

namespace halflit::raster {

/// Lights whose sums at vertices are in one record, and their places in it.
inline constexpr int kLightsARecord = 3;
inline constexpr shading::SlotMask kLightSlots[] = {shading::kTangentSlot, shading::kColorSlot, shading::kUv1Slot};
inline constexpr shading::Row kLightRows[] = {shading::kTangentX, shading::kColorR, shading::kU1};

inline shading::SlotMask light_slots(int lights) {
    shading::SlotMask slots = 0;
    for (int i = 0; i < lights; ++i) slots |= kLightSlots[i];
    return slots;
}

/// Calls visit(source, record, box) for each triangle of a mode, in order, with its samples before the tile's depth in the coverage plane.
template <class Visit>
void for_each_covered(const FixedContext& context, const ViewGeometry& geometry, int tile, AlphaMode mode, TileScratch& scratch,
                      const Visit& visit) {
    if (!geometry.has(mode)) return;
    const TileRect rect = geometry.view().tile_rect(tile);
    for (std::size_t c = 0; c < geometry.chunks().size(); ++c) {
        const TriangleSource& source = geometry.source(c);
        for (const std::uint32_t record : geometry.tile_list(c, tile, scratch.tile_list)) {
            if (geometry.draw_of(source.records[record]).alpha_mode != mode) continue;
            context.executor.stop().check();
            const CoverBox box = context.kernels.cover(rect, geometry.view().samples, scratch.buffers, source, record);
            visit(source, record, box);
            clear_coverage(scratch, box);
        }
    }
}

/// Shades the fragments of a tile.
class FixedPass::Shader {
public:
    Shader(const FixedContext& context, const FixedPass& pass, const VertexLight& light, std::span<const LightMap> maps,
           TileScratch& scratch, const TileRect& rect, Tile& out)
        : context_(context), pass_(pass), light_(light), maps_(maps), scratch_(scratch), rect_(rect), out_(out) {}

    void surfaces() {
        FragmentQueue& queue = scratch_.queue;
        queue.begin(context_.textures.size() + 1);
        PixelFragments& row = scratch_.fragments;
        const int samples = pass_.view_.samples.count;
        std::uint32_t last = kNoTriangle;
        FragmentList* list = nullptr;
        for (int y = 0; y < rect_.height; ++y)
            for (int x = 0; x < rect_.width; x += kPixelsARow) {
                context_.kernels.collect(scratch_.buffers, samples, y * kTileStride + x, rect_.x + x,
                                         std::min(kPixelsARow, rect_.width - x), row);
                for (int i = 0; i < row.count; ++i) {
                    if (row.id[i] != last) {
                        last = row.id[i];
                        list = &queue.of(item_of(last).material.texture + 1);
                    }
                    list->push(row.id[i], row.x_px[i], rect_.y + y, static_cast<unsigned>(row.samples[i]));
                    if (!list->full()) continue;
                    shade(*list, false);
                    list->count = 0;
                }
            }
        for (std::size_t i = 0; i < queue.size(); ++i)
            if (queue[i].count > 0) shade(queue[i], false);
    }

    void layers(int tile) {
        FragmentList& list = scratch_.list;
        list.count = 0;
        const auto flush = [&] {
            if (list.count > 0) shade(list, true);
            list.count = 0;
        };
        for_each_covered(context_, pass_.geometry_, tile, AlphaMode::blend, scratch_,
                         [&](const TriangleSource& source, std::uint32_t record, const CoverBox& box) {
                             const int key = item_of(source.id_base + record).material.texture + 1;
                             if (key != list.material) flush();
                             list.material = key;
                             for (int y = box.y0; y <= box.y1; ++y)
                                 for (int x = box.x0; x <= box.x1; ++x) {
                                     const unsigned covered = scratch_.buffers.coverage[y * kTileStride + x];
                                     if (covered == 0) continue;
                                     list.push(source.id_base + record, rect_.x + x, rect_.y + y, covered);
                                     if (list.full()) flush();
                                 }
                         });
        flush();
    }

private:
    [[nodiscard]] std::size_t item_number(std::uint32_t id) const { return pass_.geometry_.draw_of(pass_.geometry_.record(id)).instance; }
    [[nodiscard]] const FixedItem& item_of(std::uint32_t id) const { return context_.frame.items[item_number(id)]; }

    void interpolate(const FragmentList& list, int padded, const VertexRecords& records, shading::SlotMask slots, bool gradients) {
        InterpolateArgs args{};
        args.triangles = pass_.geometry_.table();
        args.draws = records.draws();
        args.clip_records = records.clip_records();
        args.slots = slots;
        args.stride = 4 * __builtin_popcount(slots);
        args.gradients = gradients;
        args.extrapolates = true;
        args.count = padded;
        args.ids = list.id;
        args.x_px = list.x_px;
        args.y_px = list.y_px;
        context_.kernels.interpolate(args, scratch_.block);
    }

    /// Codes of a colour in three rows, and alpha in the next one.
    void codes_of(int row, bool alpha, bool textured, bool in_fog_color, int padded, std::uint32_t* codes) {
        const FixedFrame& frame = context_.frame;
        CodeArgs args{};
        for (int c = 0; c < (alpha ? 4 : 3); ++c) args.light[c] = scratch_.block.lane[row + c];
        args.texels = textured ? &texels_ : nullptr;
        if (frame.fog_end != frame.fog_start) {
            args.depth = scratch_.block.lane[shading::kNormalX];
            args.fog_end = frame.fog_end;
            args.fog_scale = 1.0f / (frame.fog_end - frame.fog_start);
            if (in_fog_color)
                args.fog_color[0] = frame.fog_color.x, args.fog_color[1] = frame.fog_color.y, args.fog_color[2] = frame.fog_color.z;
        }
        args.count = padded;
        args.codes = codes;
        context_.kernels.fixed_codes(args);
    }

    void shade(FragmentList& list, bool layer) {
        context_.executor.stop().check();
        const int count = list.count, padded = (count + 15) & ~15;
        for (int l = count; l < padded; ++l)
            list.id[l] = list.id[count - 1], list.x_px[l] = list.x_px[count - 1], list.y_px[l] = list.y_px[count - 1];
        const bool textured = list.material > 0;
        interpolate(list, padded, pass_.surface_, light_.surface_slots(), textured);
        if (textured)
            context_.kernels.code_texels({&context_.textures[static_cast<std::size_t>(list.material - 1)]->levels(), &scratch_.block,
                                          list.x_px, list.y_px, static_cast<int>(2.0f * pass_.view_.viewport.half_height), padded},
                                         texels_);
        alignas(64) std::uint32_t codes[shading::kBlockSize];
        codes_of(shading::kTangentX, true, textured, true, padded, codes);
        const auto first = static_cast<std::uint32_t>(out_.fragments.size());
        std::uint32_t last = kNoTriangle;
        bool mirrors = false;
        for (int l = 0; l < count; ++l) {
            const auto at = static_cast<std::uint16_t>((list.y_px[l] - rect_.y) * kTileStride + (list.x_px[l] - rect_.x));
            const auto samples = static_cast<std::uint16_t>(list.samples[l]);
            if (layer) {
                out_.layers.push_back({codes[l], at, samples, static_cast<std::uint32_t>(item_number(list.id[l]))});
                continue;
            }
            if (context_.frame.has_mirror && list.id[l] != last) last = list.id[l], mirrors = item_of(last).mirrors;
            out_.fragments.push_back({codes[l], at, samples, mirrors});
            if (!mirrors) continue;
            out_.x0 = std::min(out_.x0, list.x_px[l]), out_.x1 = std::max(out_.x1, list.x_px[l]);
            out_.y0 = std::min(out_.y0, list.y_px[l]), out_.y1 = std::max(out_.y1, list.y_px[l]);
        }
        if (layer) return out_.count_memory(context_.executor.stop());
        // Backdrops are among the fragments; their sums are 0.
        for (int i = 0; i < static_cast<int>(out_.lit.size()); i += kLightsARecord) {
            const int lights = std::min(kLightsARecord, static_cast<int>(out_.lit.size()) - i);
            interpolate(list, padded, *pass_.lights_[static_cast<std::size_t>(i / kLightsARecord)], light_slots(lights), false);
            for (int k = 0; k < lights; ++k) {
                codes_of(kLightRows[k], false, textured, false, padded, codes);
                std::vector<ShadowLookup>& lit = out_.lit[static_cast<std::size_t>(i + k)];
                const LightMap& map = maps_[static_cast<std::size_t>(i + k)];
                for (int l = 0; l < count; ++l) {
                    if ((codes[l] & kRgb) == 0) continue;
                    const auto& lane = scratch_.block.lane;
                    lit.push_back({first + static_cast<std::uint32_t>(l), codes[l],
                                   map.of({lane[shading::kPosX][l], lane[shading::kPosY][l], lane[shading::kPosZ][l]})});
                }
            }
        }
    }

    const FixedContext& context_;
    const FixedPass& pass_;
    const VertexLight& light_;
    std::span<const LightMap> maps_;
    TileScratch& scratch_;
    const TileRect& rect_;
    Tile& out_;
    TexelRows texels_;
};

}  // namespace halflit::raster
