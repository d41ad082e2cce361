// The blend pass: transparent triangles, each over what lies behind it.
//
// Each sample blends its fragments in the order of their depths; of equal depths the one that was submitted first lies behind. First all
// fragments of a part of the tile that are nearer than the opaque surfaces are collected, without shading them. Then they are shaded,
// packed by material. Then each sample sorts its own. If a part has more fragments than fit the memory for them, it is halved; if a single
// pixel has, each of its samples goes through its fragments in several turns, from far to near. So memory is bounded and no layer is lost,
// and as each sample blends the same colours in the same order, how a tile is divided cannot be seen.
#include "raster/passes/picture_tile.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>

namespace halflit::raster {
namespace {

using Fragment = LayerScratch::Fragment;

constexpr std::size_t kMostFragments = std::size_t{1} << 16;
constexpr std::uint64_t kUnitsAFragment = 100;  ///< of charge_work

/// Orders layers from far to near, those of one depth by `order`. Depths are positive, so their bits have the order of their values.
std::uint64_t layer_key(float z, std::uint32_t order) { return std::uint64_t{std::bit_cast<std::uint32_t>(z)} << 32 | order; }

/// Depths of the layers of one sample, in submission order. Those in one plane have one depth, the first one's.
class PlaneDepths {
public:
    explicit PlaneDepths(const ViewGeometry& geometry) : geometry_(geometry), has_planes_(geometry.has_coplanar()) {}
    float depth_of(std::uint32_t id, float z) {
        const std::uint32_t group = has_planes_ ? geometry_.coplanar_group_of(id) : 0;
        return group == 0 ? z : first_.try_emplace(group, z).first->second;
    }

private:
    const ViewGeometry& geometry_;
    bool has_planes_;
    std::map<std::uint32_t, float> first_;  ///< of each group
};

/// Calls visit(chunk, record) for the tile's transparent triangles in submission order, until it returns false. False: it did.
template <class Visit>
bool for_each_layer(const TilePass& pass, int tile, TileScratch& scratch, const Visit& visit) {
    constexpr int kLayersBetweenChecks = 16, kUnitsALayer = 500;
    int visited = 0;
    const auto chunks = pass.geometry.chunks();
    for (std::size_t c = 0; c < chunks.size(); ++c) {
        const auto list = pass.geometry.tile_list(c, tile, scratch.tile_list);
        const bool of_one = pass.geometry.one_material(c) >= 0;  // then all are layers, or none
        if (of_one && !list.empty() && pass.geometry.draw_of(chunks[c]->records[list[0]]).alpha_mode != AlphaMode::blend) continue;
        for (const std::uint32_t record : list) {
            const Draw& draw = pass.geometry.draw_of(chunks[c]->records[record]);
            if (draw.alpha_mode != AlphaMode::blend) continue;
            if (pass.behind && pass.materials[static_cast<std::size_t>(draw.material)].transmission.looked_through) continue;
            if (++visited % kLayersBetweenChecks == 0) {
                pass.stop.check();
                charge_work(kLayersBetweenChecks * kUnitsALayer);
            }
            if (!visit(c, record)) return false;
        }
    }
    return true;
}

void blend(float* under, const Vec4f& over, const Vec4f& keep) {
    under[0] = over.x + under[0] * keep.x;
    under[1] = over.y + under[1] * keep.y;
    under[2] = over.z + under[2] * keep.z;
    under[3] = keep.w + under[3] * (1.0f - keep.w);
}

void blend(float* under, const Vec4f& over) {
    const float keep = 1.0f - over.w;
    under[0] = over.x + under[0] * keep;
    under[1] = over.y + under[1] * keep;
    under[2] = over.z + under[2] * keep;
    under[3] = over.w + under[3] * keep;
}

}  // namespace

bool PictureTile::has_layers() const {
    if (!pass_.view.geometry.has(AlphaMode::blend)) return false;
    return !for_each_layer(pass_.view, tile_, scratch_, [](std::size_t, std::uint32_t) { return false; });
}

void PictureTile::blend_layers() {
    if (!scratch_.layers) scratch_.layers = std::make_unique<LayerScratch>();
    blend_layers(rect_);
}

void PictureTile::blend_layers(const TileRect& part) {
    if (collect_layers(part)) {
        std::size_t samples = 0;
        for (const Fragment& fragment : scratch_.layers->fragments) samples += static_cast<std::size_t>(std::popcount(fragment.samples));
        pass_.layers.take(samples);
        charge_work(kUnitsAFragment * scratch_.layers->fragments.size());
        shade_layers();
        blend_pixels(part);
        return;
    }
    if (part.width == 1 && part.height == 1) {
        const int at = (part.y - rect_.y) * kTileStride + (part.x - rect_.x);
        for (int s = 0; s < samples_; ++s) blend_sample(at, s);
        return;
    }
    TileRect first = part, second = part;
    if (part.height >= part.width) {
        first.height = part.height / 2;
        second.y += first.height, second.height -= first.height;
    } else {
        first.width = part.width / 2;
        second.x += first.width, second.width -= first.width;
    }
    blend_layers(first);
    blend_layers(second);
}

bool PictureTile::collect_layers(const TileRect& part) {
    LayerScratch& layers = *scratch_.layers;
    layers.fragments.clear();
    layers.z.clear();
    std::uint16_t* const coverage = scratch_.buffers.coverage;
    return for_each_layer(pass_.view, tile_, scratch_, [&](std::size_t chunk, std::uint32_t record) {
        const TriangleSource& source = pass_.view.geometry.source(chunk);
        const CoverBox box = cover_layer(pass_.view, rect_, part, chunk, record, scratch_, layers.depths);
        for (int y = box.y0; y <= box.y1; ++y) {
            for (int x = box.x0; x <= box.x1; ++x) {
                const int at = y * kTileStride + x;
                if (coverage[at] == 0 || (pass_.only != nullptr && !pass_.only->has(rect_.x + x, rect_.y + y))) continue;
                layers.fragments.push_back({source.id_base + record, static_cast<std::uint16_t>(at), coverage[at]});
                for (int s = 0; s < samples_; ++s) layers.z.push_back(layers.depths.depth[s][at]);
            }
        }
        clear_coverage(scratch_, box);
        return layers.fragments.size() <= kMostFragments;
    });
}

void PictureTile::shade_layers() {
    LayerScratch& layers = *scratch_.layers;
    layers.light.resize(layers.fragments.size());
    layers.keep.resize(transmits_ ? layers.fragments.size() : 0);
    layers.is_shown.clear();
    FragmentQueue& queue = scratch_.queue;
    queue.begin(pass_.view.materials.size());
    for (std::size_t i = 0; i < layers.fragments.size(); ++i) {
        const Fragment& fragment = layers.fragments[i];
        FragmentList& list = queue.of(material_of(fragment.id));
        list.push(fragment.id, rect_.x + fragment.at % kTileStride, rect_.y + fragment.at / kTileStride, static_cast<unsigned>(i));
        if (list.full()) shade_layers(list);
    }
    for (std::size_t i = 0; i < queue.size(); ++i)
        if (queue[i].count > 0) shade_layers(queue[i]);
}

void PictureTile::shade_layers(FragmentList& list) {
    shade(list);
    const bool shown = toned_ && is_shown(list.material);
    if (shown) {
        begin_shown();
        scratch_.layers->is_shown.resize(scratch_.layers->fragments.size());
    }
    const float exposure = exposure_of(list.material);
    bool seen = transmits_;
    for (int l = 0; l < list.count; ++l) {
        const Vec4f light = light_of(scratch_.block, l, exposure);
        const auto fragment = static_cast<std::size_t>(list.samples[l]);
        if (shown) scratch_.layers->is_shown[fragment] = 1;
        scratch_.layers->light[fragment] = light;
        seen |= light.w > 0.0f;
        if (transmits_) scratch_.layers->keep[fragment] = keep_of(list.material, l, light);
    }
    counts_.layers_seen += seen ? 1 : 0;
    list.count = 0;
}

/// The picture's alpha is what the light from behind lacks, in the mean of the channels, but at least the brightest channel: colours
/// divided by alpha then keep the highlights of clear glass.
Vec4f PictureTile::keep_of(int material, int lane, Vec4f light) const {
    if ((plan_.shading.materials[static_cast<std::size_t>(material)].stages & kStageTransmission) == 0) {
        const float keep = 1.0f - light.w;
        return {keep, keep, keep, light.w};
    }
    const auto& keep = scratch_.block.keep;
    const float mean = (keep[0][lane] + keep[1][lane] + keep[2][lane]) * (1.0f / 3.0f);
    const float alpha = std::max(1.0f - mean, std::max(light.x, std::max(light.y, light.z)));
    return {keep[0][lane], keep[1][lane], keep[2][lane], std::min(std::max(alpha, 0.0f), 1.0f)};
}

void PictureTile::blend_fragment(std::size_t fragment, int at, int sample) {
    const LayerScratch& layers = *scratch_.layers;
    const Vec4f light = layers.light[fragment];
    float* const under = sample_color(sample) + 4 * static_cast<std::ptrdiff_t>(at);
    if (!transmits_) {
        blend(under, light);
        cover_backing(at, 1u << sample, light.w);
    } else {
        blend(under, light, layers.keep[fragment]);
        cover_backing(at, 1u << sample, light.w, layers.keep[fragment]);
    }
    if (has_shown_ && layers.shows(fragment)) add_shown(at, 1u << sample, light);
}

void PictureTile::blend_pixels(const TileRect& part) {
    LayerScratch& layers = *scratch_.layers;
    // Counting sort by pixel, which keeps submission order.
    layers.first.fill(0);
    for (const Fragment& fragment : layers.fragments) ++layers.first[fragment.at + 1u];
    for (std::size_t i = 1; i < layers.first.size(); ++i) layers.first[i] += layers.first[i - 1];
    layers.by_pixel.resize(layers.fragments.size());
    for (std::uint32_t i = 0; i < layers.fragments.size(); ++i) layers.by_pixel[layers.first[layers.fragments[i].at]++] = i;
    // Now first[at] is the end of pixel `at`, and so the beginning of the next one.
    for (int y = part.y - rect_.y; y < part.y - rect_.y + part.height; ++y) {
        for (int x = part.x - rect_.x; x < part.x - rect_.x + part.width; ++x) {
            const auto at = static_cast<std::size_t>(y * kTileStride + x);
            const std::uint32_t begin = at == 0 ? 0 : layers.first[at - 1], end = layers.first[at];
            if (begin < end) blend_pixel(at, {layers.by_pixel.data() + begin, end - begin});
        }
    }
}

/// Nearly always all samples of a pixel see its layers in the same order. Then it is found once, and all samples are blended together.
void PictureTile::blend_pixel(std::size_t at, std::span<const std::uint32_t> fragments) {
    LayerScratch& layers = *scratch_.layers;
    const auto z_of = [&](std::uint32_t fragment, int sample) -> float& {
        return layers.z[fragment * static_cast<std::size_t>(samples_) + static_cast<std::size_t>(sample)];
    };
    if (pass_.view.geometry.has_coplanar())
        for (int s = 0; s < samples_; ++s) {
            PlaneDepths planes(pass_.view.geometry);
            for (const std::uint32_t fragment : fragments)
                if ((layers.fragments[fragment].samples >> s & 1u) != 0)
                    z_of(fragment, s) = planes.depth_of(layers.fragments[fragment].id, z_of(fragment, s));
        }
    layers.order.clear();
    for (const std::uint32_t fragment : fragments)
        layers.order.push_back(layer_key(z_of(fragment, std::countr_zero(unsigned{layers.fragments[fragment].samples})), fragment));
    if (!std::is_sorted(layers.order.begin(), layers.order.end())) std::sort(layers.order.begin(), layers.order.end());

    std::uint64_t nearest[kMaxSamples] = {};
    bool same_order = true;
    for (const std::uint64_t layer : layers.order) {
        const auto fragment = static_cast<std::uint32_t>(layer);
        for (unsigned left = layers.fragments[fragment].samples; left != 0; left &= left - 1) {
            const int s = std::countr_zero(left);
            const std::uint64_t next = layer_key(z_of(fragment, s), fragment);
            same_order &= nearest[s] < next;
            nearest[s] = next;
        }
    }

    if (same_order) {
        alignas(64) float color[kMaxSamples][4];
        for (int s = 0; s < samples_; ++s) std::memcpy(color[s], sample_color(s) + 4 * at, sizeof color[s]);
        const unsigned all = (1u << samples_) - 1u;
        const bool transmits = transmits_, has_shown = has_shown_, toned = toned_;  // not read again after each store
        for (const std::uint64_t layer : layers.order) {
            const auto fragment = static_cast<std::uint32_t>(layer);
            const Vec4f light = layers.light[fragment];
            const unsigned samples = layers.fragments[fragment].samples;
            if (transmits) {
                const Vec4f keep = layers.keep[fragment];
                for (unsigned left = samples; left != 0; left &= left - 1) blend(color[std::countr_zero(left)], light, keep);
                cover_backing(static_cast<int>(at), samples, light.w, keep);
                if (has_shown && layers.shows(fragment)) add_shown(static_cast<int>(at), samples, light);
                continue;
            }
            if (samples == all)
                for (int s = 0; s < samples_; ++s) blend(color[s], light);
            else
                for (unsigned left = samples; left != 0; left &= left - 1) blend(color[std::countr_zero(left)], light);
            if (toned) cover_backing(static_cast<int>(at), samples, light.w);
            if (has_shown && layers.shows(fragment)) add_shown(static_cast<int>(at), samples, light);
        }
        for (int s = 0; s < samples_; ++s) std::memcpy(sample_color(s) + 4 * at, color[s], sizeof color[s]);
        return;
    }
    for (int s = 0; s < samples_; ++s) {
        layers.order.clear();
        for (const std::uint32_t fragment : fragments)
            if ((layers.fragments[fragment].samples >> s & 1u) != 0) layers.order.push_back(layer_key(z_of(fragment, s), fragment));
        std::sort(layers.order.begin(), layers.order.end());
        for (const std::uint64_t layer : layers.order) blend_fragment(static_cast<std::uint32_t>(layer), static_cast<int>(at), s);
    }
}

void PictureTile::blend_sample(int at, int sample) {
    LayerScratch& layers = *scratch_.layers;
    const TileRect pixel{rect_.x + at % kTileStride, rect_.y + at / kTileStride, 1, 1};
    struct Kept {
        std::uint64_t key;  ///< by the order of submission among all layers
        std::uint32_t id;
        bool operator<(const Kept& other) const { return key < other.key; }
    };
    std::vector<Kept> kept;
    kept.reserve(kMostFragments);
    std::uint64_t done = 0;  // layers up to this one are blended
    for (bool all = false; !all;) {
        all = true;
        kept.clear();
        std::uint64_t limit = layer_key(2.0f, 0);  // depths are at most 1
        std::uint32_t order = 0;
        PlaneDepths planes(pass_.view.geometry);
        for_each_layer(pass_.view, tile_, scratch_, [&](std::size_t chunk, std::uint32_t record) {
            ++order;
            const TriangleSource& source = pass_.view.geometry.source(chunk);
            const CoverBox box = cover_layer(pass_.view, rect_, pixel, chunk, record, scratch_, layers.depths);
            const bool covers = (scratch_.buffers.coverage[at] >> sample & 1u) != 0;
            clear_coverage(scratch_, box);
            if (!covers) return true;
            const std::uint32_t id = source.id_base + record;
            const std::uint64_t key = layer_key(planes.depth_of(id, layers.depths.depth[sample][at]), order);
            if (key <= done) return true;
            if (key >= limit) {
                all = false;
                return true;
            }
            kept.push_back({key, id});
            if (kept.size() == kMostFragments) {
                // The nearer half waits for the next turn.
                const auto middle = kept.begin() + static_cast<std::ptrdiff_t>(kMostFragments / 2);
                std::nth_element(kept.begin(), middle, kept.end());
                limit = middle->key;
                kept.erase(middle, kept.end());
                all = false;
            }
            return true;
        });
        std::sort(kept.begin(), kept.end());
        layers.fragments.clear();
        pass_.layers.take(kept.size());
        for (const Kept& layer : kept) layers.fragments.push_back({layer.id, static_cast<std::uint16_t>(at), 0});
        shade_layers();
        for (std::size_t i = 0; i < layers.light.size(); ++i) blend_fragment(i, at, sample);
        if (!kept.empty()) done = kept.back().key;
    }
}

}  // namespace halflit::raster
