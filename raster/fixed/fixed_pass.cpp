#include "raster/fixed/fixed_pass.hpp"

#include <algorithm>
#include <cstring>

namespace halflit::raster {
namespace {

using shading::kBlockSize;

constexpr int kLightsARecord = 3;
constexpr shading::SlotMask kLightSlots[] = {shading::kTangentSlot, shading::kColorSlot, shading::kUv1Slot};
constexpr shading::Row kLightRows[] = {shading::kTangentX, shading::kColorR, shading::kU1};

shading::SlotMask light_slots(int lights) {
    shading::SlotMask slots = 0;
    for (int i = 0; i < lights; ++i) slots |= kLightSlots[i];
    return slots;
}

constexpr std::uint32_t kRgb = 0xffffff;
std::uint32_t channel(std::uint32_t code, int c) { return code >> (8 * c) & 0xffu; }
/// Sums of red, green and blue, at most 255 each.
std::uint32_t add_codes(std::uint32_t a, std::uint32_t b) {
    constexpr std::uint32_t kHigh = 0x808080, kLow = 0x7f7f7f;
    const std::uint32_t either = (a ^ b) & kHigh, low = (a & kLow) + (b & kLow);
    const std::uint32_t over = ((a & b) | (either & low)) & kHigh;  // channels above 255
    return ((low ^ either) | ((over << 1) - (over >> 7))) & kRgb;
}
/// a b / 255, rounded.
std::uint32_t times(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t product = a * b + 128;
    return (product + (product >> 8)) >> 8;
}
std::uint32_t blended(std::uint32_t over, std::uint32_t under, bool adds) {
    const std::uint32_t alpha = channel(over, 3);
    std::uint32_t out = 0;
    for (int c = 0; c < 3; ++c)
        out |= std::min(times(channel(over, c), alpha) + (adds ? channel(under, c) : times(channel(under, c), 255 - alpha)), 255u) << (8 * c);
    return out;
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

/// Visibility of a tile: solid items, and, where they are asked for, backdrops over what is farther.
void draw_solid(const FixedContext& context, const ViewGeometry& geometry, int tile, TileScratch& scratch) {
    draw_opaque(geometry, context.kernels, context.executor.stop(), tile, scratch);
}
void draw_backdrops(const FixedContext& context, const ViewGeometry& geometry, int tile, TileScratch& scratch) {
    for_each_covered(context, geometry, tile, AlphaMode::mask, scratch,
                     [&](const TriangleSource& source, std::uint32_t record, const CoverBox&) {
                         context.kernels.draw_covered(geometry.view().tile_rect(tile), geometry.view().samples, scratch.buffers, source, record);
                     });
}

}  // namespace

/// Shades the fragments of a tile.
class FixedPass::Shader {
public:
    Shader(const FixedContext& context, const FixedPass& pass, const VertexLight& light, std::span<const LightMap> maps, TileScratch& scratch,
           const TileRect& rect, Tile& out)
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
                context_.kernels.collect(scratch_.buffers, samples, y * kTileStride + x, rect_.x + x, std::min(kPixelsARow, rect_.width - x), row);
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
    [[nodiscard]] std::size_t item_number(std::uint32_t id) const {
        return pass_.geometry_.draw_of(pass_.geometry_.record(id)).instance;
    }
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
            if (in_fog_color) args.fog_color[0] = frame.fog_color.x, args.fog_color[1] = frame.fog_color.y, args.fog_color[2] = frame.fog_color.z;
        }
        args.count = padded;
        args.codes = codes;
        context_.kernels.fixed_codes(args);
    }

