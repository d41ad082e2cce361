// The triangles of the part of a scene that views look at.
#pragma once

#include "halflit/scene.hpp"
#include "raster/scene/framed_part.hpp"
#include "raster/scene/instance_material.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <array>
#include <cstddef>
#include <utility>

namespace halflit::raster {

[[nodiscard]] inline bool shows_both_sides(const Scene& scene, const Instance& instance) {
    const Material* const material = material_of(scene, instance);
    return material != nullptr && material->double_sided;
}

/// Calls f(corners, both_sides) for each triangle of what is framed, as its front is turned.
template <class Fn>
void each_triangle(const Scene& scene, const FramedPart& part, const Fn& f) {
    TimeCheck check;
    for (const int i : part.instances) {
        const Instance& instance = scene.instances[static_cast<std::size_t>(i)];
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (mesh.topology != Topology::triangles) continue;
        const bool both_sides = shows_both_sides(scene, instance), mirrored = determinant3(instance.world_from_object) < 0.0;
        for (std::size_t k = 0; k + 3 <= mesh.indices.size(); k += 3) {
            check();
            std::array<Vec3d, 3> at;
            for (std::size_t c = 0; c < 3; ++c)
                at[c] = to_double(transform_point(instance.world_from_object, mesh.positions[mesh.indices[k + c]]));
            if (mirrored) std::swap(at[1], at[2]);
            f(at, both_sides);
        }
    }
}

}  // namespace halflit::raster
