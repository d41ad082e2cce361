// The extra planes: depth, normal and numbers of what each pixel's first sample shows.
#include "raster/passes/picture_tile.hpp"

#include <limits>

namespace halflit::raster {

void PictureTile::write_planes(bool empty) {
    const Output& output = pass_.output;
    const ViewGeometry& geometry = pass_.view.geometry;
    for (int y_px = written_.y; y_px < written_.y + written_.height; ++y_px)
        for (int x_px = written_.x; x_px < written_.x + written_.width; ++x_px) {
            const int at = (y_px - rect_.y) * kTileStride + (x_px - rect_.x);
            const std::uint32_t id = empty ? kNoTriangle : scratch_.buffers.triangle[0][at];
            const bool seen = id != kNoTriangle;
            if (output.depth)
                *output.depth.at(x_px, y_px) = seen ? static_cast<float>(plan_.depth.distance(double{scratch_.buffers.depth[0][at]}))
                                                    : std::numeric_limits<float>::infinity();
            if (output.normal)
                for (int i = 0; i < 3; ++i) output.normal.at(x_px, y_px)[i] = 0.0f;
            if (output.instance) *output.instance.at(x_px, y_px) = seen ? geometry.draw_of(geometry.record(id)).instance + 1 : 0;
            if (output.triangle) *output.triangle.at(x_px, y_px) = seen ? geometry.triangle_of(id) + 1 : 0;
        }
}

void PictureTile::write_normals(FragmentList& list) {
    interpolate(*pass_.normals, list, scratch_.block);
    const auto& lane = scratch_.block.lane;
    const bool facing = pass_.normals->materials[static_cast<std::size_t>(list.material)].double_sided;
    for (int l = 0; l < list.count; ++l) {
        if ((list.samples[l] & 1) == 0 || !is_written(list.x_px[l], list.y_px[l])) continue;
        const Vec3f n = normalize_or({lane[shading::kNormalX][l], lane[shading::kNormalY][l], lane[shading::kNormalZ][l]}, {0, 0, 0});
        const float side = facing ? lane[shading::kFacing][l] : 1.0f;
        float* p = pass_.output.normal.at(list.x_px[l], list.y_px[l]);
        p[0] = n.x * side;
        p[1] = n.y * side;
        p[2] = n.z * side;
    }
}

}  // namespace halflit::raster
