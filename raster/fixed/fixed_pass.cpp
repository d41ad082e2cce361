#include "raster/fixed/fixed_pass.hpp"

#include "raster/fixed/codes.hpp"
#include "raster/fixed/fixed_shader.hpp"

#include <algorithm>

namespace halflit::raster {
namespace {

constexpr std::size_t kMapBytes = 20;  // of a lookup in LightOcclusion
/// Draws backdrops over what is farther.
void draw_backdrops(const FixedContext& context, const ViewGeometry& geometry, int tile, TileScratch& scratch) {
    for_each_covered(
        context, geometry, tile, AlphaMode::mask, scratch, [&](const TriangleSource& source, std::uint32_t record, const CoverBox&) {
            context.kernels.draw_covered(geometry.view().tile_rect(tile), geometry.view().samples, scratch.buffers, source, record);
        });
}

}  // namespace

void FixedPass::Tile::count_memory(StopSignal& stop) {
    std::size_t bytes = fragments.capacity() * sizeof(Fragment) + layers.capacity() * sizeof(Layer);
    for (const std::vector<ShadowLookup>& of_light : lit) bytes += of_light.capacity() * (sizeof(ShadowLookup) + kMapBytes);
    memory.hold(stop, bytes);
}

namespace {

void write_planes(const FixedContext& context, const ViewGeometry& geometry, const TileRect& rect, const TileBuffers& buffers,
                  const FixedTarget& target) {
    std::uint32_t last = kNoTriangle, id = 0;
    for (int y = 0; y < rect.height; ++y) {
        const int row = target.bottom_up ? target.height - 1 - (rect.y + y) : rect.y + y;
        const std::size_t to = static_cast<std::size_t>(row) * static_cast<std::size_t>(target.width) + static_cast<std::size_t>(rect.x);
        const int from = y * kTileStride;
        // Huge triangles that were clipped may have depths beyond the range.
        for (int x = 0; target.depth != nullptr && x < rect.width; ++x) {
            const float depth = buffers.depth[0][from + x];
            target.depth[to + static_cast<std::size_t>(x)] = depth > 0.0f ? std::min(depth, 1.0f) : 0.0f;
        }
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
        draw_opaque(geometry, context.kernels, context.executor.stop(), tile, *scratch);
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
    std::vector<ItemLight> of_draws;
    const auto make_records = [&](VertexRecords& records, shading::SlotMask slots, const auto& light_of) {
        of_draws.clear();
        for (const Draw& draw : geometry_.draws()) of_draws.push_back(light_of(context.frame.items[draw.instance]));
        records.make(geometry_, std::vector(materials, slots), context.executor, [&](const Draw& draw, const VertexRecordArgs& to) {
            of_draws[static_cast<std::size_t>(&draw - geometry_.draws().data())].fill(to, context.kernels);
        });
    };
    make_records(surface_, light.surface_slots(), [&](const FixedItem& item) { return light.surface_of(item); });
    const int shadowed = static_cast<int>(light.shadowed().size());
    for (int i = 0; i < shadowed; i += kLightsARecord) {
        const auto set = static_cast<std::size_t>(i / kLightsARecord);
        const int lights = std::min(kLightsARecord, shadowed - i);
        if (lights_.size() == set) lights_.push_back(std::make_unique<VertexRecords>());
        make_records(*lights_[set], light_slots(lights), [&](const FixedItem& item) { return light.shadowed_of(item, i, lights); });
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
        draw_opaque(geometry_, context.kernels, context.executor.stop(), number, *scratch);
        const bool behind = planes != nullptr && planes->backdrop_depth;
        if (planes != nullptr && !behind) write_planes(context, geometry_, rect, scratch->buffers, *planes);
        draw_backdrops(context, geometry_, number, *scratch);
        if (behind) write_planes(context, geometry_, rect, scratch->buffers, *planes);
        Shader shader(context, *this, light, maps, *scratch, rect, tile);
        shader.surfaces();
        tile.count_memory(context.executor.stop());
        shader.layers(number);
    });
    int x0 = view.region.x + view.region.width, y0 = view.region.y + view.region.height, x1 = -1, y1 = -1;
    for (const Tile& tile : tiles_)
        if (tile.x1 >= 0) x0 = std::min(x0, tile.x0), y0 = std::min(y0, tile.y0), x1 = std::max(x1, tile.x1), y1 = std::max(y1, tile.y1);
    mirror_region_ = x1 < 0 ? Region{} : Region{x0, y0, x1 - x0 + 1, y1 - y0 + 1};
    return {};
}

Result<void> FixedPass::find_shadows(const FixedContext& context, Executor& executor, const ShadowRule& rule, int in_turn,
                                     const LightMap& map, LightOcclusion& occlusion) {
    std::vector<std::span<ShadowLookup>> groups;
    for (Tile& tile : tiles_) groups.emplace_back(tile.lit[static_cast<std::size_t>(in_turn)]);
    return occlusion.find(context.scene, map, rule, groups, context.kernels, executor);
}

void FixedPass::compose(const FixedContext& context, const SampleImage* in_mirror, SampleImage& out) {
    out.region = view_.region;
    out.samples = view_.samples.count;
    const std::size_t size =
        static_cast<std::size_t>(out.region.width) * static_cast<std::size_t>(out.region.height) * static_cast<std::size_t>(out.samples);
    out.memory.hold(context.executor.stop(), size * sizeof out.codes[0]);
    out.codes.assign(size, 0);
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
            for (const Fragment& fragment : tile.fragments)
                for_samples(fragment.at, fragment.samples, [&](int x, int y, int s, std::uint32_t& sample) {
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
