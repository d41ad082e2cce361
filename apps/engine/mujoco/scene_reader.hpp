// Geoms, lights and cameras of a scene, read from raw memory of any version's layout.
#pragma once

#include "apps/engine/mujoco/model.hpp"
#include "halflit/math.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace halflit::engine::mujoco {

/// A material's texture.
struct TextureUse {
    int texture = -1;  ///< -1: none
    bool uniform = false;
    float repeat[2] = {1, 1};
};

struct Geom {
    std::int32_t type, dataid, objtype, objid, segid, texcoord;
    TextureUse use;
    Vec3f size, position;
    Vec3f axes[3];  ///< columns of mat
    Vec4f rgba;
    float emission, specular, shininess, reflectance, rbound;
};

enum class LightKind { spot, directional, none };

struct Light {
    Vec3f position, direction, ambient, diffuse, specular;
    float attenuation[3];
    float cutoff, exponent;
    LightKind kind;
    bool headlight, castshadow;
};

/// One that looks along `forward` from `position`; the frustum is symmetric to `center`.
struct Camera {
    Vec3f position, forward, up;
    float center, width, bottom, top, near_z, far_z;  ///< width: half of it, 0: as the picture's shape says
    bool orthographic;
};

/// materials: where geoms name a material instead of a texture. texture_count: of the model. Fails (bad_input) for an index out of range
/// and numbers that are not finite.
[[nodiscard]] Result<Geom> read_geom(const Layout& layout, const Scene& scene, int index, std::span<const TextureUse> materials,
                                     int texture_count);
[[nodiscard]] Light read_light(const Layout& layout, const Scene& scene, int index);
/// The mean of two cameras; fails (usage) for one that sees nothing.
[[nodiscard]] Result<Camera> read_camera(const Layout& layout, const std::byte* two);

}  // namespace halflit::engine::mujoco
