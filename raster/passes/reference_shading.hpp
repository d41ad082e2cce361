// Shading of visible fragments by the float64 reference instead of the kernels: the truth that errors are measured against.
#pragma once

#include "raster/scene/prepared_scene.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/reference/irradiance.hpp"

#include <memory>
#include <vector>

namespace halflit::raster {

class ReferenceShading {
public:
    /// For a frame of `scene` as `plan` has it. Keeps the environments' irradiance while environment and lobes stay the same.
    Result<void> build(const PreparedScene& scene, const shading::ShadingPlan& plan, const shading::PlanOptions& options);

    /// Writes the colour rows of lanes [0, count). Visibility of lights is the kernels' own.
    void shade(const shading::ShadeKernels& kernels, const shading::ShadingPlan& plan, int material, shading::FragmentBlock& block,
               int count) const;

private:
    /// Light from all around for the materials of one lobe.
    struct Around {
        shading::Lobe lobe;
        std::shared_ptr<const shading::reference::Irradiance> light;
    };
    std::shared_ptr<const shading::reference::Irradiance> diffuse(const shading::Lobe& lobe);

    const PreparedScene* scene_ = nullptr;
    shading::reference::FrameInputs frame_;
    std::shared_ptr<const shading::Environment> environment_;  ///< that of known_
    std::uint64_t environment_id_ = 0;
    std::vector<Around> known_;
    std::vector<std::shared_ptr<const shading::reference::Irradiance>> diffuse_, specular_;  ///< for each material
};

}  // namespace halflit::raster
