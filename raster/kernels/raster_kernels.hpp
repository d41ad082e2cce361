// The rasterizer's inner loops as a table of function pointers, one set for each instruction set, and the plain data they read
// and write. Everything is in window coordinates of the whole picture: x to the right, y down, pixel (0, 0) at the top left.
//
// Fixed point: 24.8, with pixel centres on whole numbers: window position p (in pixels) is stored as (p - 0.5) * 256, so the
// centre of pixel (i, j) is (256 i, 256 j).
#pragma once

#include "halflit/isa.hpp"
#include "raster/kernels/fixed_function_args.hpp"
#include "sh/config.hpp"
#include "shading/fragment_block.hpp"
#include "shading/plan/sky_grid_plan.hpp"

#include <cstdint>

namespace halflit::raster {

/// A vertex after projection and snapping. x and y are valid when its outcode says neither kNear, kGuard nor kNotFinite.
struct alignas(16) ScreenVertex {
    std::int32_t x, y;  ///< 24.8 fixed point, see above
    float z;            ///< depth: 1 at the near plane, 0 at the far plane or infinity
    float inv_w;        ///< 1 / clip w
};

/// Position of a vertex relative to the view, as bits. A triangle is dropped if a bit of kRejectWhenAll is set for all its vertices.
enum Outcode : std::uint8_t {
    kLeft = 1,
    kRight = 2,
    kTop = 4,
    kBottom = 8,
    kBeyondFar = 16,  // outside that plane, like the four above
    kNear = 32,       // before the near plane: clip
    kGuard = 64,      // outside the guard band: clip
    kNotFinite = 128  // a coordinate is NaN or infinite: drop
};
inline constexpr std::uint8_t kRejectWhenAll = kLeft | kRight | kTop | kBottom | kBeyondFar | kNear;

/// Window mapping: window = ndc * half + half (y negated), in pixels.
struct Viewport {
    float half_width = 0, half_height = 0;
    float guard_x = 0, guard_y = 0;  ///< |clip x| <= guard_x * w stays inside the guard band
    friend bool operator==(const Viewport&, const Viewport&) = default;
};

/// Top-left rule: true if pixel centres on the edge a x + b y + c = 0 of a triangle with a x + b y + c > 0 inside belong to it. y points
/// down.
HALFLIT_INLINE constexpr bool is_top_left(std::int32_t a, std::int32_t b) { return a > 0 || (a == 0 && b > 0); }

/// Half the width of the guard band around the middle of the picture, in pixels. Edge coefficients of triangles inside it
/// are below 2^23, so an edge function inside a tile of 64 plus a vector's overhang stays below 2^31:
/// (63 + 15 + 63) * 2^23 = 1.18e9.
inline constexpr int kGuardBandPx = 16384;

/// Vertices with a smaller clip w are left to the clipper: the inverse of w overflows float32 below 3e-39.
inline constexpr float kLeastW = 1e-37f;

struct TransformArgs {
    const float* positions;      ///< x y z of each vertex, packed
    std::int64_t begin, end;     ///< vertices
    float clip_from_object[16];  ///< column major
    Viewport viewport;
    ScreenVertex* screen;
    std::uint8_t* outcodes;
};

inline constexpr int kMaxSamples = 16;

/// Sample positions relative to the pixel centre, in 1/256 pixel.
struct SamplePattern {
    int count = 1;
    std::int16_t x[kMaxSamples] = {}, y[kMaxSamples] = {};
    friend bool operator==(const SamplePattern&, const SamplePattern&) = default;
};

/// A draw and a view, as triangles are culled and binned.
struct BinArgs {
    const ScreenVertex* screen;    ///< of the draw's vertex 0
    const std::uint8_t* outcodes;  ///< likewise
    bool mirrored, cull_back;
    bool round;  ///< triangles may stand for circles, so that what they cover does not tell which samples are covered
    int region_x, region_y, region_width, region_height;
    int sample_min_x, sample_max_x, sample_min_y, sample_max_y;
    int tile_shift;  ///< a tile has 2^tile_shift pixels on a side, 16 to 64
    SamplePattern samples;
};

inline constexpr int kBinnedAtOnce = 64;
/// Result of culling at most kBinnedAtOnce triangles, as bits: bit i is triangle i.
struct BinnedTriangles {
    std::uint64_t keep;                                                       ///< small triangles that the view may show
    std::uint64_t other;                                                      ///< triangles that are large, clipped or not finite
    std::uint64_t back;                                                       ///< of those to keep: the back is seen
    std::uint64_t swap;                                                       ///< of those to keep: their area is negative
    alignas(64) std::int32_t tile_x0[kBinnedAtOnce], tile_y0[kBinnedAtOnce];  ///< tiles that they touch: the first column and row
    alignas(64) std::int32_t tile_x1[kBinnedAtOnce], tile_y1[kBinnedAtOnce];  ///< the last
};

/// Vertex records for shading: per vertex the slots named by `slots`, four floats each, in slot order.
struct VertexRecordArgs {
    const float *positions, *normals, *tangents, *uv0, *uv1, *colors;  ///< packed; null: a default value is written
    std::int64_t begin, end;                                           ///< records
    const std::uint32_t* vertices = nullptr;                           ///< vertex of record i at i << vertex_shift; null: its number is i
    int vertex_shift = 0;
    shading::SlotMask slots;
    float world_from_object[16];
    float normal_from_object[12];  ///< three columns of four, the fourth entry unused
    float tangent_sign;            ///< -1 if the transform mirrors, else +1
    float* records;                ///< record 0
    int stride;                    ///< floats per record: 4 * number of slots
};

/// One triangle in a tile's list. Vertices in the order of positive area with y down: clockwise as seen on the screen.
struct TriangleRecord {
    std::uint32_t vertex[3];      ///< index into the view's screen vertices; kClipVertex + index into the chunk's clip vertices
    std::uint32_t draw_and_bits;  ///< draw << kBits, with the bits below
    [[nodiscard]] HALFLIT_INLINE std::uint32_t draw() const { return draw_and_bits >> kBits; }
    [[nodiscard]] HALFLIT_INLINE bool is_back() const { return (draw_and_bits & kBackFace) != 0; }
    /// It stands for a whole point, and covers the circle in its box.
    [[nodiscard]] HALFLIT_INLINE bool is_round() const { return (draw_and_bits & kRoundPoint) != 0; }
    static constexpr std::uint32_t kBackFace = 1, kRoundPoint = 2;
    static constexpr int kBits = 2;
};
inline constexpr std::uint32_t kClipVertex = 0x80000000u;
inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

inline constexpr int kMaxTileSize = 64;
inline constexpr int kTilePadding = 16;  ///< columns right of the tile that a vector may write to
inline constexpr int kTileStride = kMaxTileSize + kTilePadding;
inline constexpr int kTilePixels = kTileStride * kMaxTileSize;

/// Depth and visible triangle of every sample of a tile; pixel (x, y) of the tile is at y * kTileStride + x.
struct TileBuffers {
    alignas(64) float depth[kMaxSamples][kTilePixels];
    alignas(64) std::uint32_t triangle[kMaxSamples][kTilePixels];
    /// Bit s is set if sample s passed in `cover`. `cover` only sets bits; the caller clears them.
    alignas(64) std::uint16_t coverage[kTilePixels];
};

/// Depths of one triangle, where TileBuffers::coverage marks its samples; pixels as there.
struct LayerDepths {
    alignas(64) float depth[kMaxSamples][kTilePixels];
};

/// Position and size of a tile in the picture, pixels.
struct TileRect {
    int x, y, width, height;
};

/// A chunk's triangles as the tile loop reads them.
struct TriangleSource {
    const TriangleRecord* records;
    const ScreenVertex* vertices;       ///< the view's vertices
    const ScreenVertex* clip_vertices;  ///< the chunk's clip vertices
    std::uint32_t id_base;              ///< triangle id = id_base + index of the record
};

/// A corner of one of its triangles.
HALFLIT_INLINE const ScreenVertex& vertex_of(const TriangleSource& source, std::uint32_t v) {
    return (v & kClipVertex) ? source.clip_vertices[v & ~kClipVertex] : source.vertices[v];
}

/// The box of pixels that `cover` looked at, relative to the tile; empty when x1 < x0.
struct CoverBox {
    int x0, y0, x1, y1;
};

/// All chunks of a view; a triangle id is chunk << local_bits | record.
struct TriangleTable {
    const TriangleSource* chunks;
    int local_bits;
};

/// Vertex records of a draw: that of the view's vertex v starts at base + (v >> shift) * stride.
struct DrawRecords {
    const float* base;
    int shift = 0;  ///< lines: 1, points: 2, because the corners of a quad share records
    [[nodiscard]] HALFLIT_INLINE const float* of(std::uint32_t vertex, std::int64_t stride) const {
        return base + static_cast<std::int64_t>(vertex >> shift) * stride;
    }
};

struct InterpolateArgs {
    TriangleTable triangles;
    const DrawRecords* draws;
    const float* const* clip_records;  ///< per chunk: records of clip vertices, kVertexFloats floats apart, with the same slots
    shading::SlotMask slots;
    int stride;
    bool gradients;      ///< fill the kDu.. rows
    bool facing;         ///< fill kFacing
    bool shadow_offset;  ///< fill the kShadowX.. rows; needs slots 0 and 1
    bool extrapolates;   ///< a pixel's centre beside the triangle has the values of its plane, as in OpenGL; false: of the nearest point
    int count;           ///< fragments, padded to a multiple of 16 with copies of the last one
    const std::uint32_t* ids;
    const std::int32_t *x_px, *y_px;
};

/// Fragments of at most kPixelsARow pixels of a row, in the order of pixels; those of a pixel in the order of the first sample of each.
/// Arrays hold some more than are counted, as whole vectors are stored and copied.
inline constexpr int kPixelsARow = 16;
struct PixelFragments {
    int count = 0, pixels = 0;  ///< fragments, and pixels that have some
    alignas(64) std::uint32_t id[(kMaxSamples + 2) * kPixelsARow];
    alignas(64) std::int32_t x_px[(kMaxSamples + 2) * kPixelsARow];
    alignas(64) std::int32_t samples[(kMaxSamples + 2) * kPixelsARow];  ///< bit s: sample s shows the fragment
};

/// Mapping from depth to distance in a shadow map's view: near / depth, or far - depth * (far - near).
struct DepthRange {
    float near_z, far_z;
    bool perspective;
};

/// Numbers of a cover (view/cover_grid.hpp): area vector, areas that face both ways, factor for backs.
inline constexpr int kCoverParts = 7;
/// Points of a row of covers in memory; those beyond the lattice's have no cover.
inline constexpr int kCoverPitch = 32;
inline constexpr int kSweepPitch = 40;                      ///< of rows with a zero before and after
inline constexpr int kGroundCells = 64, kGroundPitch = 80;  ///< of a row of the ground's cells; and of one in memory

/// Rows of kCoverPitch points, which lie in layers: their numbers, and steps in memory in floats.
struct CoverLayout {
    int rows = 0, layers = 0;
    std::int64_t row_step = 0, layer_step = 0;
};

/// A direction through a lattice, from its far end: the share that is hidden at a point is that of the place in the next layer that the
/// direction leads to, and what is covered there, at most 1.
struct CoverSweep {
    const float* parts[kCoverParts];
    const std::uint8_t* filled;  ///< of each row: not 0 if some cover is not 0
    CoverLayout layout;
    float towards[3], size[3];  ///< to the light, 1 from layer to layer; its magnitudes
    float along, across;        ///< how far it goes from a layer to the next in a row, and from row to row, at most 1
    bool from_last;             ///< it comes from the last layer
    float* work;                ///< 2 (rows + 2) kSweepPitch floats, at first zeros
    float* hidden;              ///< out: at each point
};

/// Directions at a time whose hidden shares are added up.
inline constexpr int kSweptAtOnce = 8;
/// Sums over directions of shares times factors, for points from `first` to `end`, multiples of kCoverPitch.
struct GridTermSums {
    const float* shares[kSweptAtOnce];  ///< of each direction, those of all points
    float factors[kSweptAtOnce][shading::kGridTerms];
    int directions;
    std::int64_t first, end;
    std::int64_t points;  ///< of all
    float* sums;          ///< in and out: kGridTerms lists of `points`
};

/// A layer of covers as seen from the ground, whose cells are as wide as the lattice's spacing.
struct GroundCover {
    const float* parts[kCoverParts];  ///< of the layer's first row
    const std::uint8_t* filled;
    int length, rows;
    std::int64_t row_step;
    float towards[3], size[3];  ///< to the light, over its height; times the share of each step
    int first_x, first_z;       ///< cell below the lattice's first point
    int steps;
    const float *x, *z;  ///< from a cell to the points that it sees, for each step
    float* shares;       ///< (rows + 3) kGroundPitch floats, at first zeros: work space
    float* sums;         ///< kGroundCells rows; what is hidden is added
};

/// The contact shadow at the pixels of a row of the picture. Its cell at a pixel whose middle is at x: the quotient of (x * [0] + [1]) +
/// [2] of `cell_x` or `cell_z`, and of `weight`, whose [1] are those of the row.
struct GroundShadow {
    const float* hidden;  ///< share of each cell, kGroundCells rows
    double weight[3], cell_x[3], cell_z[3];
    int width, border;  ///< of the picture, pixels; pixels between the row and the picture's upper or lower border
    double fade_px, opacity;
};

/// Splats are listed in squares of so many pixels of the picture, whatever its tiles are, and blended in blocks of them.
inline constexpr int kSplatTile = 32, kSplatBlock = 8;
inline constexpr int kSplatBlocksAcross = kSplatTile / kSplatBlock, kSplatBlocks = kSplatBlocksAcross * kSplatBlocksAcross,
                     kSplatBlockPixels = kSplatBlock * kSplatBlock;
/// A splat's alpha at a pixel is at most this.
inline constexpr float kMostSplatAlpha = 0.99f;

/// How a mesh's splats become pixels. World lengths; directions x right, y down, z ahead.
struct SplatView {
    double axes[3][3], origin[3];          ///< right, down and ahead of the eye, from object coordinates
    double world[3][3], world_origin[3];   ///< the way from the eye in the world; only with by_distance
    double turn[3][3], turn_origin[3];     ///< the way from the eye along the object's turned axes
    double focal[2], middle[2];            ///< pixels; orthographic: pixels per unit
    double least_slope[2], most_slope[2];  ///< at which the projection is held
    double nearest;                        ///< least distance along the view
    double variance;                       ///< added in the picture, square pixels
    double least_area;               ///< of the area before over that after, whose root the opacity is multiplied by; above 1: it is not
    float least_log2;                ///< alpha of less than 2^this is out of reach
    int x0, y0, x1, y1;              ///< pixels that are drawn
    bool orthographic, by_distance;  ///< by_distance: sorted by the distance from the eye, otherwise along the view
};

/// Input of project_splats: arrays of a mesh from its first splat of the batch on, as halflit/splats.hpp has them.
struct SplatBatch {
    const float *positions, *rotations, *scales, *opacities, *harmonics;
    int count, degree;
    std::uint32_t first;  ///< number of the first one
};

/// A splat in the picture; fills one line of the cache. Its alpha at a pixel is 2^(log2_opacity - u^2 - w^2), u and w being m times the way
/// from its middle.
struct alignas(64) SplatRecord {
    std::int32_t x, y;         ///< pixel of its middle
    float x_part, y_part;      ///< way from that pixel's middle to the splat's, pixels
    float m00, m01, m10, m11;  ///< per pixel
    float log2_opacity, color[3];
    float z;               ///< distance along the axis of the view, world units
    float half_x, half_y;  ///< alpha falls to 2^(log2_opacity - r^2) within r times this, pixels

