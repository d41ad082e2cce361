// Lines and points of an OBJ file.
#pragma once

#include "apps/io/models/model_builder.hpp"
#include "halflit/mesh.hpp"

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace halflit::io::detail {

/// Collects the corners of lines and points by part, and makes one mesh of each part and topology. They have no normals, so they are unlit,
/// in the base colour of the part's material.
class ObjStrokes {
public:
    explicit ObjStrokes(ModelBuilder& builder) : builder_(builder) {}

    /// A polyline, or single points, as indices into the file's positions.
    void add(std::uint32_t part, Topology topology, std::span<const std::uint32_t> corners);
    [[nodiscard]] bool empty() const { return corners_of_.empty(); }
    /// Calls visit(part, position) for all corners.
    template <class Visit>
    void for_each_corner(const Visit& visit) const {
        for (const auto& [key, corners] : corners_of_)
            for (const std::uint32_t position : corners) visit(key.first, position);
    }

    /// Adds the meshes. `positions` and `colors` (empty or shorter, filled up with white) are the file's; material_of, name_of: of each
    /// part. Lines and points that are not finite are left out, with a warning.
    std::vector<PartMesh> add_meshes(std::span<const Vec3d> positions, std::span<const Vec4f> colors, std::span<const int> material_of,
                                     std::span<const std::string> name_of);

private:
    int unlit(int material);

    ModelBuilder& builder_;
    std::map<std::pair<std::uint32_t, Topology>, std::vector<std::uint32_t>> corners_of_;
    std::map<int, int> unlit_of_;  ///< material without light and textures, of one that may have them
};

}  // namespace halflit::io::detail
