// Meshes of the library Draco. It is optional: HALFLIT_HAS_DRACO is 0 in a build without it.
//
// The library decodes integers. Positions and directions are computed from them here, because the library's own floats are not the same on
// every machine.
#pragma once

#include "halflit/error.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace halflit::io::detail {

/// The part of a Draco mesh that an accessor takes.
struct DracoRequest {
    std::uint32_t unique_id = 0;  ///< of the attribute
    int component_type = 0;       ///< glTF's number
    int components = 0;
    std::size_t stride = 0;  ///< bytes between two elements of the result
    bool normalized = false;
};

class DracoMesh {
public:
    /// Decodes a stream of version 2.2. Fails (bad_input) for damaged ones and in a build without the library, and (limit) for one that
    /// takes more than about `memory` bytes, before they are taken.
    static Result<std::unique_ptr<DracoMesh>> decode(std::span<const std::byte> stream, std::uint64_t memory);
    DracoMesh() = default;
    DracoMesh(const DracoMesh&) = delete;
    DracoMesh& operator=(const DracoMesh&) = delete;
    virtual ~DracoMesh() = default;

    [[nodiscard]] virtual std::size_t vertices() const = 0;
    [[nodiscard]] virtual std::size_t triangles() const = 0;
    [[nodiscard]] virtual std::size_t attributes() const = 0;
    [[nodiscard]] virtual std::vector<std::byte> indices() const = 0;  ///< little-endian, 4 bytes each
    /// Values of all vertices, little-endian. Fails where the mesh lacks the attribute, or its type does not fit. converted: if not null,
    /// floats become the integers that are asked for, and it becomes true for that.
    [[nodiscard]] virtual Result<std::vector<std::byte>> values(const DracoRequest& request, bool* converted) const = 0;
};

}  // namespace halflit::io::detail
