// Lights and materials as the kernel of vertices reads them.
#pragma once

#include "halflit/fixed_function.hpp"
#include "raster/kernels/fixed_function_args.hpp"
#include "raster/passes/view_geometry.hpp"

#include <span>
#include <vector>

namespace halflit::raster {

/// What the vertices of an item have.
struct ItemLight {
    FixedVertexArgs args{};  ///< without the vertices
    std::vector<FixedLightTerms> terms;
    /// Writes records of vertices, as VertexRecords::Fill.
    void fill(const VertexRecordArgs& to, const RasterKernels& kernels) const;
};

/// Light at the vertices of a view.
class VertexLight {
public:
    /// view_from_world, clip_from_world: of the picture. shares: shadowed lights have sums of their own, where items receive them.
    /// reflectance: of the mirror that shows the items.
    VertexLight(const FixedFrame& frame, const Mat4& view_from_world, const Mat4& clip_from_world, Vec3f eye_ws, bool shares,
                float reflectance);

    /// Attribute slots of the surface's records: position and depth, coordinates, colour, and with textures what else
    /// they need.
    [[nodiscard]] shading::SlotMask surface_slots() const;
    /// The surface's records of an item, in the light of all lights or of those without shadows.
    [[nodiscard]] ItemLight surface_of(const FixedItem& item) const;
    /// Records of sums of shadowed lights, `count` from `first` on.
    [[nodiscard]] ItemLight shadowed_of(const FixedItem& item, int first, int count) const;

    /// Lights that have sums of their own: indices into FixedFrame::lights.
    [[nodiscard]] std::span<const std::size_t> shadowed() const { return shadowed_; }

private:
    [[nodiscard]] ItemLight of(const FixedItem& item) const;
    /// The material's color in the mirror.
    [[nodiscard]] Vec3f color_of(const FixedMaterial& material) const;

    const FixedFrame& frame_;
    float depth_row_[4], w_row_[4];
    Vec3f eye_ws_;
    float reflectance_;
    std::vector<FixedLightTerms> lights_;  ///< of a white material
    std::vector<std::size_t> all_, plain_, shadowed_;
    bool textured_;
};

}  // namespace halflit::raster
