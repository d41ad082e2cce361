// A mesh whose triangles can be told apart in a shader that has neither numbers of triangles nor barycentric coordinates.
#pragma once

#include "halflit/mesh.hpp"

#include <cstdint>
#include <vector>

namespace halflit::peer {

/// The triangles of a mesh in their order, over copies of its vertices. The corners of a triangle have three labels, and its last corner,
/// whose flat values the triangle gets, belongs to it alone.
struct LabelledMesh {
    std::vector<std::uint32_t> source;  ///< by the copy: the mesh's vertex
    std::vector<std::uint8_t> label;    ///< by the copy: 0 to 2
    /// by the copy that is a triangle's last corner: 16 times (the triangle's number plus 1), plus 4 times the label of its third corner,
    /// plus the label of its second one
    std::vector<std::uint32_t> code;
    std::vector<std::uint32_t> indices;
};

/// Finds few copies: each triangle takes the turn and the labels that need fewest new ones. Up to 2^28 - 1 triangles.
[[nodiscard]] LabelledMesh label_corners(const Mesh& mesh);

}  // namespace halflit::peer
