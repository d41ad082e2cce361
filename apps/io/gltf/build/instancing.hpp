// EXT_mesh_gpu_instancing: a node's mesh at many places.
#pragma once

#include "apps/io/gltf/build/primitive.hpp"

#include <cstddef>

namespace halflit::io::detail {

/// Translation, rotation and scale of each instance, in the node's space. A null accessor stands for the identity.
struct InstancePlaces {
    const Accessor *translation = nullptr, *rotation = nullptr, *scale = nullptr;
    std::size_t count = 0;

    [[nodiscard]] Affine at(std::size_t instance) const;
};

/// Throws LoadFailure for accessors of a wrong type, or of different counts. Requires: the node has the extension.
[[nodiscard]] InstancePlaces read_instance_places(Document& document, PrimitiveReader& reader, std::size_t node);

}  // namespace halflit::io::detail
