#include "raster/passes/reference_shading.hpp"

#include <algorithm>

namespace halflit::raster {

namespace reference = shading::reference;

namespace {

/// Hidden shares of a block's lanes, lane after lane; empty where nothing is hidden.
struct HiddenShares {
    std::vector<reference::Hidden> lights, sky;
    std::vector<double> sky_terms;
};

/// The lane's part of a list.
template <class Share>
std::span<const Share> of_lane(const std::vector<Share>& shares, int lane) {
    const std::size_t count = shares.size() / shading::kBlockSize;
    return std::span(shares).subspan(static_cast<std::size_t>(lane) * count, count);
}

HiddenShares hidden_shares(const shading::ShadeKernels& kernels, const shading::ShadingPlan& plan, const shading::MaterialPlan& material,
                           std::size_t light_count, const shading::FragmentBlock& block, int count) {
    alignas(64) float core[shading::kBlockSize], excess[shading::kBlockSize];
    HiddenShares out;
    if (!plan.shadow_maps.empty()) out.lights.resize(light_count * shading::kBlockSize);
    for (const shading::LightPlan& light : plan.lights) {
        if (light.shadow_map < 0) continue;
        kernels.hidden(plan, material, light, block, count, core, excess);
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(count); ++lane) {
            reference::Hidden& share = out.lights[lane * light_count + static_cast<std::size_t>(light.source)];
            share.hard = static_cast<double>(core[lane]);
            share.soft = static_cast<double>(excess[lane]);
        }
    }
    if (plan.sky_grid.hidden != nullptr) {
        alignas(64) float terms[shading::kGridTerms][shading::kBlockSize];
        kernels.hidden_sky(plan, material, block, count, terms);
        for (int lane = 0; lane < shading::kBlockSize; ++lane)
            for (const auto& term : terms) out.sky_terms.push_back(lane < count ? double{term[lane]} : 0.0);
        return out;
    }
    out.sky.resize(plan.sky.size() * shading::kBlockSize);
    for (std::size_t i = 0; i < plan.sky.size(); ++i) {
        if (plan.sky[i].shadow_map < 0) continue;
        kernels.hidden(plan, material, plan.sky[i], block, count, core, excess);
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(count); ++lane)
            out.sky[lane * plan.sky.size() + i] = {static_cast<double>(core[lane]), static_cast<double>(excess[lane]), 0.0};
    }
    return out;
}

}  // namespace

std::shared_ptr<const reference::Irradiance> ReferenceShading::diffuse(const Lobe& lobe) {
    const auto same = [&](const Around& a) { return a.lobe == lobe; };
    const auto found = std::find_if(known_.begin(), known_.end(), same);
    if (found != known_.end()) return found->light;
    known_.push_back({lobe, std::make_shared<reference::DirectIrradiance>(*environment_, lobe)});
    return known_.back().light;
}

Result<void> ReferenceShading::build(const PreparedData& prepared, const Lighting& light, const shading::ShadingPlan& plan,
                                     const ShadingSettings& options) {
    if (light.environment != nullptr && !light.environment->kept_light)
        return fail(ErrorCode::usage, "accuracy reference: the environment was made without keep_light");
    scene_ = &prepared;
    lights_ = light.all_lights();
    frame_ = {prepared.scene().textures, lights_,           light.ambient,   options, plan.eye_ws,
              plan.view_direction_ws,    plan.orthographic, plan.shadow_mode};
    suns_.assign(light.lights.size(), nullptr);
    if (light.environment != nullptr && light.suns)
        for (const SunShape& sun : light.environment->sun_shapes) suns_.push_back(&sun);
    frame_.suns = suns_;
    if (environment_.replace(light.environment)) known_.clear();
    diffuse_.assign(plan.materials.size(), nullptr);
    if (light.environment == nullptr) return {};
    for (std::size_t i = 0; i < plan.materials.size(); ++i) diffuse_[i] = diffuse(shading::lobe_of(prepared.material(i), options));
    return {};
}

void ReferenceShading::shade(const shading::ShadeKernels& kernels, const shading::ShadingPlan& plan, int material,
                             shading::FragmentBlock& block, int count, StopSignal& stop) const {
    const auto index = static_cast<std::size_t>(material);
    const shading::MaterialPlan& material_plan = plan.materials[index];
    const HiddenShares near = hidden_shares(kernels, plan, material_plan, lights_.size(), block, count);
    HiddenShares far;
    if ((material_plan.stages & kStageDiffuseTransmission) != 0) {
        shading::FragmentBlock turned = block;
        for (int lane = 0; lane < count; ++lane)
            for (int i = 0; i < 3; ++i) {
                turned.lane[shading::kNormalX + i][lane] = -block.lane[shading::kNormalX + i][lane];
                turned.lane[shading::kShadowX + i][lane] = 0.0f;
            }
        far = hidden_shares(kernels, plan, material_plan, lights_.size(), turned, count);
    }
    reference::Surroundings around;
    around.sky = plan.sky;
    around.sky_focus = static_cast<double>(plan.sky_focus);
    if (plan.sky_grid.hidden != nullptr) around.sky_grid = &plan.sky_grid;
    around.diffuse = diffuse_[index].get();
    around.reflections = &plan.reflections;
    around.reflection_lobes = material_plan.reflection_lobes;
    if (plan.behind.rgba != nullptr) around.behind = &plan.behind;
    // Rows of the block that the plan does not need hold what was there before.
    const shading::SlotMask filled = scene_->available_slots()[index] & material_plan.slots;
    for (int lane = 0; lane < count; ++lane) {
        stop.check();  // a fragment below a sky takes milliseconds
        around.hidden = of_lane(near.lights, lane), around.hidden_sky = of_lane(near.sky, lane);
        around.hidden_far = of_lane(far.lights, lane), around.hidden_sky_far = of_lane(far.sky, lane);
        around.sky_terms = of_lane(near.sky_terms, lane), around.sky_terms_far = of_lane(far.sky_terms, lane);
        const reference::Rgba color = reference::shade(frame_, scene_->material(index), filled, block, lane, around);
        block.red[lane] = static_cast<float>(color.r);
        block.green[lane] = static_cast<float>(color.g);
        block.blue[lane] = static_cast<float>(color.b);
        block.alpha[lane] = static_cast<float>(color.a);
        if ((material_plan.stages & kStageTransmission) == 0) continue;
        const Vec3d keep = reference::kept(frame_, scene_->material(index), filled, block, lane, around);
        block.keep[0][lane] = static_cast<float>(keep.x);
        block.keep[1][lane] = static_cast<float>(keep.y);
        block.keep[2][lane] = static_cast<float>(keep.z);
    }
}

}  // namespace halflit::raster
