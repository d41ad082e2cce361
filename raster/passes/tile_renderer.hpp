// One tile from triangle lists to pixels: visibility first, then every visible pixel is shaded once, then transparent
// triangles in submission order, then the framebuffer.
#pragma once

#include "raster/passes/fragment_queue.hpp"
#include "raster/passes/frame.hpp"
#include "raster/work_counts.hpp"

namespace halflit::raster {

/// What tiles report; summed over the frame.
struct TileCounts {
    std::uint64_t triangles = 0, pixels_visible = 0, fragments_shaded = 0, nan_pixels = 0;
    WorkCounts work;

    TileCounts& operator+=(const TileCounts& other) {
        triangles += other.triangles;
        pixels_visible += other.pixels_visible;
        fragments_shaded += other.fragments_shaded;
        nan_pixels += other.nan_pixels;
        work += other.work;
        return *this;
    }
};

/// The working memory of one task.
struct TileScratch {
    TileBuffers buffers{};
    FragmentQueue queue;
    FragmentList list;  ///< of the triangle at hand: alpha test, blending
    shading::FragmentBlock block;
    LightSelection lights;
    /// Linear light times alpha, and alpha, of every sample; used only where samples or layers are combined.
    RawBuffer<float> color;
};

class TileRenderer {
public:
    TileRenderer(const Frame& frame, int tile, TileScratch& scratch)
        : frame_(frame), tile_(tile), rect_(frame.tile_rect(tile)), scratch_(scratch), buffers_(scratch.buffers) {}

    TileCounts render();

    /// Visibility alone, for debug views: afterwards the scratch buffers hold depth and triangle of each sample.
    void draw_visibility();

private:
    [[nodiscard]] bool has_triangles() const;
    void draw_masked(const TriangleSource& source, std::uint32_t record);
    void shade_visible();
    void blend_layers();
    void blend_triangle(const TriangleSource& source, std::uint32_t record);
    template <class Flush>
    void collect_covered(const CoverBox& box, std::uint32_t id, const Flush& flush);
    void shade(FragmentList& list);
    void write_direct(const FragmentList& list);
    void write_samples(const FragmentList& list, bool blend);
    void fill_background();
    void fill_samples();  ///< every sample with the environment behind its pixel
    void resolve();
    [[nodiscard]] float* sample_color(int s) { return scratch_.color.data() + static_cast<std::size_t>(s) * 4 * kTilePixels; }
    [[nodiscard]] const Draw& draw_of(const TriangleRecord& r) const { return frame_.draws[r.draw_and_back >> 1]; }

    const Frame& frame_;
    int tile_;
    TileRect rect_;
    TileScratch& scratch_;
    TileBuffers& buffers_;
    TileCounts counts_;
    bool direct_ = true;  ///< one opaque sample a pixel: shaded colours go straight to the framebuffer
};

}  // namespace halflit::raster
