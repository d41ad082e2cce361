// Pictures as OpenGL's fixed function makes them: light once a vertex, in codes, with textures, fog, shadow maps that are read without a
// filter, one mirror and transparency in a given order. Simulators and viewers of the years before shaders draw so, and pictures that must
// look like theirs need the same model. Nothing here is linear light: colours are codes / 255, and sums are held in [0, 1].
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/mesh.hpp"
#include "halflit/settings.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace halflit {

/// A picture whose codes are filtered as they are, over levels that are made from codes too. Repeats in both directions; a cube has six
/// faces of width x width, one after the other: +x -x +y -y +z -z, each as OpenGL lays it out.
struct CodeTexture {
    int width = 0, height = 0;      ///< texels; of a cube's face both are the same
    bool cube = false;              ///< six faces, found by a direction
    bool decodes_srgb = false;      ///< texels are decoded to linear numbers when they are read, as sRGB textures are
    std::vector<std::uint8_t> rgb;  ///< three codes a texel; the first row is v = 0
};

/// How a surface looks. Colours are codes / 255.
struct FixedMaterial {
    Vec4f color{0.5f, 0.5f, 0.5f, 1.0f};  ///< what ambient and diffuse light is multiplied by; w: alpha
    Vec3f emission{0, 0, 0};              ///< light of its own
    float specular = 0.0f;                ///< the highlight's color, grey
    float shininess = 0.0f;               ///< exponent of the highlight, 0 to 10000
    int texture = -1;                     ///< index of a CodeTexture; -1: none
    bool generated = false;               ///< texture coordinates are `planes` times (x, y, z, 1) of the object; false: Mesh::uv0
    Vec4f planes[3]{};                    ///< for u, v and, of cubes, the third coordinate
    Vec2f uv_scale{1, 1};                 ///< factors on Mesh::uv0
    /// Its color alone counts, times Mesh::colors if the mesh has some. Solid items show the color once more for each light with shadows
    /// that reaches them, as surfaces without OpenGL's lighting do in such passes.
    bool unlit = false;
};

/// When an item is drawn.
enum class FixedStage : std::uint8_t {
    solid,        ///< opaque, lit and with shadows
    backdrop,     ///< opaque, without shadows; not in mirrors, not in the planes
    haze,         ///< blended once, after solid items and backdrops; not in mirrors, not in the planes
    transparent,  ///< blended last, in the light of all lights, in the order of FixedFrame::items and once more in the reverse order
};

/// A mesh placed in the world.
struct FixedItem {
    int mesh = 0;                          ///< index of a mesh
    Mat4 world_from_object{};              ///< affine
    FixedMaterial material;                ///< its look
    FixedStage stage = FixedStage::solid;  ///< when it is drawn
    std::uint32_t id = 0;                  ///< what the plane of ids shows; items of one id are one object
    bool both_sides = false;               ///< nothing of it is culled; of what casts shadows this does not count
    bool casts_shadow = true;              ///< false: it hides no light
    bool mirrors = false;                  ///< shows FixedFrame::mirror, to which its own color is added
    bool in_mirror = true;                 ///< is seen in the mirror
    bool in_planes = true;                 ///< is drawn where ids are
};

/// A light. Its terms are added as OpenGL adds those of its lights.
struct FixedLight {
    Vec3f position_ws{0, 0, 0};    ///< of directional lights, only the place from which the shadow map is seen
    Vec3f direction_ws{0, 0, -1};  ///< the way that the light goes, any length
    bool directional = false;      ///< otherwise it comes from position_ws
    Vec3f ambient{0, 0, 0}, diffuse{0, 0, 0}, specular{0, 0, 0};  ///< colors of the three terms
    float attenuation[3] = {1, 0, 0};                             ///< 1 / (a + b d + c d d) at the distance d
    float cutoff_deg = 180.0f;                                    ///< half angle of the cone, 0 to 90, or 180: all directions
    float exponent = 0.0f;                                        ///< power of the cosine from the cone's axis, 0 to 10000
    /// Side of its shadow map, 4 to 16384 texels; 0: it casts none. What is in shadow has none of its light, the ambient part neither.
    int shadow_size = 0;
    float shadow_fov_deg = 90.0f;                   ///< of the map's view; 0 to 180, not of directional lights
    float shadow_half_width = 1.0f;                 ///< of directional lights' maps, world units
    float shadow_near = 0.1f, shadow_far = 100.0f;  ///< limits of the map's view, world units
};

