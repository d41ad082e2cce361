// Coplanar surfaces: triangles of different materials over each other in one plane, as decals lie on a wall and a logo on a body.
//
// Depth cannot order them, because their depths differ by rounding alone. They form groups here, once for a scene. Of a group that a sample
// shows, the material whose first use comes last is drawn, and layers of the group over it: the order of three.js, and of all renderers
// whose depth test passes equal depths. Which surface is in front of a group, or behind it, is still decided by depth.
//
// Triangles lie in one plane if they do so within the rounding of their coordinates in float32: the scale of the scene does not matter, and
// a decal that is held off its wall by any visible distance is no member. They lie over each other if their common part is wider than that.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace halflit::raster {

class PreparedData;

/// Triangles of two instances, of different materials, over each other in one plane.
struct CoplanarPair {
    struct Member {
        std::uint32_t instance, triangle;
        friend auto operator<=>(const Member&, const Member&) = default;
    };
    Member first, second;  ///< first < second
    friend auto operator<=>(const CoplanarPair&, const CoplanarPair&) = default;
};

/// All pairs with an instance that is marked in `among`, in order; among: one entry for each instance, or none for all. Nothing is searched
/// where instances of different materials do not meet, or where more than 2^21 triangles do; beyond 2^20 pairs the rest is left out. Where
/// a limit is met, a search among some may find others than one among all.
[[nodiscard]] std::vector<CoplanarPair> find_coplanar_pairs(const PreparedData& scene, std::span<const std::uint8_t> among = {});

/// The connected components of the pairs.
class CoplanarGroups {
public:
    CoplanarGroups() = default;
    CoplanarGroups(const PreparedData& scene, std::span<const CoplanarPair> pairs);

    [[nodiscard]] bool empty() const { return of_instance_.empty(); }
    /// Number of a triangle's group, from 1; 0: it has none. Requires: not empty().
    [[nodiscard]] std::uint32_t of(std::size_t instance, std::size_t triangle) const {
        const std::vector<std::uint32_t>& groups = of_instance_[instance];
        return groups.empty() ? 0 : groups[triangle];
    }
    /// Order in which the scene uses its materials for the first time. Requires: not empty(), and a material that is drawn.
    [[nodiscard]] std::uint32_t rank(std::size_t material) const { return rank_[material]; }
    /// Of a group's materials.
    [[nodiscard]] std::uint32_t lowest_rank(std::uint32_t group) const { return lowest_rank_[group]; }

private:
    std::vector<std::vector<std::uint32_t>> of_instance_;  ///< for each instance: of its triangles, or nothing if no group has one
    std::vector<std::uint32_t> rank_, lowest_rank_;
};

}  // namespace halflit::raster
