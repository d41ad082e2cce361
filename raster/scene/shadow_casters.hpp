// What can cast a shadow on something else, as a few boxes in world space: shadow maps are fitted to it.
//
// A floor hides nothing where nothing lies behind it, so its map need not show all of it. A plane is left out for a light if no other plane
// has a point behind it. All else, the solids, is always shown. That is enough: a shadow falls where the ray to the light meets a caster.
// If the caster or the receiver is a solid, the ray passes its box. If both are planes, the caster is not left out.
#pragma once

#include "halflit/mesh.hpp"
#include "halflit/scene.hpp"
#include "raster/scene/prepared_mesh.hpp"
#include "sh/vec3d.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace halflit::raster {

/// Triangles that lie in one plane: dot(normal, p) = offset.
struct FlatCaster {
    Bounds box;
    Vec3d normal;  ///< unit
    double offset = 0;
    double slack = 0;   ///< distance that counts as none, world units
    bool casts = true;  ///< false: blended, a receiver alone
    /// The least and the largest signed distance of the other planes' boxes.
    double lowest = 0, highest = 0;
};

struct ShadowCasters {
    std::vector<Bounds> solids;
    std::vector<FlatCaster> planes;

    /// Boxes of what casts a shadow on something in the light of a lamp at `position`, or of directional light that comes from `position`.
    [[nodiscard]] std::vector<Bounds> of_light(Vec3d position, bool directional) const;
};

/// Collects the scene's instances, in their order. meshes: one for each of the scene's; boxes: one for each instance.
[[nodiscard]] ShadowCasters collect_shadow_casters(const Scene& scene, std::span<const PreparedMesh> meshes, std::span<const Bounds> boxes);

}  // namespace halflit::raster
