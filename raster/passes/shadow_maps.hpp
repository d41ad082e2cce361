// The shadow pass: depths as the lights see them, by the same passes as the picture, as distances in world units.
#pragma once

#include "raster/frame_plan.hpp"
#include "raster/passes/tile.hpp"

namespace halflit::raster {

/// Draws the maps of a plan to where its texels are. A map stays as it is while neither its view nor anything in the scene that casts has
/// changed.
class ShadowMaps {
public:
    /// The next draw() draws all maps.
    void forget() { drawn_ = {}; }

    Result<void> draw(const PreparedScene& scene, const FramePlan& plan, RawBuffer<float>& texels, const RasterKernels& raster,
                      const shading::ShadeKernels& shade, Executor& executor);

private:
    /// What the texels hold, and of what.
    struct Drawn {
        std::size_t capacity = 0;  ///< of the texels' memory: grown memory has lost them
        std::uint64_t geometry_revision = 0, materials_revision = 0;
        shading::TextureDetail caster_detail = shading::TextureDetail::full;
        std::vector<ShadowView> views;
    };
    Result<void> draw_face(const PreparedScene& scene, const FramePlan& plan, const ShadowView& face, float* texels,
                           const RasterKernels& raster, const shading::ShadeKernels& shade, Executor& executor);

    Drawn drawn_;
    ViewGeometry geometry_;
    VertexRecords records_;
    Pool<TileScratch> scratch_;
};

}  // namespace halflit::raster
