// The rasterizer's kernels for one instruction set: a kernel file defines HALFLIT_ISA (and HALFLIT_ARCH), includes this, and names
// its table with HALFLIT_DEFINE_RASTER_KERNELS.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "shading/kernels/simd.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

HALFLIT_INLINE const ScreenVertex& vertex_of(const TriangleSource& source, std::uint32_t v) {
    return (v & kClipVertex) ? source.clip_vertices[v & ~kClipVertex] : source.vertices[v];
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster

#include "raster/kernels/interpolate.hpp"
#include "raster/kernels/rasterize.hpp"
#include "raster/kernels/transform.hpp"

#define HALFLIT_DEFINE_RASTER_KERNELS(name)                                                              \
    namespace halflit::raster {                                                                          \
    extern const RasterKernels name;                                                                     \
    const RasterKernels name = {transform, vertex_records, rasterize, cover, draw_covered, interpolate}; \
    }
