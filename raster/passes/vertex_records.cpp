#include "raster/passes/vertex_records.hpp"
#include "sh/mat4.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace halflit::raster {
namespace {

template <class T>
const float* floats(const std::vector<T>& v) {
    return v.empty() ? nullptr : &v[0].x;
}

VertexRecordArgs record_args(const Draw& draw, const Mesh& mesh, const Mat4& world_from_object, shading::SlotMask slots, float* records,
                             int stride) {
    VertexRecordArgs args{};
    args.positions = floats(mesh.positions);
    args.normals = floats(mesh.normals);
    args.tangents = floats(mesh.tangents);
    args.uv0 = floats(mesh.uv0);
    args.uv1 = floats(mesh.uv1);
    args.colors = floats(mesh.colors);
    args.slots = slots;
    std::memcpy(args.world_from_object, world_from_object.c, sizeof args.world_from_object);
    const NormalMatrix normal = normal_matrix(world_from_object);
    for (int j = 0; j < 3; ++j) {
        args.normal_from_object[4 * j] = normal.c[j].x;
        args.normal_from_object[4 * j + 1] = normal.c[j].y;
        args.normal_from_object[4 * j + 2] = normal.c[j].z;
        args.normal_from_object[4 * j + 3] = 0.0f;
    }
    args.tangent_sign = draw.mirrored ? -1.0f : 1.0f;
    args.stride = stride;
    args.records = records;
    return args;
}

}  // namespace

void VertexRecords::make(const ViewGeometry& geometry, std::span<const shading::MaterialPlan> materials, const RasterKernels& kernels,
                         Executor& executor) {
    std::vector<shading::SlotMask> slots;
    for (const shading::MaterialPlan& material : materials) slots.push_back(material.slots);
    if (version_ == geometry.version() && slots == slots_) return;
    make(geometry, std::move(slots), executor, [&](const Draw&, const VertexRecordArgs& args) { kernels.vertex_records(args); });
    version_ = geometry.version();
}

void VertexRecords::make(const ViewGeometry& geometry, std::vector<shading::SlotMask> slots, Executor& executor, const Fill& fill) {
    const std::span<const Draw> draws = geometry.draws();
    version_ = 0;  // invalid until all is done
    slots_ = std::move(slots);

    strides_.resize(draws.size());
    record_bases_.resize(draws.size());
    draw_records_.resize(draws.size());
    std::int64_t size = 0;
    for (std::size_t d = 0; d < draws.size(); ++d) {
        strides_[d] = 4 * std::popcount(slots_[static_cast<std::size_t>(draws[d].material)]);
        record_bases_[d] = size;
        size += draws[d].record_count * strides_[d];
    }
    float* records = records_.reserve(static_cast<std::size_t>(size), executor.stop());
    for (std::size_t d = 0; d < draws.size(); ++d) {
        const int shift = draws[d].vertex_shift();
        draw_records_[d] = {records + record_bases_[d] - (draws[d].vertex_base >> shift) * strides_[d], shift};
    }

    constexpr std::int64_t kGroupsPerTask = 64;
    const std::int64_t groups = draws.empty() ? 0 : draws.back().group_base + draws.back().group_count();
    executor.run(static_cast<int>((groups + kGroupsPerTask - 1) / kGroupsPerTask), [&](int task) {
        std::int64_t group = task * kGroupsPerTask;
        const std::int64_t end = std::min(group + kGroupsPerTask, groups);
        auto draw = std::upper_bound(draws.begin(), draws.end(), group, [](std::int64_t g, const Draw& d) { return g < d.group_base; }) - 1;
        for (; group < end; ++draw) {
            const auto d = static_cast<std::size_t>(draw - draws.begin());
            const std::int64_t draw_end = std::min(end, draw->group_base + draw->group_count());
            VertexRecordArgs args{};
            for (; group < draw_end; ++group) {
                if (strides_[d] == 0 || !geometry.group_is_drawn(group)) continue;
                if (args.records == nullptr) {
                    args = record_args(*draw, geometry.scene().source_mesh(draw->mesh),
                                       geometry.scene().scene().instances[draw->instance].world_from_object,
                                       slots_[static_cast<std::size_t>(draw->material)], records + record_bases_[d], strides_[d]);
                    if (geometry.has_only_used_vertices()) {
                        args.vertices = geometry.mesh_vertices() + draw->vertex_base;
                        args.vertex_shift = draw->vertex_shift();
                    }
                }
                args.begin = (group - draw->group_base) * kVertexGroup;
                args.end = std::min(args.begin + kVertexGroup, draw->record_count);
                fill(*draw, args);
            }
        }
    });
    make_clip_records(geometry, executor);
}

void VertexRecords::make_clip_records(const ViewGeometry& geometry, Executor& executor) {
    const auto chunks = geometry.chunks();
    clip_floats_.resize(std::max(clip_floats_.size(), chunks.size()));
    clip_records_.resize(chunks.size());
    executor.run(static_cast<int>(chunks.size()), [&](int i) {
        const Chunk& chunk = *chunks[static_cast<std::size_t>(i)];
        std::vector<float>& floats = clip_floats_[static_cast<std::size_t>(i)];
        floats.resize(chunk.clip_vertices.size() * shading::kVertexFloats);
        for (std::size_t k = 0; k < chunk.clip_vertices.size(); ++k) {
            const ClipVertex& v = chunk.clip_vertices[k];
            const std::int64_t stride = strides_[v.draw];
            const float* parent[3];
            for (int c = 0; c < 3; ++c) parent[c] = draw_records_[v.draw].of(v.parent[c], stride);
            float* out = floats.data() + k * shading::kVertexFloats;
            for (std::int64_t j = 0; j < stride; ++j)
                out[j] = (parent[0][j] * v.weight[0] + parent[1][j] * v.weight[1]) + parent[2][j] * v.weight[2];
        }
        clip_records_[static_cast<std::size_t>(i)] = floats.data();
    });
}

}  // namespace halflit::raster
