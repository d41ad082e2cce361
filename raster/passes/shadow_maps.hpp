// The shadow pass: draws depth as the lights see it, by the same passes as the picture, and stores distances in world units.
#pragma once

#include "raster/frame_plan.hpp"
#include "raster/passes/tile.hpp"

#include <memory>

namespace halflit::raster {

/// Draws the shadow maps of a plan into `texels`. A map is kept while its view and the scene's geometry and coverage stay the same.
class ShadowMaps {
public:
    /// The next draw() draws all maps.
    void forget() { drawn_ = {}; }

    Result<void> draw(const PreparedData& scene, const FramePlan& plan, RawBuffer<float>& texels, const RasterKernels& raster,
                      const shading::ShadeKernels& shade, Executor& executor);

private:
    /// Inputs of the maps that are in the texels.
    struct Drawn {
        std::size_t capacity = 0;  ///< size of the texels' memory; growing it drops the maps
        std::uint64_t geometry_revision = 0, coverage_revision = 0;
        TextureDetail caster_detail = TextureDetail::full;  ///< texture filter of the alpha tests
        std::vector<ShadowView> views;
    };
    Result<void> draw_face(const PreparedData& scene, const FramePlan& plan, const ShadowView& face, float* texels,
                           const RasterKernels& raster, const shading::ShadeKernels& shade, Executor& executor);

    /// Geometry of the face that is drawn.
    struct Workspace {
        ViewGeometry geometry;
        VertexRecords records;
        bool is_large = false;  ///< of some face so far
    };

    Drawn drawn_;
    std::unique_ptr<Workspace> work_ = std::make_unique<Workspace>();
    Pool<TileScratch> scratch_;
};

}  // namespace halflit::raster
