// The extra planes: depth, numbers and surface of what each pixel's first sample shows, and the share of its samples that show something.
#include "raster/passes/picture_tile.hpp"

#include <algorithm>
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

}  // namespace

void PictureTile::write_planes(bool empty) {
    const Output& output = pass_.output;
    for (int y_px = written_.y; y_px < written_.y + written_.height; ++y_px) {
        const int x0 = written_.x, count = written_.width, at = (y_px - rect_.y) * kTileStride + (x0 - rect_.x);
        const std::uint32_t* const id = scratch_.buffers.triangle[0] + at;
        if (output.depth) {
            float* const depth = output.depth.at(x0, y_px);
            for (int i = 0; i < count; ++i)
                depth[i] = !empty && id[i] != kNoTriangle
                               ? static_cast<float>(plan_.depth.distance(double{scratch_.buffers.depth[0][at + i]}))
                               : std::numeric_limits<float>::infinity();
        }
        for (const Plane<float>* plane : {&output.normal, &output.shading_normal, &output.albedo, &output.position})
            if (*plane) std::fill_n(plane->at(x0, y_px), 3 * count, 0.0f);
        if (output.lights) std::fill_n(output.lights.at(x0, y_px), count, 0u);
        if (output.barycentric || output.uv)
            for (int i = 0; i < count; ++i) {
                const TrianglePoint point =
                    !empty && id[i] != kNoTriangle ? pass_.view.geometry.point_at(id[i], x0 + i, y_px) : TrianglePoint{};
                write2(output.barycentric, x0 + i, y_px, point.weight[1], point.weight[2]);
                write2(output.uv, x0 + i, y_px, point.u, point.v);
            }
        write_numbers(empty ? nullptr : id, x0, y_px, count);
        if (output.coverage) {
            float* const coverage = output.coverage.at(x0, y_px);
            for (int i = 0; i < count; ++i) {
                int covered = 0;
                for (int s = 0; s < samples_ && !empty; ++s) covered += scratch_.buffers.triangle[s][at + i] != kNoTriangle ? 1 : 0;
                coverage[i] = static_cast<float>(covered) / static_cast<float>(samples_);
            }
        }
    }
}

void PictureTile::write_numbers(const std::uint32_t* id, int x_px, int y_px, int count) const {
    const Output& output = pass_.output;
    if (!output.instance && !output.triangle) return;
    std::uint32_t* const instances = output.instance ? output.instance.at(x_px, y_px) : nullptr;
    std::uint32_t* const triangles = output.triangle ? output.triangle.at(x_px, y_px) : nullptr;
    const ViewGeometry& geometry = pass_.view.geometry;
    const Draw* const only = geometry.draws().size() == 1 ? geometry.draws().data() : nullptr;
    for (int i = 0; i < count;) {
        // Neighbours mostly show one triangle.
        const std::uint32_t one = id != nullptr ? id[i] : kNoTriangle;
        int end = i + 1;
        while (end < count && (id == nullptr || id[end] == one)) ++end;
        std::uint32_t instance = 0, triangle = 0;
        if (one != kNoTriangle) {
            const Draw& draw = only != nullptr ? *only : geometry.draw_of(geometry.record(one));
            instance = draw.instance + 1;
            if (triangles != nullptr) triangle = geometry.triangle_of(one, draw) + 1;
        }
        if (instances != nullptr) std::fill(instances + i, instances + end, instance);
        if (triangles != nullptr) std::fill(triangles + i, triangles + end, triangle);
        i = end;
    }
}

void PictureTile::count_visible() {
    for (int y = written_.y - rect_.y; y < written_.y - rect_.y + written_.height; ++y) {
        const int at = y * kTileStride + (written_.x - rect_.x);
        int visible = 0;
        for (int i = at; i < at + written_.width; ++i) {
            std::uint32_t all = scratch_.buffers.triangle[0][i];  // kNoTriangle if no sample shows one
            for (int s = 1; s < samples_; ++s) all &= scratch_.buffers.triangle[s][i];
            visible += all != kNoTriangle ? 1 : 0;
        }
        counts_.pixels_visible += static_cast<std::uint64_t>(visible);
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
