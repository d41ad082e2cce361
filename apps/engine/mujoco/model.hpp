// The simulator MuJoCo, as far as drawing reads it: a model's arrays, and scenes as raw memory whose layout a table gives, so that every
// version's structs are read in place. Names are those of mjModel, mjvScene, mjvGeom, mjvLight and mjvGLCamera.
#pragma once

#include "halflit/error.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace halflit::engine::mujoco {

/// Where members are: bytes from the start of their struct, -1: nowhere. `geom_size`, `light_size` and `camera_size` are those of the
/// structs; mjvGeom.size is `geom_scale`.
struct Layout {
#define WHOLE(name, bytes) std::int32_t name = bytes;
#define MEMBER(type, name, count, whole, place, is_needed) std::int32_t name = place;
#include "apps/engine/mujoco/layout_members.def"
    /// Numbers of mjtGeom that differ among versions; -1: there is none.
    std::int32_t type_skin = 104, type_flex = -1, type_linebox = -1, type_triangle = -1;
};

/// Fails (usage) for a member outside of its struct, and for one that is needed and has no place.
[[nodiscard]] Result<void> check_layout(const Layout& layout);

/// A model's arrays, which are used while shapes and textures are made.
struct Model {
#define NUMBER(type, name, value) type name = value;
#define COUNT(name) std::int32_t name = 0;
#define ARRAY(type, name, count, each) const type* name = nullptr;
#include "apps/engine/mujoco/model_members.def"
    std::uint64_t ntexdata = 0;
    float fog_rgba[4] = {0, 0, 0, 1}, haze_rgba[4] = {1, 1, 1, 1};
    Layout layout;
};

/// Fails (bad input) for a negative count, a null array of which something is read, shapes that are too fine, and numbers that are not
/// finite.
[[nodiscard]] Result<void> check_model(const Model& model);

/// `count` numbers from `begin` on of an array of `size`; fails (bad input) if they are not all in it. what: "mesh 3: vertices".
[[nodiscard]] Result<void> check_range(std::int64_t begin, std::int64_t count, std::uint64_t size, std::string_view what);

/// mjtRndFlag.
enum Flag { kShadow, kWireframe, kReflection, kAdditive, kSkybox, kFog, kHaze, kSegment, kIdColor, kCullFace, kFlagCount };
inline constexpr std::string_view kFlagNames[kFlagCount] = {"SHADOW", "WIREFRAME", "REFLECTION", "ADDITIVE", "SKYBOX",
                                                            "FOG",    "HAZE",      "SEGMENT",    "IDCOLOR",  "CULL_FACE"};
inline constexpr std::uint8_t kDefaultFlags[kFlagCount] = {1, 0, 1, 0, 1, 0, 1, 0, 0, 1};

/// mjtGeom, as far as versions agree; others have numbers below 0 here. SDF is drawn as a mesh.
enum GeomType {
    kSkin = -5,
    kFlex,
    kLineBox,
    kTriangle,
    kNotDrawn,
    kPlane,
    kHField,
    kSphere,
    kCapsule,
    kEllipsoid,
    kCylinder,
    kBox,
    kMesh,
    kSdf,
    kArrow = 100,
    kArrow1,
    kArrow2,
    kLine
};

/// What mjv_updateScene() has left. Memory of the caller; no number in it is trusted.
struct Scene {
    const std::byte* geoms = nullptr;
    const std::byte* lights = nullptr;
    const std::byte* camera = nullptr;    ///< two
    const std::uint8_t* flags = nullptr;  ///< null: kDefaultFlags
    const float* skinvert = nullptr;      ///< null: skins are not drawn
    const float* skinnormal = nullptr;
    const std::int32_t* flexfaceused = nullptr;  ///< null: flexes are not drawn
    const float* flexface = nullptr;
    const float* flexnormal = nullptr;
    std::int32_t ngeom = 0, nlight = 0;
    bool enabletransform = false;
    float translate[3] = {0, 0, 0}, rotate[4] = {1, 0, 0, 0}, scale = 1;
};

/// Rules that differ among releases.
struct Look {
    std::string_view name;              ///< a release with these rules
    int since;                          ///< 30303: 3.3.3 is the first release with them
    bool decodes_srgb;                  ///< textures that say so are decoded
    bool shapes_have_uv;                ///< flat textures lie on primitives by coordinates of their own, which texrepeat multiplies
    bool counts_lights_alone;           ///< there is ambient light where no light counts; else where the scene has none
    bool back_faces_alone;              ///< cast shadows
    float offset_factor, offset_units;  ///< of what casts shadows, away from the light
};

/// The rules of a release of MuJoCo from 2.2 on, below 4: two or three numbers of at most two digits. Fails (usage) for another text.
[[nodiscard]] Result<Look> look_of(std::string_view name);

}  // namespace halflit::engine::mujoco
