// One tile of the picture, from triangle lists to pixels. Visibility comes first, then each visible pixel is shaded once per triangle that
// it shows, then transparent triangles are blended by their depths, then the caller's memory is written.
#pragma once

#include "raster/frame_plan.hpp"
#include "raster/passes/eye_dome.hpp"
#include "raster/passes/output.hpp"
#include "raster/passes/reference_shading.hpp"
#include "raster/passes/splats.hpp"
#include "raster/passes/tile.hpp"
#include "raster/quality.hpp"

#include <algorithm>
#include <atomic>
#include <string>

namespace halflit::raster {

/// The transparent surfaces that the pixels of a picture may have together (Settings::max_layers).
class LayerBudget {
public:
    LayerBudget(const Settings& settings, int width, int height)
        : layers_(settings.max_layers), left_(layers_ * std::max(std::int64_t{width} * height, kLeastPixels) * settings.samples) {}
    /// Counts samples of them. Throws Stopped if the picture has too many, in whatever order they come.
    void take(std::size_t samples) {
        const auto n = static_cast<std::int64_t>(samples);
        if (layers_ == 0 || left_.fetch_sub(n, std::memory_order_relaxed) >= n) return;
        throw Stopped{{ErrorCode::limit, "the picture has more than " + std::to_string(layers_) +
                                             " transparent surfaces on each of its pixels, in the mean, which is the limit"}};
    }

private:
    static constexpr std::int64_t kLeastPixels = 1 << 18;  ///< no smaller picture is too much work
    int layers_;                                           ///< 0: no limit
    std::atomic<std::int64_t> left_;
};

/// The picture as its tiles read it.
struct PicturePass {
    TilePass view;
    const FramePlan& plan;
    Output output;
    const ReferenceShading* reference;  ///< shades instead of the kernels; null: the kernels shade
    const TilePass* surface;            ///< reads what the planes of surfaces need; null: there are none
    Region written;                     ///< pixels of the output; the picture's region may be larger
    LayerBudget& layers;
    EyeDome* eye_dome = nullptr;      ///< keeps depths; null: there is none
    SplatPicture* splats = nullptr;   ///< keeps depths; null: there are none
    const PixelMask* only = nullptr;  ///< if there is one, other pixels are not shaded, and what is written there has no meaning
};

class PictureTile {
public:
    PictureTile(const PicturePass& pass, int tile, TileScratch& scratch)
        : pass_(pass),
          plan_(pass.plan),
          tile_(tile),
          rect_(plan_.picture.tile_rect(tile)),
          samples_(plan_.picture.samples.count),
          scratch_(scratch),
          written_(intersection(rect_, pass.written)),
          toned_(plan_.tone_curve != ToneCurve::none && pass.output.codes) {}

