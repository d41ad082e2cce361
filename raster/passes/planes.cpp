// The extra planes: depth, numbers and surface of what each pixel's first sample shows, and the share of its samples that show something.
#include "raster/passes/picture_tile.hpp"

#include <limits>

namespace halflit::raster {
namespace {

/// 0 for NaN, as in the picture.
float number(float x) { return x == x ? x : 0.0f; }

/// Writes three rows of the block into a plane, if it is there.
void write3(const Plane<float>& plane, int x, int y, const float* a, const float* b, const float* c, int lane) {
    if (!plane) return;
    float* p = plane.at(x, y);
    p[0] = number(a[lane]);
    p[1] = number(b[lane]);
    p[2] = number(c[lane]);
}

/// Writes two floats of a pixel, each rounded once.
void write2(const Plane<float>& plane, int x, int y, double a, double b) {
    if (!plane) return;
    plane.at(x, y)[0] = number(static_cast<float>(a));
    plane.at(x, y)[1] = number(static_cast<float>(b));
}

void clear3(const Plane<float>& plane, int x, int y) {
    if (plane)
        for (int i = 0; i < 3; ++i) plane.at(x, y)[i] = 0.0f;
}

}  // namespace

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
            for (const Plane<float>* plane : {&output.normal, &output.shading_normal, &output.albedo, &output.position})
                clear3(*plane, x_px, y_px);
            if (output.barycentric || output.uv) {
                const TrianglePoint point = seen ? geometry.point_at(id, x_px, y_px) : TrianglePoint{};
                write2(output.barycentric, x_px, y_px, point.weight[1], point.weight[2]);
                write2(output.uv, x_px, y_px, point.u, point.v);
            }
            if (output.lights) *output.lights.at(x_px, y_px) = 0;
            if (output.instance) *output.instance.at(x_px, y_px) = seen ? geometry.draw_of(geometry.record(id)).instance + 1 : 0;
            if (output.triangle) *output.triangle.at(x_px, y_px) = seen ? geometry.triangle_of(id) + 1 : 0;
            if (output.coverage) {
                int covered = 0;
                for (int s = 0; s < samples_ && !empty; ++s) covered += scratch_.buffers.triangle[s][at] != kNoTriangle ? 1 : 0;
                *output.coverage.at(x_px, y_px) = static_cast<float>(covered) / static_cast<float>(samples_);
            }
        }
}

void PictureTile::write_surface(FragmentList list) {
    // A joined fragment is of the largest triangle; the planes are of the first sample's. The list is a copy: shading reads the other one.
    for (int l = 0; l < list.count; ++l)
        if ((list.samples[l] & 1) != 0)
            list.id[l] = scratch_.buffers.triangle[0][(list.y_px[l] - rect_.y) * kTileStride + (list.x_px[l] - rect_.x)];
    const Output& output = pass_.output;
    const shading::MaterialPlan& material = pass_.surface->materials[static_cast<std::size_t>(list.material)];
    shading::FragmentBlock& block = scratch_.block;
    interpolate(*pass_.surface, list, block);
    const auto& lane = block.lane;
    const auto is_first = [&](int l) { return (list.samples[l] & 1) != 0 && is_written(list.x_px[l], list.y_px[l]); };
    if (output.normal)
        for (int l = 0; l < list.count; ++l) {
            if (!is_first(l)) continue;
            const Vec3f n = normalize_or({lane[shading::kNormalX][l], lane[shading::kNormalY][l], lane[shading::kNormalZ][l]}, {0, 0, 0});
            const float side = material.double_sided ? lane[shading::kFacing][l] : 1.0f;
            float* p = output.normal.at(list.x_px[l], list.y_px[l]);
            p[0] = n.x * side;
            p[1] = n.y * side;
            p[2] = n.z * side;
        }
    if (!output.has_material()) return;
    if (output.lights && (material.stages & kStageUnlit) == 0) write_lights(list);
    if (output.shading_normal || output.albedo) pass_.view.shade.surface(material, block, list.count);
    for (int l = 0; l < list.count; ++l) {
        if (!is_first(l)) continue;
        const int x = list.x_px[l], y = list.y_px[l];
        write3(output.position, x, y, lane[shading::kPosX], lane[shading::kPosY], lane[shading::kPosZ], l);
        write3(output.shading_normal, x, y, lane[shading::kNormalX], lane[shading::kNormalY], lane[shading::kNormalZ], l);
        write3(output.albedo, x, y, block.red, block.green, block.blue, l);
    }
}

void PictureTile::write_lights(const FragmentList& list) {
    const shading::LightList lights = plan_.light_culler.select(plan_.shading.lights, scratch_.block, list.count, scratch_.lights);
    alignas(64) std::uint32_t number[shading::kBlockSize];
    pass_.view.shade.count_lights(lights, scratch_.block, list.count, number);
    for (int l = 0; l < list.count; ++l)
        if ((list.samples[l] & 1) != 0 && is_written(list.x_px[l], list.y_px[l]))
            *pass_.output.lights.at(list.x_px[l], list.y_px[l]) = number[l];
}

}  // namespace halflit::raster
