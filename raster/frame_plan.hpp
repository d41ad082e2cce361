// The plan of a frame: everything that is decided before anything is drawn, in one object that does not change. The renderer draws it;
// whoever wants to know what a frame requires reads it.
#pragma once

#include "raster/detail/raw_buffer.hpp"
#include "raster/report.hpp"
#include "raster/scene/prepared_scene.hpp"
#include "raster/settings.hpp"
#include "raster/view/background.hpp"
#include "raster/view/light_culling.hpp"
#include "raster/view/shadow_views.hpp"
#include "raster/view/view.hpp"
#include "shading/planner.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace halflit::raster {

struct FramePlan {
    View picture;
    shading::ShadingPlan shading;          ///< materials, lights, environments, shadow maps, error bound: what the kernels read
    std::vector<ShadowView> shadow_views;  ///< what the shadow maps are drawn from
    std::vector<shading::MaterialPlan>
        casters;  ///< what alpha tests in shadow maps read of the materials; empty where no material has a mask
    shading::TextureDetail caster_detail = shading::TextureDetail::full;  ///< how they filter
    LightCuller light_culler;                                             ///< which lights a block of fragments needs
    Background background;                                                ///< instead of background_linear, where it is one
    Vec4f background_linear{0, 0, 0, 0};
    float exposure = 1.0f;
    shading::ShadingRate rate = shading::ShadingRate::pixel;
    bool reference = false;  ///< fragments are shaded by the float64 reference
    std::vector<EnvironmentUse> environment_uses;
    std::vector<std::string> warnings;
};

/// What planning keeps from frame to frame of one renderer.
struct FramePlanMemory {
    shading::PlanMemory shading;
    /// Squared distances from lights to the nearest surface, and the geometry that they are of.
    std::uint64_t geometry_revision = 0;
    std::map<std::array<double, 3>, double> light_distances;
    /// Of all shadow maps, one after the other. None: the plan is only read, and its maps have no texels.
    std::optional<RawBuffer<float>> shadow_texels;
};

/// Plans a picture of width x height pixels. Fails for settings that are out of range or exclude each other, and for a camera without a
/// finite matrix.
Result<FramePlan> plan_frame(const PreparedScene& scene, const Camera& camera, const Settings& settings, int width, int height,
                             FramePlanMemory& memory);

/// The same for whoever only reads the plan: its shadow maps have no texels.
Result<FramePlan> plan_frame(const PreparedScene& scene, const Camera& camera, const Settings& settings, int width, int height);

}  // namespace halflit::raster