    TileCounts draw();
    void keep_depths();  ///< of a tile that is not written

private:
    // shade.cpp
    void shade_visible();
    void keep_only(PixelFragments& row, int y_px) const;  ///< the pixels of PicturePass::only
    void collect(int y, int x0, int x1);                  ///< sorts the fragments of a row of pixels into lists
    void sort(const PixelFragments& row, int y_px);
    [[nodiscard]] int material_of(std::uint32_t id);
    void flush_full(FragmentList*& list);  ///< leaves an empty one in its place
    void flush(FragmentList& list);        ///< shades and writes a list, and empties it
    void shade(FragmentList& list);        ///< interpolates into the scratch's block, and writes its colour rows
    void shade(const FragmentList& list, const shading::LightList& lights, shading::FragmentBlock& block);  ///< of interpolated rows
    void count_nan_pixels(const FragmentList& list, const shading::FragmentBlock& block);
    // join.cpp
    void join(PixelFragments& row, int y_px) const;  ///< makes one fragment of those of a pixel that show one smooth surface
    // cells.cpp
    [[nodiscard]] bool has_cells(int material) const;
    void close_cell();  ///< keeps the lists of a cell of the picture, of materials with light in cells
    void shade_cells();
    void shade_cells(std::span<std::unique_ptr<FragmentList>> lists);  ///< of one material, at most kCellLanes
    // planes.cpp
    void write_planes(bool empty);  ///< what visibility knows, and 0 in the planes of surfaces; empty: no triangles
    /// The numbers of a row's pixels from (x_px, y_px) on, which show the triangles `id`; null: nothing.
    void write_numbers(const std::uint32_t* id, int x_px, int y_px, int count) const;
    void count_visible();                         ///< what shade_visible() would count
    void write_surface(FragmentList list);        ///< the planes of surfaces; overwrites the scratch's block and list of lights
    void write_lights(const FragmentList& list);  ///< of the scratch's block
    // blend.cpp
    [[nodiscard]] bool has_layers() const;
    void blend_layers();
    void blend_layers(const TileRect& part);
    [[nodiscard]] bool collect_layers(const TileRect& part);  ///< false: there are too many fragments
    void shade_layers();
    void shade_layers(FragmentList& list);  ///< whose `samples` are indices into the layers' fragments
    void blend_pixels(const TileRect& part);
    void blend_pixel(std::size_t at, std::span<const std::uint32_t> fragments);  ///< at: of the pixel in the tile's buffers
    void blend_sample(int at, int sample);                                       ///< of a pixel with too many fragments
    [[nodiscard]] static Vec4f light_of(const shading::FragmentBlock& block, int lane, float exposure);  ///< light times alpha, and alpha
    [[nodiscard]] Vec4f keep_of(int material, int lane, Vec4f light) const;  ///< LayerScratch::keep, of the scratch's block
    void blend_fragment(std::size_t fragment, int at, int sample);           ///< lays a fragment of the layers over a sample
    // resolve.cpp
    [[nodiscard]] Vec4f background_at(int at) const;  ///< of every sample of a pixel; at: in the tile's buffers
    void set_background(int at, int place);           ///< sets a pixel's samples; place: of these, in the buffers
    [[nodiscard]] Vec4f background_sample() const;    ///< of the background colour: times alpha, and alpha
    [[nodiscard]] bool has_background() const { return plan_.background && !pass_.view.behind; }  ///< an environment is seen
    /// The background is not one colour in all of the tile.
    [[nodiscard]] bool background_varies() const { return has_background() || has_contact_shadow_; }
    void clear();            ///< fills a tile that has triangles with the background
    void fill_background();  ///< writes a tile that has no triangles
    struct Pixel {
        Vec4f linear{0, 0, 0, 0};
        std::uint32_t code = 0;  ///< as the caller's memory has it
    };
    [[nodiscard]] Pixel background_pixel() const;  ///< of the background colour
    /// Writes the background of pixels of a row of the tile; plain: of the background colour.
    void write_background(int row, std::uint64_t pixels, const Pixel& plain);
    /// Opacities of the contact shadow in a row of the tile that has some.
    [[nodiscard]] const float* shadow_row(int row) const;
    /// Pixels of a row of the tile that are the caller's.
    [[nodiscard]] std::uint64_t written_pixels() const { return (~std::uint64_t{0} >> (64 - written_.width)) << (written_.x - rect_.x); }
    void fill_samples();                                                        ///< sets every sample to the background of its pixel
    void write(const FragmentList& list, const shading::FragmentBlock& block);  ///< to the caller's memory or to samples
    void write_samples(const FragmentList& list, const shading::FragmentBlock& block);
    void write_whole(const FragmentList& list, const shading::FragmentBlock& block);  ///< the pixels all of whose samples a fragment has
    /// Place of a pixel's samples, which hold the background before the first call; at: of the pixel in the tile's buffers.
    [[nodiscard]] int part_of(int at);
    /// Pixels from `at` on in the buffers of samples, at most kTileStride: display light and linear light.
    struct ResolvedPixels {
        alignas(64) float linear[4][kTileStride]{}, display[4][kTileStride]{};
        alignas(64) std::uint32_t code[kTileStride];
    };
    void resolve(int at, int count, ResolvedPixels& out);
    void resolve_parts();  ///< and the background between whole pixels
    [[nodiscard]] bool is_written(int x_px, int y_px) const {
        return x_px >= written_.x && x_px < written_.x + written_.width && y_px >= written_.y && y_px < written_.y + written_.height;
    }
    void resolve();
    // tone.cpp
    /// Display light of light times exposure, by the tone curve. Accuracy reference computes it in float64.
    void tone(const float* const light[3], float exposure, float* const display[3], int count) const;
    void fill_backing(float share);                             ///< sets the share of the background colour in every sample
    void cover_backing(int at, unsigned samples, float alpha);  ///< lays a fragment over it; at: of the pixel in the tile's buffers
    void cover_backing(int at, unsigned samples, float alpha, Vec4f keep);  ///< of a layer, in frames where light passes through some
    /// True for a material without light: its colour is one of the display, like the background's, so that neither exposure nor a tone
    /// curve changes it.
    [[nodiscard]] bool is_shown(int material) const {
        return (plan_.shading.materials[static_cast<std::size_t>(material)].stages & kStageUnlit) != 0;
    }
    [[nodiscard]] float exposure_of(int material) const { return is_shown(material) ? 1.0f : plan_.exposure; }
    void begin_shown();                                     ///< before the first colour of the display in the tile
    void add_shown(int at, unsigned samples, Vec4f color);  ///< color: times alpha, and alpha. After cover_backing
    /// Adds what `count` pixels from `at` on show of sample s: display light times alpha, and alpha.
    void add_toned_samples(int at, int count, float* const sums[4]);
    /// backs: the background colour at each of the pixels.
    void add_toned_sample(int s, int at, int count, const Vec4f* backs, float* const sums[4]);
    [[nodiscard]] float* sample_color(int s) { return scratch_.color.data() + static_cast<std::size_t>(s) * 4 * kTilePixels; }

    const PicturePass& pass_;
    const FramePlan& plan_;
    int tile_;
    TileRect rect_;
    int samples_;
    TileScratch& scratch_;
    TileRect written_;  ///< the part of the rect that is the caller's; the rest completes cells
    TileCounts counts_;
    bool toned_;                       ///< codes are written, through a tone curve
    bool has_contact_shadow_ = false;  ///< on some pixel of the tile
    bool transmits_ = false;           ///< light passes through some layer of the tile
    bool has_shown_ = false;           ///< some fragment of the tile has a colour of the display, and there is a tone curve
    bool has_whole_ = false;           ///< pixels that one triangle covers are written at once: there are several samples, but no layers
    bool shades_ = true;               ///< colours are asked for
    bool joins_ = false;               ///< fragments of one smooth surface are joined
    bool direct_ = true;               ///< one opaque sample per pixel: shaded colours go straight to the caller's memory
};

}  // namespace halflit::raster
