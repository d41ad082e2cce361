// Lights and materials as the kernel of vertices reads them.
#pragma once

#include "halflit/fixed_function.hpp"
#include "raster/kernels/fixed_function_args.hpp"
#include "raster/passes/view_geometry.hpp"

#include <span>
#include <vector>

namespace halflit::raster {

/// Writes what a frame's vertices have: the light of all lights or of those without shadows, and that of each light with a shadow.
class VertexLight {
public:
    /// view_from_world, clip_from_world: of the picture. shares: shadowed lights have sums of their own, where items receive them.
    /// reflectance: of the mirror that shows the items.
    VertexLight(const FixedFrame& frame, const Mat4& view_from_world, const Mat4& clip_from_world, Vec3f eye_ws, bool shares,
                float reflectance);

    /// Attribute slots of the surface's records: position and depth, coordinates, colour, and with textures what else
    /// they need.
    [[nodiscard]] shading::SlotMask surface_slots() const;
    /// Fills records of an item's vertices, as VertexRecords::Fill. in_turn: from which on of shadowed lights; -1: the surface.
    void fill(const FixedItem& item, const VertexRecordArgs& args, const RasterKernels& kernels, int in_turn, int count) const;

    [[nodiscard]] std::span<const std::size_t> shadowed() const { return shadowed_; }

private:
    const FixedFrame& frame_;
    float depth_row_[4], w_row_[4];
    Vec3f eye_ws_;
    float reflectance_;
    std::vector<FixedLightTerms> lights_;  ///< of a white material
    std::vector<std::size_t> all_, plain_, shadowed_;
    bool textured_;
};

}  // namespace halflit::raster
