// The blend pass: transparent triangles in submission order, each over what lies behind it.
#include "raster/passes/picture_tile.hpp"

namespace halflit::raster {

void PictureTile::blend_layers() {
    const ViewGeometry& geometry = pass_.view.geometry;
    if (!geometry.has(AlphaMode::blend)) return;
    constexpr int kLayersBetweenChecks = 16;
    int blended = 0;
    const auto chunks = geometry.chunks();
    for (std::size_t c = 0; c < chunks.size(); ++c) {
        for (const std::uint32_t record : geometry.tile_list(c, tile_, scratch_.tile_list)) {
            if (geometry.draw_of(chunks[c]->records[record]).alpha_mode != AlphaMode::blend) continue;
            if (++blended % kLayersBetweenChecks == 0) pass_.view.stop.check();
            const CoverBox box = collect_covered(pass_.view, rect_, c, record, scratch_, [&](FragmentList& list) {
                shade(list);
                write_samples(list, scratch_.block, true);
            });
            clear_coverage(scratch_, box);
        }
    }
}

}  // namespace halflit::raster
