// Lengths of a mesh in another unit.
#pragma once

#include "halflit/mesh.hpp"
#include "sh/vec3d.hpp"

#include <memory>
#include <utility>

namespace halflit::io {

/// Multiplies a mesh's positions, and the sizes of its Gaussians.
inline void scale_lengths(Mesh& mesh, double factor) {
    for (Vec3f& p : mesh.positions) p = to_float(to_double(p) * factor);
    if (mesh.splats == nullptr) return;
    Splats splats = *mesh.splats;
    for (Vec3f& s : splats.scales) s = to_float(to_double(s) * factor);
    mesh.splats = std::make_shared<const Splats>(std::move(splats));
}

}  // namespace halflit::io
