// The story of a pixel: the surface that it shows, what lies before and behind it, the light of each source, and the error of the result.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/material.hpp"
#include "halflit/mesh.hpp"
#include "halflit/renderer.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace halflit {

/// Red, green and blue: linear light after exposure, or 8-bit codes that are not rounded.
using Rgb3 = std::array<double, 3>;

/// A point where a ray meets a triangle of the scene.
struct SurfaceOnRay {
    std::size_t instance = 0;               ///< into Scene::instances
    std::size_t mesh = 0;                   ///< into Scene::meshes
    std::size_t triangle = 0;               ///< number in its mesh
    std::string mesh_name, material_name;   ///< Mesh::name, Material::name
    Vec3d position{};                       ///< world space
    double distance = 0;                    ///< from the start of the ray, world units
    std::array<double, 3> barycentrics{1};  ///< weights of the triangle's corners; their sum is 1
    bool back = false;                      ///< the triangle turns its back to the camera or to the light
    bool layer = false;                     ///< blended or transmitting: seen through, and without a shadow
    double alpha = 1;                       ///< of the base colour, from the textures' full size; 1 where the material is opaque
};

/// A texture at the point that the pixel shows.
struct TextureAt {
    TextureSlot slot = TextureSlot::base_color;  ///< of the material
    int texture = -1;                            ///< into Scene::textures
    int uv_set = 0;                              ///< 0 or 1
    double u = 0, v = 0;                         ///< after the material's transform
    std::array<double, 4> full_size{};  ///< linear red, green, blue and alpha there, in [0, 1]; the picture may read smaller levels
};

/// A splat that the pixel shows.
struct SplatShare {
    std::size_t instance = 0;  ///< into Scene::instances
    std::size_t mesh = 0;      ///< into Scene::meshes
    std::size_t splat = 0;     ///< number in its mesh
    double depth = 0;          ///< along the view axis, world units
    double alpha = 0;          ///< at the pixel's middle
    double weight = 0;         ///< alpha times the share of light that those in front of it let through
    Rgb3 color{};              ///< as it is blended: sRGB codes / 255, or linear light
};

/// One of the scene's lights at the pixel.
struct LightShare {
    std::size_t index = 0;                    ///< into Lighting::all_lights()
    LightType type = LightType::directional;  ///< of the light
    double distance = 0;                      ///< from the surface, world units; 0 for directional lights
    double cosine = 0;                        ///< N.L
    double lobe = 0;                          ///< value of the material's lobe there
    double lambert = 0;                       ///< max(0, N.L)
    Rgb3 linear{};                            ///< its light in the pixel
    std::optional<double> unhidden;           ///< its light over that without shadows, in [0, 1]; none: it has no light here anyway
    /// The nearest triangle that hides the light, on the ray from the surface to the light's middle; none: nothing hides it. The picture is
    /// decided by shadow maps, not by this ray: near the edge of a shadow the two may differ.
    std::optional<SurfaceOnRay> hidden_by;
};

/// Kind of what a pixel shows at its first sample.
enum class PixelShows : std::uint8_t {
    surface,    ///< an opaque or masked surface
    splats,     ///< splats that hide half of what is behind them
    layers,     ///< blended or transmitting surfaces in front of the background
    background  ///< nothing but the background
};

/// Kind of background behind all surfaces.
enum class BackgroundKind : std::uint8_t { transparent, color, environment };

/// All about one pixel.
struct PixelStory {
    int x = 0, y = 0;                                              ///< from the upper left corner of the picture
    PictureSize size;                                              ///< of the picture
    PixelShows shows = PixelShows::background;                     ///< at the first sample
    BackgroundKind background_kind = BackgroundKind::transparent;  ///< by the settings
    std::array<int, 4> codes{};                                    ///< red, green, blue, alpha, 0 to 255
    Rgb3 linear{};                                                 ///< before the tone curve, not multiplied by alpha
    double alpha = 0;                                              ///< in [0, 1]
    double coverage = 0;                                           ///< share of the pixel's samples that opaque or masked surfaces cover

