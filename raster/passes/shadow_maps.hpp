// The shadow pass: depths as the lights see them, by the same passes as the picture, as distances in world units.
#pragma once

#include "raster/frame_plan.hpp"
#include "raster/passes/tile.hpp"

namespace halflit::raster {

/// Draws the maps of a plan. A map stays as it is while neither its view nor anything in the scene that casts has changed.
class ShadowMaps {
public:
    /// Where the texels of a plan's maps will be; the plan points there.
    [[nodiscard]] float* reserve(std::size_t texel_count);
    /// The next draw() draws all maps.
    void forget() { drawn_.clear(); }

    Result<void> draw(const PreparedScene& scene, const FramePlan& plan, const RasterKernels& raster, const shading::ShadeKernels& shade,
                      Executor& executor);

private:
    Result<void> draw_face(const PreparedScene& scene, const FramePlan& plan, const ShadowView& face, const RasterKernels& raster,
                           const shading::ShadeKernels& shade, Executor& executor);

    RawBuffer<float> texels_;
    std::vector<ShadowView> drawn_;  ///< what the texels hold
    SceneRevision revision_;         ///< of the scene that they show
    ViewGeometry geometry_;
    VertexRecords records_;
    Pool<TileScratch> scratch_;
};

}  // namespace halflit::raster
