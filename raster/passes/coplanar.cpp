// Surfaces in one plane (scene/coplanar.hpp). Depth decides which plane a sample shows, and the rank of materials which surface of it:
// after all triangles are drawn, those of groups take the samples that they cover and that show a member of a lower rank. What a sample
// shows depends on the triangles that cover it and on their order alone.
#include "raster/passes/tile.hpp"
#include "sh/time_limit.hpp"

#include <bit>

namespace halflit::raster {
namespace {

/// Groups of the triangles that samples show; neighbours mostly show the same.
class ShownGroups {
public:
    struct Shown {
        std::uint32_t id = kNoTriangle, group = 0, rank = 0;
    };
    explicit ShownGroups(const ViewGeometry& geometry) : geometry_(geometry) {}

    const Shown& of(std::uint32_t id) {
        if (id == last_.id) return last_;
        last_ = {id};
        if (id == kNoTriangle) return last_;
        last_.group = geometry_.coplanar_group_of(id);
        if (last_.group != 0)
            last_.rank = geometry_.scene().coplanar().rank(static_cast<std::size_t>(geometry_.draw_of(geometry_.record(id)).material));
        return last_;
    }

private:
    const ViewGeometry& geometry_;
    Shown last_;
};

/// Calls visit(sample, at) for the samples of the coverage plane in a box.
template <class Visit>
void for_each_sample(const TileScratch& scratch, const CoverBox& box, const Visit& visit) {
    for (int y = box.y0; y <= box.y1; ++y)
        for (int at = y * kTileStride + box.x0; at <= y * kTileStride + box.x1; ++at)
            for (unsigned left = scratch.buffers.coverage[at]; left != 0; left &= left - 1) visit(std::countr_zero(left), at);
}

/// Keeps those for which keep(sample, at) holds. True if some are left.
template <class Keep>
bool keep_samples(TileScratch& scratch, const CoverBox& box, const Keep& keep) {
    bool any = false;
    for_each_sample(scratch, box, [&](int s, int at) {
        if (keep(s, at)) {
            any = true;
            return;
        }
        std::uint16_t& mask = scratch.buffers.coverage[at];
        mask = static_cast<std::uint16_t>(mask & ~(1u << s));
    });
    return any;
}

}  // namespace

void draw_coplanar(const TilePass& pass, int tile, TileScratch& scratch, TileCounts& counts) {
    if (!scratch.depths) scratch.depths = std::make_unique<LayerDepths>();
    const ViewGeometry& geometry = pass.geometry;
    const CoplanarGroups& groups = geometry.scene().coplanar();
    const TileRect rect = geometry.view().tile_rect(tile);
    TileBuffers& buffers = scratch.buffers;
    ShownGroups shown(geometry);
    for (std::size_t c = 0; c < geometry.chunks().size(); ++c) {
        const TriangleSource& source = geometry.source(c);
        for (const std::uint32_t record : geometry.tile_list(c, tile, scratch.tile_list)) {
            const std::uint32_t id = source.id_base + record, group = geometry.coplanar_group_of(id);
            if (group == 0) continue;
            const Draw& draw = geometry.draw_of(source.records[record]);
            const std::uint32_t rank = groups.rank(static_cast<std::size_t>(draw.material));
            if (draw.alpha_mode == AlphaMode::blend || rank <= groups.lowest_rank(group)) continue;
            constexpr std::uint64_t kUnitsATriangle = 500;
            pass.stop.check();
            charge_work(kUnitsATriangle);
            const CoverBox box = pass.raster.cover_all(rect, rect, geometry.view().samples, buffers, *scratch.depths, source, record);
            bool any = keep_samples(scratch, box, [&](int s, int at) {
                const ShownGroups::Shown& now = shown.of(buffers.triangle[s][at]);
                return now.group == group && now.rank < rank;
            });
            if (any && draw.alpha_mode == AlphaMode::mask) any = test_mask(pass, rect, box, c, record, scratch, counts);
            if (any)
                for_each_sample(scratch, box, [&](int s, int at) {
                    buffers.depth[s][at] = scratch.depths->depth[s][at];
                    buffers.triangle[s][at] = id;
                });
            clear_coverage(scratch, box);
        }
    }
}

CoverBox cover_layer(const TilePass& pass, const TileRect& rect, const TileRect& part, std::size_t chunk, std::uint32_t record,
                     TileScratch& scratch, LayerDepths& depths) {
    const ViewGeometry& geometry = pass.geometry;
    const TriangleSource& source = geometry.source(chunk);
    const SamplePattern& samples = geometry.view().samples;
    TileBuffers& buffers = scratch.buffers;
    const std::uint32_t group = geometry.has_coplanar() ? geometry.coplanar_group_of(source.id_base + record) : 0;
    if (group == 0) return pass.raster.cover_layer(rect, part, samples, buffers, depths, source, record);
    const CoverBox box = pass.raster.cover_all(rect, part, samples, buffers, depths, source, record);
    ShownGroups shown(geometry);
    keep_samples(scratch, box, [&](int s, int at) {
        if (shown.of(buffers.triangle[s][at]).group != group) return depths.depth[s][at] > buffers.depth[s][at];
        depths.depth[s][at] = buffers.depth[s][at];
        return true;
    });
    return box;
}

}  // namespace halflit::raster
