// Data of the passes over tiles. One task draws a tile, and the tile's data fits the core's own cache.
#pragma once

#include "halflit/report.hpp"
#include "raster/passes/fragment_queue.hpp"
#include "raster/passes/vertex_records.hpp"
#include "raster/view/light_culling.hpp"
#include "shading/kernels/shade_kernels.hpp"

#include <array>

namespace halflit::raster {

/// A view as its tiles read it.
struct TilePass {
    const ViewGeometry& geometry;
    const VertexRecords& records;  ///< unused if no material has a mask and nothing is shaded
    std::span<const shading::MaterialPlan> materials;
    const RasterKernels& raster;
    const shading::ShadeKernels& shade;
    StopSignal& stop;            ///< checked while a tile is drawn
    bool shadow_offset = false;  ///< fill the kShadowX.. rows of fragments
    bool depth_only = false;     ///< visibility leaves out the triangles' ids
    bool behind = false;         ///< without the background, and without materials that are looked through
};

/// Counts of a tile; summed over the view.
struct TileCounts {
    std::uint64_t pixels_visible = 0, fragments_shaded = 0, nan_pixels = 0;
    std::uint64_t layers_seen = 0;  ///< lists of fragments of layers that are not all clear
    WorkCounts work;

    TileCounts& operator+=(const TileCounts& other) {
        pixels_visible += other.pixels_visible;
        fragments_shaded += other.fragments_shaded;
        nan_pixels += other.nan_pixels;
        layers_seen += other.layers_seen;
        work += other.work;
        return *this;
    }
};

/// Cells that are shaded together.
struct CellScratch {
    shading::CellBatch batch;
    shading::FragmentBlock blocks[shading::kCellLanes];
    shading::LightCell cell;
    std::vector<std::uint16_t> exact;           ///< for each light, the cells whose pixels it is left to
    std::vector<shading::LightPlan> of_pixels;  ///< lights left to one cell's pixels
};

/// Fragments of transparent triangles in a part of a tile, in submission order.
struct LayerScratch {
    /// One triangle at one pixel.
    struct Fragment {
        std::uint32_t id;
        std::uint16_t at;       ///< index of the pixel in the tile's buffers
        std::uint16_t samples;  ///< bit s: sample s shows it
    };
    LayerDepths depths;
    std::vector<Fragment> fragments;
    std::vector<float> z;      ///< of each sample of each fragment; a number only where `samples` has its bit
    std::vector<Vec4f> light;  ///< of fragments: light times alpha, and alpha
    /// For each fragment: share of red, green and blue light from behind that passes, and alpha as it is seen in the picture. Empty unless
    /// a drawn material transmits; otherwise these are 1 - alpha, and alpha.
    std::vector<Vec4f> keep;
    std::vector<std::uint8_t> is_shown;                ///< of fragments: 1 if its colour is one of the display. Only in frames with such
    std::vector<std::uint32_t> by_pixel;               ///< fragments, those of a pixel together
    std::array<std::uint32_t, kTilePixels + 1> first;  ///< of a pixel in by_pixel
    std::vector<std::uint64_t> order;                  ///< of a pixel's or sample's fragments: layer_key

