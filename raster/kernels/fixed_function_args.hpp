// What the kernels of fixed-function pictures read and write (kernels/fixed_function.hpp, kernels/occlusion.hpp). Colours are codes / 255.
#pragma once

#include "shading/fragment_block.hpp"

#include <cstdint>

namespace halflit::raster {

/// A light on a material: its colours are products of both.
struct FixedLightTerms {
    float place[3];  ///< the light's position, or the way to it, of length 1
    bool directional;
    float axis[3];     ///< of the cone, the way that the light goes, length 1
    float cos_cutoff;  ///< below -1: no cone
    float exponent;
    float attenuation[3];
    float ambient[3], diffuse[3], specular[3];
};

/// Light at vertices. Records of `count` vertices come in, as vertex_records writes those of the slots for position and first coordinates,
/// and of colours where unlit; whole vectors are read.
struct FixedVertexArgs {
    const float* raw;
    int raw_stride, count;
    float* out;  ///< records of `stride` floats; whole vectors are written
    int stride;
    float eye[3];
    float color[4];  ///< what there is without lights, and alpha
    float shininess;
    const FixedLightTerms* lights;
    int light_count;
    bool unlit;      ///< `color` times the vertex colour
    bool separate;   ///< a group of four floats for each light, added to `color`; otherwise the lights are added to `color`, and these are
                     ///< written:
    float depth[4];  ///< slot 0: position and the distance along the view, this row times (x, y, z, 1); slot 1: nothing, and coordinates,
    bool generated;  ///< which are those of the mesh times uv_scale, or
    float uv_scale[2];
    float planes[3][4];  ///< these rows times (x, y, z, 1) of the world; slot 2: colour and alpha
    bool textured;       ///< slot 4: the third coordinate, and this row times (x, y, z, 1): clip w
    float clip_w[4];
};

inline constexpr int kMostLevels = 16;

/// A texture's levels. A texel is red | green << 8 | blue << 16. Faces of cubes have a border of one texel, which shows what is beside
/// them.
struct CodeLevels {
    const std::int32_t* texels;
    const float* decoded;  ///< numbers of codes 0 to 255
    int count;             ///< of levels
    bool cube;
    bool in_codes;  ///< filtered in whole codes; otherwise in numbers, as cubes and sRGB textures are
    std::int32_t first[kMostLevels], width[kMostLevels], height[kMostLevels];  ///< number of a level's first texel, sizes without borders
};

/// Fragments that are textured: coordinates and clip w, with their changes, are in the block's rows for both sets of coordinates.
struct TexelArgs {
    const CodeLevels* levels;
    const shading::FragmentBlock* block;
    const std::int32_t *x_px, *y_px;  ///< of the picture
    int height;                       ///< of the picture, pixels
    int count;                        ///< padded to a multiple of 16
};

/// Colours of textures at fragments.
struct TexelRows {
    alignas(64) float rgb[3][shading::kBlockSize];
};

/// Colours of fragments as codes: light times texture, with fog.
struct CodeArgs {
    const float* light[4];     ///< rows; [3]: alpha
    const TexelRows* texels;   ///< null: no texture
    const float* depth;        ///< distances along the view; null: no fog
    float fog_end, fog_scale;  ///< share of the colour: (fog_end - depth) fog_scale
    float fog_color[3];
    int count;
    std::uint32_t* codes;  ///< red | green << 8 | blue << 16 | alpha << 24; whole vectors are written
};

/// A tile of a light's view. Its places are [first, first of the next tile).
struct OcclusionTile {
    std::uint32_t first;
    float farthest;               ///< smallest reversed depth of its places; 2 without places
    std::int16_t x0, y0, x1, y1;  ///< box of its places in pixels of the view, inclusive; without places, x0 is above x1
};

/// Places in a light's view, at middles of texels, by tiles of it.
struct OcclusionGrid {
    int x0, y0, tile_size, tiles_x;     ///< pixel where the first tile begins; side of a tile; tiles in a row
    const OcclusionTile* tiles;         ///< one more at the end
    const std::int32_t *x, *y;          ///< pixels, from the tile's first one; these arrays have room for a whole vector at the end
    const float* z;                     ///< reversed depth
    float offset_factor, offset_units;  ///< depths of triangles are moved away from the light by factor times the slope, and this
    std::int32_t* hidden;               ///< set to -1 where a triangle is nearer
};

}  // namespace halflit::raster
