// Vertex records, the vertex data that shading reads: world position, normal and the other attribute slots that the materials need. Made
// for the vertex groups that some drawn triangle reads, and for the vertices that clipping made.
#pragma once

#include "raster/passes/view_geometry.hpp"
#include "shading/plan/plan.hpp"

#include <functional>
#include <span>

namespace halflit::raster {

class VertexRecords {
public:
    /// Makes the records of a view's geometry. materials: indexed as in PreparedData. Does nothing if geometry and attribute slots are
    /// those of the last call.
    void make(const ViewGeometry& geometry, std::span<const shading::MaterialPlan> materials, const RasterKernels& kernels,
              Executor& executor);

    /// Makes records of other contents: fill writes those of a draw's vertices [args.begin, args.end), whose arrays and matrices args has.
    /// slots: of each material, as above. Nothing is kept.
    using Fill = std::function<void(const Draw& draw, const VertexRecordArgs& args)>;
    void make(const ViewGeometry& geometry, std::vector<shading::SlotMask> slots, Executor& executor, const Fill& fill);

    /// Floats per record of that draw's vertices.
    [[nodiscard]] int stride(std::size_t draw) const { return strides_[draw]; }
    [[nodiscard]] const DrawRecords* draws() const { return draw_records_.data(); }
    [[nodiscard]] const float* const* clip_records() const { return clip_records_.data(); }

    /// Record of a triangle's corner. chunk: the triangle's.
    [[nodiscard]] const float* of_corner(std::size_t chunk, std::size_t draw, std::uint32_t vertex) const {
        if (vertex & kClipVertex) return clip_records_[chunk] + static_cast<std::size_t>(vertex & ~kClipVertex) * shading::kVertexFloats;
        return draw_records_[draw].of(vertex, strides_[draw]);
    }

    /// Record of a draw, below Draw::record_count. A caller that writes to it must call changed().
    [[nodiscard]] float* record(std::size_t draw, std::int64_t number) {
        return records_.data() + record_bases_[draw] + number * strides_[draw];
    }
    void changed() { version_ = 0; }
    /// Makes the records of clip vertices from those of their triangles' vertices.
    void make_clip_records(const ViewGeometry& geometry, Executor& executor);

private:
    std::uint64_t version_ = 0;  ///< version of the geometry that the records belong to; 0: none
    std::vector<shading::SlotMask> slots_;
    std::vector<int> strides_;
    std::vector<std::int64_t> record_bases_;
    RawBuffer<float> records_;
    std::vector<DrawRecords> draw_records_;
    std::vector<std::vector<float>> clip_floats_;  ///< per chunk: kVertexFloats for each clip vertex
    std::vector<const float*> clip_records_;
};

}  // namespace halflit::raster