    /// From the splat's middle to that of a pixel.
    HALFLIT_INLINE float way_x(int x_px) const { return static_cast<float>(x_px - x) - x_part; }
    HALFLIT_INLINE float way_y(int y_px) const { return static_cast<float>(y_px - y) - y_part; }
};

static_assert(sizeof(SplatRecord) == 64);

/// Sums over the splats of a square of pixels, block after block.
struct SplatTile {
    /// Index of a pixel, counted from the square's first one.
    static constexpr int at(int x, int y) {
        const int block = y / kSplatBlock * kSplatBlocksAcross + x / kSplatBlock;
        return block * kSplatBlockPixels + y % kSplatBlock * kSplatBlock + x % kSplatBlock;
    }
    alignas(64) float color[3][kSplatTile * kSplatTile];
    alignas(64) float passed[kSplatTile * kSplatTile];  ///< share of the light from behind that is left
    alignas(64) float limit[kSplatTile * kSplatTile];   ///< only with `hides`: splats from this distance on are hidden
    /// Only with `planes`: distance of the splat by which half of the light is hidden, and the number of the record that shows most.
    alignas(64) float median[kSplatTile * kSplatTile], most_share[kSplatTile * kSplatTile];
    alignas(64) std::int32_t most_shown[kSplatTile * kSplatTile];
    double budget[kSplatBlocks];      ///< error of a colour in the block that is left for splats that are not drawn there
    double rounding[kSplatBlocks];    ///< error of a colour in the block by the roundings of float32
    float most_passed[kSplatBlocks];  ///< `passed` of the block's pixels at most
    bool hides, planes;
    float largest;       ///< colour of the splats and of what is behind, at least 1
    float least_passed;  ///< blocks in which less is passed everywhere are finished
};

struct RasterKernels {
    void (*transform)(const TransformArgs&);
    void (*vertex_records)(const VertexRecordArgs&);
    /// Culls `count` triangles, at most kBinnedAtOnce; index: three vertices each. Drops those that face away, are outside, have no area,
    /// or touch at most 2 x 2 pixels and cover none of their samples.
    void (*bin_triangles)(const BinArgs&, const std::uint32_t* index, int count, BinnedTriangles&);
    /// Draws triangles into depth and triangle. The nearest wins; of equal depths the first.
    void (*rasterize)(const TileRect&, const SamplePattern&, TileBuffers&, const TriangleTable&, const std::uint32_t* ids, int count);
    /// The same without ids: TileBuffers::triangle is left as it is.
    void (*rasterize_depth)(const TileRect&, const SamplePattern&, TileBuffers&, const TriangleTable&, const std::uint32_t* ids, int count);
    /// Tests one triangle. Marks in `coverage` the samples that it covers and that are nearer than the tile's depth.
    CoverBox (*cover)(const TileRect&, const SamplePattern&, TileBuffers&, const TriangleSource&, std::uint32_t record);
    /// The same in `part` of the tile alone, with the depths of the samples that it marks.
    CoverBox (*cover_layer)(const TileRect&, const TileRect& part, const SamplePattern&, TileBuffers&, LayerDepths&, const TriangleSource&,
                            std::uint32_t record);
    /// The same of all samples that it covers, whatever the tile's depth.
    CoverBox (*cover_all)(const TileRect&, const TileRect& part, const SamplePattern&, TileBuffers&, LayerDepths&, const TriangleSource&,
                          std::uint32_t record);
    /// Draws one triangle into depth and triangle, but only the samples set in `coverage`: those that passed the alpha test.
    void (*draw_covered)(const TileRect&, const SamplePattern&, TileBuffers&, const TriangleSource&, std::uint32_t record);
    /// The fragments of `count` pixels, at most kPixelsARow. at: index of the first one in the buffers; x_px: its place in the picture.
    void (*collect)(const TileBuffers&, int samples, int at, int x_px, int count, PixelFragments&);
    void (*interpolate)(const InterpolateArgs&, shading::FragmentBlock&);
    /// Distances along a shadow map's axis for a row of depths.
    void (*distances)(const DepthRange&, const float* depth, int count, float* distance);
    void (*sweep_covers)(const CoverSweep&);
    void (*add_grid_terms)(const GridTermSums&);
    void (*cover_ground)(const GroundCover&);
    /// Opacities of the contact shadow at `count` pixels from x_px on, at most kMaxTileSize.
    void (*shadow_row)(const GroundShadow&, int x_px, int count, float* opacity);
    // Whole vectors are read and written: rows are padded to a multiple of 16.
    /// rows: light times alpha, and alpha, summed over a pixel's samples; they become its colour, the mean, not premultiplied. weight: 1 /
    /// number of samples. Sums and quotients of infinite samples may be NaN; that becomes 0.
    void (*take_means)(float weight, int count, float* const rows[4]);
    /// The colours of pixels whose samples all show `back`, times alpha, and alpha, below black surfaces.
    void (*shade_background)(const float (&back)[4], const float* opacity, int samples, int count, float* const rows[4]);
    /// Writes the records of splats that are seen, what they are sorted by, which is above 0, and, if it is not null, their numbers.
    /// Returns how many there are. Left out are those behind or too near, beside the part that is drawn, of no area or of more than 1e38
    /// square pixels, and 1e9 pixels away: float32 cannot tell where they show.
    int (*project_splats)(const SplatView&, const SplatBatch&, SplatRecord*, double* distances, std::uint32_t* numbers);
    /// Adds `count` splats, the nearest first, to the square whose first pixel is given. list: numbers of records; remaining: splats of the
    /// square that follow. False: all blocks are finished.
    bool (*blend_splats)(const SplatRecord*, const std::uint32_t* list, int count, std::size_t remaining, int x_px, int y_px, SplatTile&);
    void (*fixed_vertices)(const FixedVertexArgs&);
    void (*code_texels)(const TexelArgs&, TexelRows&);
    void (*fixed_codes)(const CodeArgs&);
    /// Marks the places that a triangle hides, in the tiles (tile_x0, tile_y0) to (tile_x1, tile_y1). a, b, c: in the order of positive
    /// area.
    void (*occlude)(const OcclusionGrid&, const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, int tile_x0, int tile_y0,
                    int tile_x1, int tile_y1);
};

[[nodiscard]] const RasterKernels& raster_kernels(Isa isa);

}  // namespace halflit::raster