/// Which sides cast shadows, and how far they are moved away from the light: factor times the depth's slope, and units of 2^-24.
struct ShadowRule {
    bool back_faces_alone = true;                     ///< faces that look at the light cast none
    float offset_factor = 0.0f, offset_units = 0.0f;  ///< both as OpenGL has them
};

/// A camera as a position, axes and a frustum.
struct FixedCamera {
    Vec3f position_ws{0, 0, 0};  ///< the eye
    Vec3f forward_ws{0, 0, -1};  ///< any length
    Vec3f up_ws{0, 1, 0};        ///< any length, not along forward_ws
    bool parallel = false;       ///< an orthographic view: the frustum is a box
    /// The frustum at the distance near_z, world units.
    float left = -1, right = 1, bottom = -1, top = 1;  ///< its sides
    float near_z = 1.0f, far_z = 100.0f;               ///< limits along the view
};

/// A plane that mirrors what is on the side that its normal points to.
struct FixedMirror {
    Vec3f point_ws{0, 0, 0};   ///< a point of the plane
    Vec3f normal_ws{0, 0, 1};  ///< any length
    float reflectance = 0.0f;  ///< colors in the mirror are multiplied by this, highlights not
};

/// Everything that one picture shows.
struct FixedFrame {
    FixedCamera camera;  ///< from where it is seen
    /// Solid items and backdrops are in any order; of equal depths the first stays. Transparent items are from front to back, and
    /// consecutive ones of one id are one object.
    std::vector<FixedItem> items;
    std::vector<FixedLight> lights;    ///< in any order
    Vec3f eye_ws{0, 0, 0};             ///< from where highlights are seen; usually the camera's position
    float ambient = 0.0f;              ///< of all surfaces, beside the lights
    bool culls_faces = true;           ///< false: both sides are drawn
    bool adds_layers = false;          ///< transparent items are added to what is behind, once, instead of covering it
    bool has_mirror = false;           ///< `mirror` is in use
    FixedMirror mirror;                ///< the one plane that mirrors
    float fog_start = 0, fog_end = 0;  ///< distances along the view; equal: there is no fog
    Vec3f fog_color{0, 0, 0};          ///< of what is far
    float line_width = 1.0f;           ///< pixels, 1/16 to 256; lines have no light of their own
    ShadowRule shadow;                 ///< of all lights
};

/// Memory for a picture. A null pointer: not made, and where `rgb` is null nothing is lit. Transparent items count in depth and ids.
struct FixedTarget {
    int width = 0, height = 0;     ///< pixels
    int samples = 1;               ///< 1 or 4 a pixel, for rgb alone
    bool bottom_up = false;        ///< the first row is the bottom one
    std::uint8_t* rgb = nullptr;   ///< three codes a pixel, rows one after the other
    float* depth = nullptr;        ///< at the pixel's middle: 1 at the near plane, 0 at the far plane and where nothing is
    std::uint32_t* ids = nullptr;  ///< FixedItem::id of what is nearest there; 0: nothing
    bool backdrop_depth = false;   ///< backdrops count in `depth`, and transparent items do not: with rgb of one sample, without ids
};

/// Meshes and textures that stay, and frames of them. One frame at a time; any number of renderers may draw at once.
class FixedFunctionRenderer {
public:
    /// Fails (bad_input) for indices out of range, arrays of different lengths and textures of other sizes than they say.
    [[nodiscard]] HALFLIT_API static Result<FixedFunctionRenderer> make(std::vector<Mesh> meshes, std::vector<CodeTexture> textures,
                                                                        const Execution& execution = {});
    HALFLIT_API ~FixedFunctionRenderer();
    /// @{
    /// One that was moved from may only be assigned to or destroyed.
    HALFLIT_API FixedFunctionRenderer(FixedFunctionRenderer&&) noexcept;
    HALFLIT_API FixedFunctionRenderer& operator=(FixedFunctionRenderer&&) noexcept;
    /// @}

    /// Another one for another thread: it shares the textures, and has meshes of its own.
    [[nodiscard]] HALFLIT_API Result<FixedFunctionRenderer> copy(const Execution& execution = {}) const;

    /// Replaces positions and normals of a mesh, as many as it has.
    [[nodiscard]] HALFLIT_API Result<void> set_vertices(int mesh, std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                                                        const Execution& execution = {});

    /// Draws a frame. Fails (bad_input) for indices and numbers out of range, (usage) for a picture or camera without a size. `on_tile` and
    /// `progress` are not called.
    [[nodiscard]] HALFLIT_API Result<void> render(const FixedFrame& frame, const FixedTarget& target, const Execution& execution = {});

private:
    struct Impl;
    explicit FixedFunctionRenderer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace halflit
