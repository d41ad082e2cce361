// Triangles as formats but glTF have them: corners that refer to lists of positions, normals and so on, each on its own. They become
// meshes, whose vertices have one index each.
#pragma once

#include "apps/io/files/double_box.hpp"
#include "halflit/mesh.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::io::detail {

inline constexpr std::uint32_t kNone = 0xFFFFFFFFu;

struct Soup {
    /// Lists that corners refer to. Readers fill `positions`, of which move_near makes `points`.
    std::vector<Vec3d> positions;
    std::vector<Vec3f> points, normals;
    std::vector<Vec2f> uvs;     ///< v points down
    std::vector<Vec4f> colors;  ///< linear RGBA
    /// For each corner, three to a triangle: index into `positions`.
    std::vector<std::uint32_t> position_of;
    /// The same for the other lists; kNone: has none. A vector that is shorter than position_of counts as filled up with kNone.
    std::vector<std::uint32_t> normal_of, uv_of, color_of;
    /// For each triangle: its part, which becomes a mesh; empty: all are part 0.
    std::vector<std::uint32_t> part_of;
    /// For each triangle, where corners have no normal: kByCrease: smooth across edges that are not sharp; 0: flat; another number: smooth
    /// with all neighbours of the same number. Shorter: filled up with kByCrease.
    std::vector<std::uint32_t> smoothing_of;
    bool distinct = false;  ///< the positions are float32's, and no two are equal

    static constexpr std::uint32_t kByCrease = kNone;
    [[nodiscard]] std::size_t triangles() const { return position_of.size() / 3; }
};

/// The corners at each place, in increasing order.
class CornersOfPlaces {
public:
    /// place_of: the place of each corner, below `places`.
    CornersOfPlaces(const std::vector<std::uint32_t>& place_of, std::size_t places);
    [[nodiscard]] std::size_t places() const { return first_.size() - 1; }
    [[nodiscard]] std::span<const std::uint32_t> at(std::uint32_t place) const {
        return std::span(corner_).subspan(first_[place], first_[place + 1] - first_[place]);
    }

private:
    std::vector<std::uint32_t> first_, corner_;
};

struct SoupMesh {
    std::uint32_t part;
    Mesh mesh;  ///< without name and material
};

/// Places that are worth a thread: they take it some 10 ms.
inline constexpr std::size_t kPlacesAThread = 1 << 16;

/// Memory that make_meshes takes for each triangle, with the mesh itself. Readers take it from the budget as triangles are added.
inline constexpr std::uint64_t kTriangleBytes = 260;

/// Point near which positions are rounded to float32: their centre if they lie far from the origin for their size, else the origin. Those
/// that are not finite do not count.
[[nodiscard]] Vec3d origin_of(const DoubleBox& box);
/// A position about an origin. One beyond float32's range becomes infinite.
[[nodiscard]] Vec3f rounded_near(Vec3d position, Vec3d origin);
/// Whether a position is finite as float32.
[[nodiscard]] bool fits_float(Vec3d position);
/// Makes `points` of `positions`, which it empties: those that triangles use decide the origin, which is returned. recentre: false: it is
/// 0.
[[nodiscard]] Vec3d move_near(Soup& soup, bool recentre);

/// One mesh for each part that has triangles, in the order of their first ones. Equal positions are one place: corners without a normal get
/// the mean of their neighbours', weighted by angle, across edges that are not sharper than `crease_deg`. Triangles that are not finite,
/// that lie on a line between two places, or that are a point, are left out; `left_out` counts the first kind. Requires: indices in range,
/// and points.
[[nodiscard]] std::vector<SoupMesh> make_meshes(Soup&& soup, double crease_deg, int threads, std::size_t& left_out);

}  // namespace halflit::io::detail