    void shade(FragmentList& list, bool layer) {
        context_.executor.stop().check();
        const int count = list.count, padded = (count + 15) & ~15;
        for (int l = count; l < padded; ++l) list.id[l] = list.id[count - 1], list.x_px[l] = list.x_px[count - 1], list.y_px[l] = list.y_px[count - 1];
        const bool textured = list.material > 0;
        interpolate(list, padded, pass_.surface_, light_.surface_slots(), textured);
        if (textured)
            context_.kernels.code_texels({&context_.textures[static_cast<std::size_t>(list.material - 1)].levels(), &scratch_.block, list.x_px,
                                          list.y_px, static_cast<int>(2.0f * pass_.view_.viewport.half_height), padded},
                                         texels_);
        alignas(64) std::uint32_t codes[kBlockSize];
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
        if (layer) return;
        // Backdrops have no light; a list of them alone is not told from others, and its sums are 0.
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

namespace {

void write_planes(const FixedContext& context, const ViewGeometry& geometry, const TileRect& rect, const TileBuffers& buffers,
                  const FixedTarget& target) {
    std::uint32_t last = kNoTriangle, id = 0;
    for (int y = 0; y < rect.height; ++y) {
        const int row = target.bottom_up ? target.height - 1 - (rect.y + y) : rect.y + y;
        const std::size_t to = static_cast<std::size_t>(row) * static_cast<std::size_t>(target.width) + static_cast<std::size_t>(rect.x);
        const int from = y * kTileStride;
        if (target.depth != nullptr)
            std::memcpy(target.depth + to, buffers.depth[0] + from, sizeof(float) * static_cast<std::size_t>(rect.width));
        for (int x = 0; target.ids != nullptr && x < rect.width; ++x) {
            const std::uint32_t triangle = buffers.triangle[0][from + x];
            if (triangle != last) {
                last = triangle;
                id = triangle == kNoTriangle ? 0 : context.frame.items[geometry.draw_of(geometry.record(triangle)).instance].id;
            }
            target.ids[to + static_cast<std::size_t>(x)] = id;
        }
    }
}

}  // namespace

Result<void> draw_planes(const FixedContext& context, const View& view, ViewGeometry& geometry, const FixedTarget& target) {
    geometry.forget();
    if (auto ok = geometry.make(context.scene, view, context.kernels, context.executor); !ok) return ok;
    context.executor.run(view.tile_count(), [&](int tile) {
        Pool<TileScratch>::Loan scratch(context.scratch);
        draw_solid(context, geometry, tile, *scratch);
        write_planes(context, geometry, view.tile_rect(tile), scratch->buffers, target);
    });
    return {};
}

Result<void> FixedPass::shade(const FixedContext& context, const View& view, const VertexLight& light, std::span<const LightMap> maps,
                              const FixedTarget* planes) {
    view_ = view;
    geometry_.forget();
    if (auto ok = geometry_.make(context.scene, view, context.kernels, context.executor); !ok) return ok;
    const std::size_t materials = context.scene.scene().materials.size() + 1;
    const auto fill = [&](int in_turn, int lights) {
        return [&, in_turn, lights](const Draw& draw, const VertexRecordArgs& args) {
            light.fill(context.frame.items[draw.instance], args, context.kernels, in_turn, lights);
        };
    };
    surface_.make(geometry_, std::vector(materials, light.surface_slots()), context.executor, fill(-1, 0));
    const int shadowed = static_cast<int>(light.shadowed().size());
    for (int i = 0; i < shadowed; i += kLightsARecord) {
        const auto set = static_cast<std::size_t>(i / kLightsARecord);
        const int lights = std::min(kLightsARecord, shadowed - i);
        if (lights_.size() == set) lights_.push_back(std::make_unique<VertexRecords>());
        lights_[set]->make(geometry_, std::vector(materials, light_slots(lights)), context.executor, fill(i, lights));
    }
    tiles_.resize(static_cast<std::size_t>(view.tile_count()));
    context.executor.run(view.tile_count(), [&](int number) {
        Tile& tile = tiles_[static_cast<std::size_t>(number)];
        tile.fragments.clear();
        tile.layers.clear();
        tile.lit.resize(static_cast<std::size_t>(shadowed));
        for (std::vector<ShadowLookup>& lit : tile.lit) lit.clear();
        tile.x0 = tile.y0 = view.region.x + view.region.width + view.region.y + view.region.height;
        tile.x1 = tile.y1 = -1;
        Pool<TileScratch>::Loan scratch(context.scratch);
        const TileRect rect = view.tile_rect(number);
        draw_solid(context, geometry_, number, *scratch);
        const bool behind = planes != nullptr && planes->backdrop_depth;
        if (planes != nullptr && !behind) write_planes(context, geometry_, rect, scratch->buffers, *planes);
        draw_backdrops(context, geometry_, number, *scratch);
        if (behind) write_planes(context, geometry_, rect, scratch->buffers, *planes);
        Shader shader(context, *this, light, maps, *scratch, rect, tile);
        shader.surfaces();
        shader.layers(number);
    });
    int x0 = view.region.x + view.region.width, y0 = view.region.y + view.region.height, x1 = -1, y1 = -1;
    for (const Tile& tile : tiles_)
        if (tile.x1 >= 0) x0 = std::min(x0, tile.x0), y0 = std::min(y0, tile.y0), x1 = std::max(x1, tile.x1), y1 = std::max(y1, tile.y1);
    mirror_region_ = x1 < 0 ? Region{} : Region{x0, y0, x1 - x0 + 1, y1 - y0 + 1};
    return {};
}

Result<void> FixedPass::find_shadows(const FixedContext& context, const ShadowRule& rule, int in_turn, const LightMap& map,
                                     LightOcclusion& occlusion) {
    std::vector<std::span<ShadowLookup>> groups;
    for (Tile& tile : tiles_) groups.emplace_back(tile.lit[static_cast<std::size_t>(in_turn)]);
    return occlusion.find(context.scene, map, rule, groups, context.kernels, context.executor);
}

void FixedPass::compose(const FixedContext& context, const SampleImage* in_mirror, SampleImage& out) {
    out.region = view_.region;
    out.samples = view_.samples.count;
    out.codes.assign(static_cast<std::size_t>(out.region.width) * static_cast<std::size_t>(out.region.height) *
                         static_cast<std::size_t>(out.samples), 0);
    context.executor.run(view_.tile_count(), [&](int number) {
        Tile& tile = tiles_[static_cast<std::size_t>(number)];
        const TileRect rect = view_.tile_rect(number);
        for (const std::vector<ShadowLookup>& lit : tile.lit)
            for (const ShadowLookup& of : lit)
                if (of.place.hidden == 0) {
                    std::uint32_t& code = tile.fragments[of.fragment].code;
                    code = add_codes(code, of.code);
                }
        const auto for_samples = [&](std::uint16_t at, std::uint16_t samples, const auto& visit) {
            const int x = rect.x + at % kTileStride, y = rect.y + at / kTileStride;
            std::uint32_t* const pixel = out.codes.data() + out.index(x, y);
            for (int s = 0; s < out.samples; ++s)
                if (samples >> s & 1) visit(x, y, s, pixel[s]);
        };
        if (out.samples == 1 && in_mirror == nullptr)
            for (const Fragment& fragment : tile.fragments)
                out.codes[out.index(rect.x + fragment.at % kTileStride, rect.y + fragment.at / kTileStride)] = fragment.code & kRgb;
        else
            for (const Fragment& fragment : tile.fragments) for_samples(fragment.at, fragment.samples, [&](int x, int y, int s, std::uint32_t& sample) {
                const bool seen = fragment.mirrors && in_mirror != nullptr;
                sample = seen ? add_codes(fragment.code, in_mirror->codes[in_mirror->index(x, y) + static_cast<std::size_t>(s)])
                              : fragment.code & kRgb;
            });
        const auto blend = [&](const Layer& layer) {
            for_samples(layer.at, layer.samples, [&](int, int, int, std::uint32_t& sample) {
                const bool adds = context.frame.adds_layers && context.frame.items[layer.item].stage == FixedStage::transparent;
                sample = blended(layer.code, sample, adds);
            });
        };
        for (const Layer& layer : tile.layers) blend(layer);
        if (context.frame.adds_layers) return;
        // Once more, object by object from back to front.
        const auto& items = context.frame.items;
        for (std::size_t end = tile.layers.size(); end > 0;) {
            std::size_t first = end - 1;
            while (first > 0 && items[tile.layers[first - 1].item].id == items[tile.layers[end - 1].item].id) --first;
            for (std::size_t i = first; i < end; ++i)
                if (items[tile.layers[i].item].stage == FixedStage::transparent) blend(tile.layers[i]);
            end = first;
        }
    });
}

}  // namespace halflit::raster
