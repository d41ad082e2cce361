// The triangles of the part of a scene that views look at.
#pragma once

#include "halflit/scene.hpp"
#include "raster/scene/framed_part.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/scene/mesh_triangles.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"

#include <array>
#include <cstddef>
#include <utility>

namespace halflit::raster {

[[nodiscard]] inline bool shows_both_sides(const Scene& scene, const Instance& instance) {
    const Material* const material = material_of(scene, instance);
    return material != nullptr && material->double_sided;
}

/// Calls f(corners, both_sides) for each triangle of what is framed, as its front is turned. Of a part, those that lie in its box.
template <class Fn>
void each_triangle(const Scene& scene, const FramedPart& part, const Fn& f) {
    const Vec3f &low = part.bounds.min, &high = part.bounds.max;
    const auto is_framed = [&](Vec3f p) {
        return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
    };
    for (const int i : part.instances) {
        const Instance& instance = scene.instances[static_cast<std::size_t>(i)];
        const bool both_sides = shows_both_sides(scene, instance), mirrored = determinant3(instance.world_from_object) < 0.0;
        each_triangle(scene.meshes[static_cast<std::size_t>(instance.mesh)], 1, [&](const Vec3f(&corners)[3]) {
            std::array<Vec3d, 3> at;
            for (std::size_t c = 0; c < 3; ++c) {
                const Vec3f p = transform_point(instance.world_from_object, corners[c]);
                if (!part.whole && !is_framed(p)) return;
                at[c] = to_double(p);
            }
            if (mirrored) std::swap(at[1], at[2]);
            f(at, both_sides);
        });
    }
}

}  // namespace halflit::raster
