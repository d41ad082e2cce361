// Settings of a picture, which decide its pixels, and of its execution, which never do.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/isa.hpp"
#include "halflit/math.hpp"
#include "halflit/shading.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace halflit {

/// The part of the picture to draw, in pixels; width 0 means all of it. Pixels outside are not touched.
struct Region {
    int x = 0, y = 0;           ///< its upper left corner, from that of the picture
    int width = 0, height = 0;  ///< it must lie inside the picture
    friend bool operator==(const Region&, const Region&) = default;
};

/// Edges of a model that are drawn as lines over the picture.
enum class EdgeChoice : std::uint8_t {
    none,
    feature,     ///< where a surface ends, where it bends by more than Settings::edge_angle_deg, and outlines
    silhouette,  ///< where a surface ends, and outlines: where one side faces the viewer and the other does not
    all          ///< of every triangle
};

/// Edges behind surfaces: left out, or dashed, thinner and paler.
enum class HiddenEdges : std::uint8_t { none, dashed };

/// Alpha of 8-bit pictures on a transparent background.
enum class AlphaSpace : std::uint8_t {
    linear,  ///< share of the light that a pixel covers
    display  ///< for programs that blend codes, as browsers do: a blend over white has the codes that a blend of light has
};

/// Surfaces that eye-dome lighting shades.
enum class EyeDomeLighting : std::uint8_t {
    off,
    automatic,  ///< points of meshes without normals
    on          ///< all
};

/// Settings::sky_shadows: by a coarse grid.
inline constexpr int kSkyShadowsAuto = 1;

/// Everything besides scene, camera and size that decides a pixel.
struct Settings {
    Region region{};                        ///< part of the picture to draw
    int samples = 1;                        ///< per pixel: 1, 4, 8 or 16
    Vec4f background_linear{0, 0, 0, 0};    ///< linear colour, not premultiplied; w = 0 is transparent, without a colour
    AlphaSpace alpha = AlphaSpace::linear;  ///< of codes on transparent backgrounds; floats have the share of light
    bool background_environment = false;    ///< true: the scene's environment, if it kept its image
    float exposure = 1.0f;                  ///< factor on all light, above 0
    /// from light to codes, for each sample, after exposure; pictures of floats and the background colour do without
    ToneCurve tone_curve = kDefaultToneCurve;
    ShadingSettings shading{};  ///< light and textures
    /// Size of points, pixels, 1/16 to 256; rounded to 1/256. From 3 on they are round, below that square. 0: the sizes that close the
    /// surface that they lie on, by their distances in the picture: 2 at least, a 25th of the picture's shorter side at most.
    float point_size = 2.0f;
    float line_width = 1.5f;  ///< width of lines, likewise
    /// effect of shadows on wrapped light; off: no shadow maps are drawn
    ShadowMode shadows = ShadowMode::soft_split;
    /// Texels on a side of a shadow map, a multiple of 64 from 64 to 4096; a cube's faces have half. 0: three for two pixels of
    /// what is seen, from 256 to twice the picture's longer side, at most 2048.
    int shadow_size = 0;
    std::size_t shadow_memory_limit = std::size_t{256} << 20;  ///< bytes; the largest shadow maps are halved until all fit
    /// points of a light that has a shadow_radius, each with maps of half that side: 4 to 64
    int soft_shadow_maps = 16;
    /// Angle from the middle of a directional light without a shadow_radius to its edge, as the penumbras of its shadows show it, by a
    /// wider filter in one map: cheap, and an approximation. Penumbras are at most 24 texels wide. Degrees, 0 to 10; 0: all edges are
    /// sharp.
    float shadow_softness_deg = 0.0f;
    /// soft-split: distance to the blocker from which on wrapped light is 0, world units; 0: from object size and wrap
    float shadow_fade = 0.0f;
    /// Number of directions in which ambient light and the environment cast shadows, by shadow maps of 256 texels: 16 to 1024.
    /// 1 (auto): by a grid of at most 28 points on a side, which costs little; 2/5 of the light that is lost comes back from other
    /// surfaces. 0, or without shadows: they cast none.
    int sky_shadows = 0;
    /// Opacity of the soft shadow below a model that stands, over the background, where all light from above is hidden: 0 to 1. There is
    /// none in a scene with a shadow catcher, without shadows, by parallel rays, and seen from below. 0: none.
    float contact_shadow = 0.0f;
    /// Shading by the depths of the picture: a surface is darker where its neighbours are nearer to the viewer. Transparent surfaces count
    /// as not there.
    EyeDomeLighting edl = EyeDomeLighting::off;
    float edl_strength = 1.0f;  ///< of that shading, 0 to 16
    /// Lines along the edges of all that is drawn but shadow catchers, over the finished picture. Surfaces of triangles hide them, glass
    /// does not. A line that touches a surface is in front of it. Vertices at one position count as one, because files split vertices.
    EdgeChoice edges = EdgeChoice::none;
    HiddenEdges hidden_edges = HiddenEdges::none;  ///< edges behind surfaces
    float edge_angle_deg = 30.0f;                  ///< between the normals of two triangles, from which on their edge is a line: 0 to 180
    float edge_width = 1.5f;                       ///< of the lines, pixels, 1/4 to 64; below 1 they are paler instead
    Vec3f edge_color_linear{0, 0, 0};              ///< of the lines, linear; no light, exposure or tone curve changes it
    bool edge_contrast = false;                    ///< black lines on surfaces of dark materials are light grey instead
    /// transparent surfaces on each pixel, in the mean over all pixels of the picture (as of 2^18 if it has fewer), 1 to 2^20; more end the
    /// call with a limit's error: a small file can ask for millions. 0: no limit
    int max_layers = 128;
    bool shadow_terminator_offset = false;  ///< look-ups on the smooth surface given by the vertex normals, for coarse meshes
    friend bool operator==(const Settings&, const Settings&) = default;
};

