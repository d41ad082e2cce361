// One tile of the picture, from triangle lists to pixels. Visibility comes first, then each visible pixel is shaded once per triangle that
// it shows, then transparent triangles are blended in submission order, then the caller's memory is written.
#pragma once

#include "raster/frame_plan.hpp"
#include "raster/passes/output.hpp"
#include "raster/passes/reference_shading.hpp"
#include "raster/passes/tile.hpp"

namespace halflit::raster {

/// The picture as its tiles read it.
struct PicturePass {
    TilePass view;
    const FramePlan& plan;
    Output output;
    const ReferenceShading* reference;  ///< shades instead of the kernels; null: the kernels shade
    const TilePass* normals;            ///< reads positions and normals alone; null: no plane of normals
};

class PictureTile {
public:
    PictureTile(const PicturePass& pass, int tile, TileScratch& scratch)
        : pass_(pass),
          plan_(pass.plan),
          tile_(tile),
          rect_(plan_.picture.tile_rect(tile)),
          samples_(plan_.picture.samples.count),
          scratch_(scratch) {}

    TileCounts draw();

private:
    // shade.cpp
    void shade_visible();
    void shade(FragmentList& list);  ///< writes the colour rows of the scratch's block
    // planes.cpp
    void write_planes(bool empty);           ///< depth and numbers of what each pixel's first sample shows; empty: no triangles
    void write_normals(FragmentList& list);  ///< overwrites the scratch's block
    // blend.cpp
    void blend_layers();
    // resolve.cpp
    void clear();                          ///< fills a tile that has triangles with the background
    void fill_background();                ///< writes a tile that has no triangles
    void fill_samples();                   ///< sets every sample to the environment behind its pixel
    void write(const FragmentList& list);  ///< writes the scratch's block to the caller's memory or to samples
    void write_samples(const FragmentList& list, bool blend);
    void resolve();
    [[nodiscard]] float* sample_color(int s) { return scratch_.color.data() + static_cast<std::size_t>(s) * 4 * kTilePixels; }

    const PicturePass& pass_;
    const FramePlan& plan_;
    int tile_;
    TileRect rect_;
    int samples_;
    TileScratch& scratch_;
    TileCounts counts_;
    bool direct_ = true;  ///< one opaque sample per pixel: shaded colours go straight to the caller's memory
};

}  // namespace halflit::raster