    [[nodiscard]] bool shows(std::size_t fragment) const { return !is_shown.empty() && is_shown[fragment] != 0; }
};

/// Pairs of triangles that pixels showed last, and whether they are one smooth surface.
struct SurfacePairs {
    enum class Kind : std::uint8_t { apart, one, near_corner };  ///< near_corner: one within a pixel of (x, y)
    struct Pair {
        std::uint32_t a = kNoTriangle, b = kNoTriangle;
        Kind kind = Kind::apart;
        std::int32_t x = 0, y = 0;  ///< as ScreenVertex
    };
    Pair pairs[512];
    Pair& of(std::uint32_t a, std::uint32_t b) { return pairs[((a * 0x9e3779b1u) ^ (b * 0x85ebca6bu)) >> 23]; }
    struct Shape {
        std::uint32_t triangle = kNoTriangle;
        bool large = false;   ///< covers so many pixels that what is interpolated hardly changes within one
        unsigned unlike = 0;  ///< bit k: the normals of corner k and of the next one are not alike
    };
    Shape shapes[256];
    Shape& of(std::uint32_t triangle) { return shapes[triangle % std::size(shapes)]; }
};

/// The working memory of one task.
struct TileScratch {
    TileBuffers buffers{};
    std::uint32_t opaque[1024];  ///< triangles for the next call of the kernel
    PixelFragments fragments;
    FragmentQueue queue;
    FragmentList list;  ///< fragments of the current triangle, for alpha test and blending
    shading::FragmentBlock block;
    LightSelection lights;
    struct MaterialOf {
        std::uint32_t id = kNoTriangle;
        int material = 0;
    };
    MaterialOf materials[64];  ///< of triangles seen last
    SurfacePairs pairs;
    std::unique_ptr<CellScratch> cells;    ///< where light in cells is used
    std::unique_ptr<LayerScratch> layers;  ///< where there are transparent triangles
    std::unique_ptr<LayerDepths> depths;   ///< where there are surfaces in one plane
    /// Linear light times alpha, and alpha, of every sample; used only where samples or layers are combined.
    RawBuffer<float> color;
    RawBuffer<float> backing;  ///< share of the background colour in every sample; used only with a tone curve
    RawBuffer<float> tint;     ///< the same in red, green and blue; used only with a tone curve and materials that transmit
    /// Where samples are combined but there are no layers, only pixels that no triangle covers as a whole have samples. These are kept one
    /// after the other, in the order in which the pixels come.
    struct PartPixels {
        std::uint64_t whole[kMaxTileSize];  ///< pixels of a row of the tile that one triangle covers: they are written at once
        std::uint64_t part[kMaxTileSize];   ///< those that have samples
        std::uint16_t place[kTilePixels];   ///< of a pixel's samples
        std::uint16_t pixel[kTilePixels];   ///< at a place, as an index into the tile's buffers
        int count;
    };
    PartPixels parts;
    /// Opacities of the contact shadow in rows of the tile.
    struct ShadowRows {
        std::uint64_t known = 0;  ///< bit y: row y is set
        alignas(64) float opacity[kMaxTileSize][kMaxTileSize]{};
    };
    ShadowRows shadow;
    RawBuffer<float> shown;                ///< what shows in every sample of colours of the display: times alpha, and alpha
    std::vector<std::uint32_t> tile_list;  ///< ViewGeometry::tile_list's
};

/// Fills the attribute rows of the scratch's block for a list. The list is padded with copies of its last fragment.
/// gradients: the kDu.. rows too, also where the material does without.
void interpolate(const TilePass& pass, FragmentList& list, shading::FragmentBlock& block, bool gradients = false);

/// Visibility: fills the buffers with the depth and triangle of each sample. Draws opaque triangles, and masked ones where they pass the
/// alpha test. Leaves out blended ones.
void draw_visibility(const TilePass& pass, int tile, TileScratch& scratch, TileCounts& counts);
/// The same of opaque triangles alone, which needs no vertex records.
void draw_opaque(const ViewGeometry& geometry, const RasterKernels& kernels, StopSignal& stop, int tile, TileScratch& scratch);

/// Gives the samples of coplanar surfaces to the material of the highest rank. Runs after draw_visibility().
void draw_coplanar(const TilePass& pass, int tile, TileScratch& scratch, TileCounts& counts);
/// RasterKernels::cover_layer for a triangle of a layer. What is in one plane with the surface that a sample shows lies over it.
CoverBox cover_layer(const TilePass& pass, const TileRect& rect, const TileRect& part, std::size_t chunk, std::uint32_t record,
                     TileScratch& scratch, LayerDepths& depths);
/// Takes the samples off the coverage plane, in a box, that fail the alpha test of a triangle. True if some are left.
bool test_mask(const TilePass& pass, const TileRect& rect, const CoverBox& box, std::size_t chunk, std::uint32_t record,
               TileScratch& scratch, TileCounts& counts);

/// Collects the samples of one triangle in the coverage plane, in a box, as lists of fragments, and calls flush(list) for each list.
template <class Flush>
void collect_covered(const TilePass& pass, const TileRect& rect, const CoverBox& box, std::size_t chunk, std::uint32_t record,
                     TileScratch& scratch, const Flush& flush) {
    const TriangleSource& source = pass.geometry.source(chunk);
    FragmentList& list = scratch.list;
    list.material = pass.geometry.draw_of(source.records[record]).material;
    list.count = 0;
    for (int y = box.y0; y <= box.y1; ++y) {
        for (int x = box.x0; x <= box.x1; ++x) {
            const int at = y * kTileStride + x;
            if (scratch.buffers.coverage[at] == 0) continue;
            list.push(source.id_base + record, rect.x + x, rect.y + y, scratch.buffers.coverage[at]);
            if (!list.full()) continue;
            flush(list);
            list.count = 0;
        }
    }
    if (list.count > 0) flush(list);
}
void clear_coverage(TileScratch& scratch, const CoverBox& box);

}  // namespace halflit::raster
