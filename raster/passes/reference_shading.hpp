// Shading of visible fragments by the float64 reference instead of the kernels. Errors are measured against it.
#pragma once

#include "raster/detail/stop_signal.hpp"
#include "raster/scene/prepared_data.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/reference/irradiance.hpp"

#include <memory>
#include <vector>

namespace halflit::raster {

class ReferenceShading {
public:
    /// Prepares a frame of `scene` by `plan`. Keeps the irradiance of each lobe while the environment stays the same.
    /// options: those in effect (FramePlan::options).
    Result<void> build(const PreparedData& scene, const Lighting& light, const shading::ShadingPlan& plan, const ShadingSettings& options);

    /// Writes the colour rows of lanes [0, count). The visibility of lights is that of the kernels' shadow maps.
    void shade(const shading::ShadeKernels& kernels, const shading::ShadingPlan& plan, int material, shading::FragmentBlock& block,
               int count, StopSignal& stop) const;

private:
    /// Irradiance of the environment for the materials of one lobe.
    struct Around {
        Lobe lobe;
        std::shared_ptr<const shading::reference::Irradiance> light;
    };
    std::shared_ptr<const shading::reference::Irradiance> diffuse(const Lobe& lobe);

    const PreparedData* scene_ = nullptr;
    shading::reference::FrameInputs frame_;
    shading::EnvironmentSlot environment_;
    std::vector<Light> lights_;                                                   ///< suns at the end
    std::vector<const SunShape*> suns_;                                           ///< for each of them, or null
    std::vector<Around> known_;                                                   ///< of environment_
    std::vector<std::shared_ptr<const shading::reference::Irradiance>> diffuse_;  ///< per material
};

}  // namespace halflit::raster
