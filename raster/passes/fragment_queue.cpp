#include "raster/passes/fragment_queue.hpp"

namespace halflit::raster {

void interpolate(const Frame& frame, FragmentList& list, shading::FragmentBlock& block) {
    const int last = list.count - 1, padded = (list.count + 15) & ~15;
    for (int l = list.count; l < padded; ++l) {
        list.id[l] = list.id[last];
        list.x_px[l] = list.x_px[last];
        list.y_px[l] = list.y_px[last];
    }
    const shading::MaterialPlan& plan = frame.plan.materials[static_cast<std::size_t>(list.material)];
    InterpolateArgs args{};
    args.triangles = frame.table();
    args.draws = frame.draw_records.data();
    args.clip_records = frame.clip_records.data();
    args.slots = plan.slots;
    args.stride = 4 * __builtin_popcount(plan.slots);
    args.gradients = (plan.stages & shading::kStageGradients) != 0;
    args.facing = plan.double_sided;
    args.shadow_offset =
        frame.plan.shadow_offset && (plan.stages & (shading::kStageLights | shading::kStagePrelit)) == shading::kStageLights;
    args.count = padded;
    args.ids = list.id;
    args.x_px = list.x_px;
    args.y_px = list.y_px;
    frame.raster->interpolate(args, block);
}

}  // namespace halflit::raster
