// The plan of a frame: all decisions that are made before drawing, in one object that does not change. The renderer draws from it. Other
// callers read from it what a frame requires.
#pragma once

#include "halflit/report.hpp"
#include "halflit/settings.hpp"
#include "raster/detail/raw_buffer.hpp"
#include "raster/scene/prepared_data.hpp"
#include "raster/view/background.hpp"
#include "raster/view/contact_shadow.hpp"
#include "raster/view/light_culling.hpp"
#include "raster/view/projection.hpp"
#include "raster/view/shadow_views.hpp"
#include "raster/view/sky_grid.hpp"
#include "raster/view/view.hpp"
#include "shading/planner.hpp"
#include "shading/sky_lights.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace halflit::raster {

/// Eye-dome lighting of a frame.
struct EyeDomePlan {
    float strength = 0.0f;  ///< factor on the sum of rises in eight directions; 0: there is none
    bool all = false;       ///< surfaces of triangles are shaded too
    int radius_px = 0;      ///< of the circle on which depths are read
    /// A difference of depths is a rise over a run of one pixel when it is multiplied by this and, in perspective, divided by the pixel's
    /// own depth + depth_offset.
    float scale = 0.0f, depth_offset = 0.0f;
    bool orthographic = false;
};

/// Codes that the exact picture may be off by for what is not drawn of splats: as much as the roundings of float32 make.
inline constexpr double kExactSplatCodes = 1.0 / 128;

struct FramePlan {
    Camera camera;  ///< drawn_camera()
    View picture;
    bool cells = false;  ///< the light of some material is fitted in cells
    Region written;      ///< the pixels asked for; the picture's region may be larger, to complete cells or to see what is behind glass
    ShadingSettings options;               ///< options in effect: accuracy reference overrides some of those that were asked for
    shading::ShadingPlan shading;          ///< input of the kernels: materials, lights, environments, shadow maps, error bound
    std::vector<ShadowView> shadow_views;  ///< views that the shadow maps are drawn from
    /// Materials as the alpha test of the shadow pass reads them; empty if no material has a mask.
    std::vector<shading::MaterialPlan> casters;
    LightCuller light_culler;  ///< selects the lights of a block of fragments
    Background background;     ///< replaces background_linear if it has an environment
    Vec4f background_linear{0, 0, 0, 0};
    ContactShadow contact_shadow;  ///< over the background
    float exposure = 1.0f;
    ToneCurve tone_curve = ToneCurve::none;
    bool transmits = false;      ///< light passes through some drawn material
    bool looks_through = false;  ///< some drawn material blurs or bends it: what is behind it is drawn first, of the whole picture
    DepthMap depth;              ///< of the picture's depths
    EyeDomePlan eye_dome;
    double splat_codes = 0;  ///< codes that splats may be off by from the exact picture
    Region splat_squares{};  ///< whole squares of splats that hold `written`
    std::vector<EnvironmentUse> environment_uses;
    std::vector<std::string> warnings;
};

/// Results of planning that one renderer keeps from frame to frame.
struct FramePlanMemory {
    shading::PlanMemory shading;
    /// Squared distance from a light's position to the nearest surface, world units. Valid for geometry_revision.
    std::uint64_t geometry_revision = 0;
    std::map<std::array<double, 3>, double> light_distances;
    /// Texels of all shadow maps, one map after the other. Without a value the plan is only read: its maps have no texels.
    std::optional<RawBuffer<float>> shadow_texels;
    const RasterKernels* kernels = &raster_kernels(Isa::scalar);  ///< of the call
    CoverGrid covers;
    SkyGrid sky_grid;
    KeptContactMap contact_map;
    shading::SkyCells sky_cells;
    shading::ForEachRow for_each_row = shading::in_turn;  ///< of the call
    StopSignal* stop = nullptr;                           ///< of the call; null: none, and shadow_texels has no value
};

/// Plans a picture of width x height pixels. Fails for settings that are out of range or exclude each other, and for a camera without a
/// finite matrix.
Result<FramePlan> plan_frame(const PreparedData& scene, const Lighting& light, const Camera& camera, const Settings& settings, int width,
                             int height, int tile_size, FramePlanMemory& memory);

/// The same for callers that only read the plan: its shadow maps have no texels, and its grid of sky shadows no terms.
Result<FramePlan> plan_frame(const PreparedData& scene, const Lighting& light, const Camera& camera, const Settings& settings, int width,
                             int height, int tile_size = Execution{}.tile_size);

}  // namespace halflit::raster