/// Fails (usage) if a setting is out of range or excludes another one, and (limit) for a size beyond 32,768 pixels on a side.
[[nodiscard]] HALFLIT_API Result<void> check_settings(const Settings& settings, int width, int height);

/// A host's own threads: runs body(i) once for every i in [0, count), in any order, on any threads, and returns when all are done. An item
/// that is left out, run twice or outside of the range is an error of the frame (usage).
using ParallelFor = std::function<void(int count, const std::function<void(int)>& body)>;

/// How a frame is computed. Nothing here changes a pixel. The functions may be called from any thread of the frame, by several at once;
/// they must not throw.
struct Execution {
    int threads = 0;             ///< 0: one per core; at most 1,024 run
    int tile_size = 64;          ///< 16, 32 or 64 pixels
    std::optional<Isa> isa{};    ///< instruction set; empty: default_isa()
    ParallelFor parallel_for{};  ///< the host's threads; empty: threads that halflit starts once and keeps

    /// Asked before each part of the work, thousands of times in a large frame. True stops the call (ErrorCode::cancelled).
    std::function<bool()> cancelled{};
    /// Wall clock for the call, seconds; 0: no limit. A call that takes longer stops at its next part (ErrorCode::limit): a tile, a mesh
    /// that is prepared, a light that is planned.
    double time_limit_s = 0.0;
    /// Working memory for the call, bytes: vertices, triangle lists and shadow maps of a frame, kept from frame to frame. 0: no limit. A
    /// frame that needs more stops (ErrorCode::limit). The caller's scene and target, and fixed buffers of 1 to 3 MB a thread, do not
    /// count.
    std::size_t memory_limit = 0;
    std::function<void(const Region&)> on_tile{};  ///< told after each tile which pixels are final
    /// Told the share of the tiles that are done, in (0, 1]; one call at a time, in rising order.
    std::function<void(double share)> progress{};
};

}  // namespace halflit
