#include "raster/passes/reference_shading.hpp"

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

Result<void> ReferenceShading::build(const Scene& scene, const shading::ShadingPlan& plan, const shading::PlanOptions& options,
                                     std::vector<shading::SlotMask> available) {
    if (scene.environment != nullptr && scene.environment->lit_rgb.empty())
        return fail(ErrorCode::usage, "accuracy reference: the environment was made without keep_light");
    scene_ = &scene;
    available_ = std::move(available);
    frame_ = {scene.textures, scene.lights, scene.ambient, options, plan.eye_ws, plan.view_direction_ws, plan.orthographic, plan.shadow_mode};
    std::erase_if(known_, [&](const Around& a) { return a.environment != scene.environment.get(); });
    diffuse_.assign(plan.materials.size(), nullptr);
    specular_.assign(plan.materials.size(), nullptr);
    if (scene.environment == nullptr) return {};
    for (std::size_t i = 0; i < plan.materials.size(); ++i) {
        const shading::Material& material = i < scene.materials.size() ? scene.materials[i] : no_material_;
        diffuse_[i] = diffuse(scene, shading::lobe_of(material, options));
        specular_[i] = std::make_shared<reference::BandIrradiance>(*scene.environment, shading::specular_environment_lobe(plan.materials[i].roughness));
    }
    return {};
}

void ReferenceShading::shade(const shading::ShadeKernels& kernels, const shading::ShadingPlan& plan, int material,
                             shading::FragmentBlock& block, int count) const {
    const auto index = static_cast<std::size_t>(material);
    const shading::MaterialPlan& material_plan = plan.materials[index];
    const shading::Material& source = index < scene_->materials.size() ? scene_->materials[index] : no_material_;
    std::vector<reference::Hidden> hidden(plan.shadow_maps.empty() ? 0 : scene_->lights.size() * shading::kBlockSize);
    for (const shading::LightPlan& light : plan.lights) {
        if (light.shadow_map < 0) continue;
        alignas(64) float core[shading::kBlockSize], excess[shading::kBlockSize];
        kernels.hidden(plan, material_plan, light, block, count, core, excess);
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(count); ++lane) {
            reference::Hidden& share = hidden[lane * scene_->lights.size() + static_cast<std::size_t>(light.source)];
            share.hard = static_cast<double>(core[lane]);
            share.soft = static_cast<double>(excess[lane]);
        }
    }
    reference::Surroundings around;
    around.diffuse = diffuse_[index].get();
    around.specular = specular_[index].get();
    reference::Frame frame = frame_;
    frame.shadow_mode = plan.shadow_mode;
    for (int lane = 0; lane < count; ++lane) {
        if (!hidden.empty())
            around.hidden = std::span(hidden).subspan(static_cast<std::size_t>(lane) * scene_->lights.size(), scene_->lights.size());
        const reference::Rgba color = reference::shade(frame, source, available_[index], block, lane, around);
        block.red[lane] = static_cast<float>(color.r);
        block.green[lane] = static_cast<float>(color.g);
        block.blue[lane] = static_cast<float>(color.b);
        block.alpha[lane] = static_cast<float>(color.a);
    }
}

}  // namespace halflit::raster
