// The transform pass: transforms to the window every vertex group that some cluster in view reads.
#include "raster/passes/quads.hpp"
#include "raster/passes/view_geometry.hpp"
#include "raster/view/culling.hpp"

#include <algorithm>
#include <cstring>

namespace halflit::raster {

void ViewGeometry::transform(const Batch& batch, const RasterKernels& kernels, Executor& executor) {
    constexpr std::int64_t kGroupsPerTask = 64;
    ScreenVertex* screen = screen_.reserve(static_cast<std::size_t>(batch.vertex_count), executor.stop());
    std::uint8_t* outcodes = outcodes_.reserve(static_cast<std::size_t>(batch.vertex_count), executor.stop());
    const Draw& last_draw = draws_[batch.end_draw - 1];
    const std::int64_t first_group = draws_[batch.first_draw].group_base, end_group = last_draw.group_base + last_draw.group_count();
    const std::uint8_t* seen = groups_seen_.data();
    executor.run(static_cast<int>((end_group - first_group + kGroupsPerTask - 1) / kGroupsPerTask), [&](int task) {
        std::int64_t group = first_group + task * kGroupsPerTask;
        const std::int64_t end = std::min(group + kGroupsPerTask, end_group);
        auto draw =
            std::upper_bound(draws_.begin(), draws_.end(), group, [](std::int64_t g, const Draw& d) { return g < d.group_base; }) - 1;
        for (; group < end; ++draw) {
            const std::int64_t draw_end = std::min(end, draw->group_base + draw->group_count());
            TransformArgs args{};
            while (group < draw_end) {
                if (!seen[group]) {
                    ++group;
                    continue;
                }
                const std::int64_t first = group;
                while (group < draw_end && seen[group]) ++group;
                if (args.positions == nullptr) {
                    const Mat4 clip_from_object =
                        multiply_in_double(view_.clip_from_world, scene_->scene().instances[draw->instance].world_from_object);
                    std::memcpy(args.clip_from_object, clip_from_object.c, sizeof args.clip_from_object);
                    args.positions = &scene_->source_mesh(draw->mesh).positions[0].x;
                    args.viewport = view_.viewport;
                    args.screen = screen + draw->vertex_base;
                    args.outcodes = outcodes + draw->vertex_base;
                }
                args.begin = (first - draw->group_base) * kVertexGroup;
                args.end = std::min((group - draw->group_base) * kVertexGroup, draw->vertex_count);
                if (draw->quads())
                    transform_quads(kernels, args, *draw, view_);
                else
                    kernels.transform(args);
            }
        }
    });
}

}  // namespace halflit::raster
