#include "raster/passes/shading_rate.hpp"

#include "raster/passes/count_work.hpp"

#include <algorithm>
#include <mutex>

namespace halflit::raster {
namespace {

using shading::FragmentBlock;
using shading::kBlockSize;

constexpr int kLightRows = 6;

/// Copies a vertex record into lane `l`.
void load_lane(FragmentBlock& block, int l, const float* record, shading::SlotMask slots) {
    for (int q = 0; q < shading::kSlotCount; ++q) {
        if ((slots & (1u << q)) == 0) continue;
        for (int j = 0; j < 4; ++j) block.lane[4 * q + j][l] = *record++;
    }
}

/// Sets texture gradients to 0, so that the finest level is read: footprints are known at pixels only. Copies the last lane to the lanes
/// from `count` on.
void finish_lanes(FragmentBlock& block, int count) {
    for (int row = shading::kDu0Dx; row <= shading::kDv1Dy; ++row)
        for (float& v : block.lane[row]) v = 0.0f;
    for (auto& row : block.lane)
        for (int l = count; l < kBlockSize; ++l) row[l] = row[count - 1];
}

Vec3f row3(const FragmentBlock& block, int row, int l) { return {block.lane[row][l], block.lane[row + 1][l], block.lane[row + 2][l]}; }

/// Loads a triangle into lane `l`: the mean of its vertices, with the normal of its plane on the viewer's side.
void load_triangle(const TilePass& pass, std::uint32_t id, shading::SlotMask slots, FragmentBlock& block, int l) {
    const TriangleRecord& triangle = pass.geometry.record(id);
    const std::size_t chunk = pass.geometry.chunk_of(id), draw = triangle.draw();
    const float* v[3];
    for (int k = 0; k < 3; ++k) v[k] = pass.records.of_corner(chunk, draw, triangle.vertex[k]);
    float mean[shading::kVertexFloats];
    const int stride = pass.records.stride(draw);
    for (int j = 0; j < stride; ++j) mean[j] = ((v[0][j] + v[1][j]) + v[2][j]) * (1.0f / 3.0f);
    load_lane(block, l, mean, slots);
    const Vec3f p0{v[0][0], v[0][1], v[0][2]}, p1{v[1][0], v[1][1], v[1][2]}, p2{v[2][0], v[2][1], v[2][2]};
    // Records run clockwise as seen on the screen.
    const Vec3f mean_normal = row3(block, shading::kNormalX, l);
    const Vec3f normal = normalize_or(cross(p2 - p0, p1 - p0), mean_normal);
    block.lane[shading::kNormalX][l] = normal.x;
    block.lane[shading::kNormalY][l] = normal.y;
    block.lane[shading::kNormalZ][l] = normal.z;
    block.lane[shading::kFacing][l] = 1.0f;
}

}  // namespace

WorkCounts light_vertices(const ViewGeometry& geometry, VertexRecords& records, const shading::ShadingPlan& plan,
                          const shading::ShadeKernels& kernels, Executor& executor) {
    struct Group {
        std::size_t draw;
        std::int64_t first;  // record of the draw
        int count;
    };
    const auto material_of = [&](std::size_t draw) -> const shading::MaterialPlan& {
        return plan.materials[static_cast<std::size_t>(geometry.draws()[draw].material)];
    };
    std::vector<Group> groups;
    for (std::size_t d = 0; d < geometry.draws().size(); ++d) {
        const Draw& draw = geometry.draws()[d];
        if ((material_of(d).stages & kStagePrelit) == 0) continue;
        for (std::int64_t g = 0; g < draw.group_count(); ++g)
            if (geometry.group_is_drawn(draw.group_base + g)) {
                const std::int64_t first = g * kVertexGroup;
                groups.push_back({d, first, static_cast<int>(std::min<std::int64_t>(kVertexGroup, draw.record_count - first))});
            }
    }
    records.changed();
    constexpr std::size_t kGroupsPerTask = 16;
    std::mutex mutex;
    WorkCounts work;
    executor.run(static_cast<int>((groups.size() + kGroupsPerTask - 1) / kGroupsPerTask), [&](int task) {
        FragmentBlock block{};
        WorkCounts of_task;
        const std::size_t end = std::min(groups.size(), static_cast<std::size_t>(task + 1) * kGroupsPerTask);
        for (std::size_t g = static_cast<std::size_t>(task) * kGroupsPerTask; g < end; ++g) {
            const Group& group = groups[g];
            const shading::MaterialPlan& material = material_of(group.draw);
            for (int l = 0; l < group.count; ++l) {
                load_lane(block, l, records.record(group.draw, group.first + l), material.slots);
                // A vertex has no front or back: double-sided surfaces are lit on the viewer's side.
                const Vec3f to_eye = plan.orthographic ? plan.view_direction_ws * -1.0f : plan.eye_ws - row3(block, shading::kPosX, l);
                block.lane[shading::kFacing][l] = dot(row3(block, shading::kNormalX, l), to_eye) < 0.0f ? -1.0f : 1.0f;
            }
            finish_lanes(block, group.count);
            kernels.light(plan, material, shading::all_lights(plan), block, group.count);
            count_prelighting(of_task, plan, material, group.count);
            for (int l = 0; l < group.count; ++l)
                for (int j = 0; j < kLightRows; ++j) records.record(group.draw, group.first + l)[j] = block.lane[j][l];
        }
        const std::lock_guard lock(mutex);
        work += of_task;
    });
    records.make_clip_records(geometry, executor);
    return work;
}

void light_triangles(const TilePass& pass, const shading::ShadingPlan& plan, const FragmentList& list, FragmentBlock& block,
                     WorkCounts& work) {
    const shading::MaterialPlan& material = plan.materials[static_cast<std::size_t>(list.material)];
    FragmentBlock triangles{};
    int of_lane[kBlockSize], count = 0;
    for (int l = 0; l < list.count; ++l) {
        if (l == 0 || list.id[l] != list.id[l - 1]) load_triangle(pass, list.id[l], material.slots, triangles, count++);
        of_lane[l] = count - 1;
    }
    finish_lanes(triangles, count);
    pass.shade.light(plan, material, shading::all_lights(plan), triangles, count);
    count_prelighting(work, plan, material, count);
    for (int l = 0; l < kBlockSize; ++l)
        for (int j = 0; j < kLightRows; ++j) block.lane[j][l] = triangles.lane[j][of_lane[l < list.count ? l : list.count - 1]];
}

}  // namespace halflit::raster
