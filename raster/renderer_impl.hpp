// Members of a Renderer, and the steps of a frame.
#pragma once

#include "halflit/renderer.hpp"
#include "raster/frame_plan.hpp"
#include "raster/passes/behind.hpp"
#include "raster/passes/picture_tile.hpp"
#include "raster/passes/shadow_maps.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace halflit {

struct Renderer::Impl {
    struct EdgeDrawing;
    /// Inputs of a plan.
    struct PlanKey {
        raster::SceneRevision scene;
        Camera camera;
        Settings settings;
        int width, height, tile_size;
        friend bool operator==(const PlanKey&, const PlanKey&) = default;
    };

    raster::Executor executor;
    raster::FramePlanMemory plan_memory;
    std::optional<PlanKey> plan_key;
    Lighting plan_light;
    raster::FramePlan plan;
    raster::ShadowMaps shadow_maps;
    raster::ViewGeometry geometry;
    raster::VertexRecords records;
    /// For the planes of surfaces: shading needs their attributes of some materials only, and keeps light in their place at a rate below
    /// one a pixel.
    raster::VertexRecords surface;
    std::vector<shading::MaterialPlan> surface_materials;
    raster::ReferenceShading reference;
    raster::Behind behind;
    raster::EyeDome eye_dome;
    raster::SplatPicture splats;
    std::unique_ptr<EdgeDrawing> edge_drawing;  ///< only where edges are drawn
    raster::Pool<raster::TileScratch> scratch;

    Impl();
    ~Impl();

    Result<void> make_plan(const raster::PreparedData& scene, const Lighting& light, const Camera& camera, const Settings& settings,
                           const Target& target, int tile_size);
    /// of_materials: base colours and normal maps are read too, whatever light there is.
    void make_surface(const raster::PreparedData& scene, const raster::RasterKernels& kernels, bool of_materials);
    /// Draws what is seen through glass that blurs or bends light, the first half of the progress.
    raster::TileCounts draw_behind(const raster::PicturePass& pass, const Settings& settings, const Execution& execution);
    /// Paints Settings::edges over the finished picture.
    Result<void> draw_edges(const raster::PreparedData& scene, const Camera& camera, const Settings& settings, const raster::Output& output,
                            std::vector<DrawnEdge>* found, int width, int height, const Execution& execution, Isa isa);
    /// begun: the progress before.
    raster::TileCounts draw_tiles(const raster::PicturePass& pass, const Execution& execution, double begun);

    /// only: PicturePass::only.
    Result<RenderReport> render(const raster::PreparedData& scene, const Lighting& light, const Camera& camera, const Settings& settings,
                                const Target& target, const Execution& execution, Isa isa, RenderReport report,
                                const raster::PixelMask* only = nullptr);
    /// The same within Execution::memory_limit. What a renderer keeps of other frames may be more than the limit leaves: then it is
    /// replaced by a fresh one, so that only the frame itself decides.
    static Result<RenderReport> render_within_memory(std::unique_ptr<Impl>& impl, const raster::PreparedData& scene, const Lighting& light,
                                                     const Camera& camera, const Settings& settings, const Target& target,
                                                     const Execution& execution, Isa isa, const RenderReport& report);
};

}  // namespace halflit
