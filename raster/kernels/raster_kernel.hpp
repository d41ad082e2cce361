// The rasterizer's kernels: one source, compiled once for each instruction set.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "shading/kernels/simd.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

HALFLIT_INLINE const TriangleSource& source_of(const TriangleTable& table, std::uint32_t id) {
    return table.chunks[id >> table.local_bits];
}
HALFLIT_INLINE const TriangleRecord& record_of(const TriangleTable& table, std::uint32_t id) {
    return source_of(table, id).records[id & ((1u << table.local_bits) - 1u)];
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster

#include "raster/kernels/background.hpp"
#include "raster/kernels/bin_triangles.hpp"
#include "raster/kernels/blend_splats.hpp"
#include "raster/kernels/collect.hpp"
#include "raster/kernels/cover_sweep.hpp"
#include "raster/kernels/distances.hpp"
#include "raster/kernels/fixed_function.hpp"
#include "raster/kernels/interpolate.hpp"
#include "raster/kernels/occlusion.hpp"
#include "raster/kernels/project_splats.hpp"
#include "raster/kernels/rasterize.hpp"
#include "raster/kernels/transform.hpp"
#include "raster/kernels/vertex_records.hpp"

namespace halflit::raster {
#define HALFLIT_RASTER_KERNELS HALFLIT_CONCAT(raster_kernels_, HALFLIT_ISA)
extern const RasterKernels HALFLIT_RASTER_KERNELS;
const RasterKernels HALFLIT_RASTER_KERNELS = {
    transform,    vertex_records,   bin_triangles,  rasterize,    rasterize_depth, cover,          cover_layer,  cover_all,
    draw_covered, collect,          interpolate,    distances,    sweep_covers,    add_grid_terms, cover_ground, shadow_row,
    take_means,   shade_background, project_splats, blend_splats, fixed_vertices,  code_texels,    fixed_codes,  occlude};
}  // namespace halflit::raster