    /// @{
    /// The surface; unset unless `shows` is `surface`.
    std::size_t instance = 0;  ///< into Scene::instances
    std::size_t mesh = 0;      ///< into Scene::meshes
    std::size_t triangle = 0;  ///< number of the triangle, line or point in its mesh
    Topology topology = Topology::triangles;
    std::string mesh_name;                 ///< Mesh::name
    int material_index = -1;               ///< into Scene::materials; -1: the default material
    Material material;                     ///< with the instance's colour in its base colour
    Lobe lobe;                             ///< that the material is drawn with
    std::vector<TextureAt> textures;       ///< that the material uses; of triangles alone
    std::vector<Vec3d> corners;            ///< world space
    std::array<double, 3> barycentrics{};  ///< weights of the corners at `position`; of triangles alone
    double position_error = 0;             ///< distance of `position` from the triangle, by its rounding to float32, world units
    std::vector<Vec2<double>> uv;          ///< texture coordinates of the mesh's sets there, v down; of triangles alone
    Vec3d position{};                      ///< world space: the point that is shaded
    Vec3d normal{};                        ///< world space, unit: the normal that light falls on; 0 where none does
    Rgb3 albedo{};                         ///< base colour
    double depth = 0;                      ///< along the view axis, world units
    bool back = false;                     ///< the triangle turns its back to the camera
    /// @}

    /// @{
    /// Splats at the pixel's middle in front of its surface. Where there are some, `shares` and the other parts of the light are not told.
    std::vector<SplatShare> splats;   ///< the nearest first, the kMostSplats with most weight
    std::size_t splats_left_out = 0;  ///< splats beyond those, and of less than 1/1024
    double splats_passed = 1;         ///< share of the light from behind that all of them let through
    /// @}

    /// @{
    /// Triangles on the ray from the camera through `position`, or without a surface through the pixel's middle, the nearest first.
    /// Distances are from the camera; from the plane through it if it is orthographic. Triangles whose side there is not drawn are left
    /// out, and so are lines and points.
    std::vector<SurfaceOnRay> layers;  ///< layers in front, the nearest kMostSurfaces
    std::vector<SurfaceOnRay> behind;  ///< hidden surfaces and layers behind the surface, the nearest kMostSurfaces
    /// @}

    /// @{
    /// Parts of the light, multiplied by the pixel's alpha: around + emitted + background + all shares = linear * alpha, but for rounding,
    /// an error budget, lights left out and shadow catchers, whose alpha depends on the light.
    std::vector<LightShare> shares;   ///< of the lights, the brightest first
    std::size_t lights_left_out = 0;  ///< lights that were not looked at, beyond kMostShares
    Rgb3 around{};                    ///< ambient light or environment
    Rgb3 emitted{};                   ///< emission and unlit colour
    Rgb3 background{};                ///< what is behind all surfaces
    /// @}
    double contact_shadow = 0;  ///< opacity of the shadow on what is seen of the background, in [0, 1]; 0 where none of it is seen

    std::string no_reference;  ///< why the error is not known; empty: it is
    /// By Accuracy::reference. Not rounded, but where samples of the pixel differ so much that their tone curves are not that of their
    /// mean, as of a surface and a background colour.
    Rgb3 reference_codes{};
    Rgb3 error_codes{};      ///< distance of the picture's codes from them, rounded as they are
    double bound_codes = 0;  ///< the frame's promise; 0: none, as there is no error budget
};

/// Lights that are drawn alone to tell their share. Those that may be brightest at the point come first.
inline constexpr std::size_t kMostShares = 32;
/// Length of the list of splats.
inline constexpr std::size_t kMostSplats = 32;
/// Length of each list of surfaces on the view's ray.
inline constexpr std::size_t kMostSurfaces = 8;

/// Draws the pixel by itself, some times for each light, and casts rays in double. settings.region is ignored. A call of the same renderer
/// for another pixel takes as long again. The reference and its errors come from the C library; all else is the same on every machine.
/// Fails (usage) for a pixel outside of the picture, and as Renderer::render does.
[[nodiscard]] HALFLIT_API Result<PixelStory> explain_pixel(Renderer& renderer, const PreparedScene& scene, const Lighting& light,
                                                           const Camera& camera, const Settings& settings, PictureSize size, int x, int y,
                                                           const Execution& execution = {});

}  // namespace halflit
