// A few boxes in world space around all that can cast a shadow on something else: shadow maps are fitted to them.
//
// A floor hides nothing if nothing lies below it, so its map need not show all of it. Floors and walls are flat triangles across a world
// axis, at the ends of the box of all flat triangles. Such a face is left out for a light on its inner side. That is enough: a shadow falls
// where the ray to the light meets a caster. Behind a face that is left out there is no flat triangle, so the receiver is one of the
// others, the rest, whose box is always shown.
#pragma once

#include "halflit/scene.hpp"
#include "raster/scene/prepared_mesh.hpp"
#include "sh/vec3d.hpp"

#include <span>
#include <vector>

namespace halflit::raster {

struct ShadowCasters {
    Bounds rest;
    Bounds faces[6];  ///< as FlatFaces::faces
    Bounds flats;     ///< of all flat triangles
    float slack = 0;  ///< distance that counts as none, world units

    /// Boxes of what casts a shadow on something lit from `place`, or by directional light that comes from `place`.
    [[nodiscard]] std::vector<Bounds> of_light(Vec3d place, bool directional) const;
};

/// Collects the scene's instances. meshes: one for each of the scene's; boxes: one for each instance. How the scene is cut into meshes and
/// instances makes no difference where these are not turned, or turned by right angles.
[[nodiscard]] ShadowCasters collect_shadow_casters(const Scene& scene, std::span<const PreparedMesh> meshes, std::span<const Bounds> boxes);

}  // namespace halflit::raster
