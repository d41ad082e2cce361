#include "raster/detail/reference_shading.hpp"

#include <algorithm>

namespace halflit::raster {

namespace reference = shading::reference;

std::shared_ptr<const reference::Irradiance> ReferenceShading::diffuse(const Scene& scene, const shading::Lobe& lobe) {
    const auto same = [&](const Around& a) { return a.environment == scene.environment.get() && a.lobe == lobe; };
    const auto found = std::find_if(known_.begin(), known_.end(), same);
    if (found != known_.end()) return found->light;
    known_.push_back({scene.environment.get(), lobe, std::make_shared<reference::DirectIrradiance>(*scene.environment, lobe)});
    return known_.back().light;
}

Result<void> ReferenceShading::build(const Scene& scene, const shading::FramePlan& plan, const shading::PlanOptions& options,
                                     std::vector<shading::QuadMask> available) {
    if (scene.environment != nullptr && scene.environment->lit_rgb.empty())
        return fail(ErrorCode::usage, "accuracy reference: the environment was made without keep_light");
    scene_ = &scene;
    available_ = std::move(available);
    frame_ = {scene.textures, scene.lights, scene.ambient, options, plan.eye_ws, plan.view_direction_ws, plan.orthographic, plan.shadow_mode};
    std::erase_if(known_, [&](const Around& a) { return a.environment != scene.environment.get(); });
    diffuse_.assign(plan.materials.size(), nullptr);
    mirrored_.assign(plan.materials.size(), nullptr);
    if (scene.environment == nullptr) return {};
    for (std::size_t i = 0; i < plan.materials.size(); ++i) {
        const shading::Material& material = i < scene.materials.size() ? scene.materials[i] : no_material_;
        diffuse_[i] = diffuse(scene, options.override_lobe && !material.has_own_lobe ? options.lobe : material.lobe);
        const double alpha = std::max(static_cast<double>(plan.materials[i].roughness), 0.07), alpha2 = alpha * alpha;
        const double power = std::max(1.0, (2.0 / (alpha2 * alpha2) - 2.0) * 0.25);
        mirrored_[i] = std::make_shared<reference::BandIrradiance>(*scene.environment, 0.0, power, 0.5 * (power + 1.0));
    }
    return {};
}

void ReferenceShading::shade(const shading::ShadeKernels& kernels, const shading::FramePlan& plan, int material,
                             shading::FragmentBlock& block, int count) const {
    const auto index = static_cast<std::size_t>(material);
    const shading::MaterialPlan& material_plan = plan.materials[index];
    const shading::Material& source = index < scene_->materials.size() ? scene_->materials[index] : no_material_;
    std::vector<double> core(scene_->lights.size() * shading::kBlockSize), excess(core.size());
    for (const shading::LightPlan& light : plan.lights) {
        if (light.shadow_map < 0) continue;
        alignas(64) float hidden[2][shading::kBlockSize];
        kernels.hidden(plan, material_plan, light, block, count, hidden[0], hidden[1]);
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(count); ++lane) {
            const std::size_t at = lane * scene_->lights.size() + static_cast<std::size_t>(light.source);
            core[at] = static_cast<double>(hidden[0][lane]);
            excess[at] = static_cast<double>(hidden[1][lane]);
        }
    }
    reference::Surroundings around;
    around.diffuse = diffuse_[index].get();
    around.mirrored = mirrored_[index].get();
    reference::Frame frame = frame_;
    frame.shadow_mode = plan.shadow_mode;
    for (int lane = 0; lane < count; ++lane) {
        const std::size_t first = static_cast<std::size_t>(lane) * scene_->lights.size();
        around.hidden_core = std::span(core).subspan(first, scene_->lights.size());
        around.hidden_excess = std::span(excess).subspan(first, scene_->lights.size());
        const reference::Rgba color = reference::shade(frame, source, available_[index], block, lane, around);
        block.red[lane] = static_cast<float>(color.r);
        block.green[lane] = static_cast<float>(color.g);
        block.blue[lane] = static_cast<float>(color.b);
        block.alpha[lane] = static_cast<float>(color.a);
    }
}

}  // namespace halflit::raster
