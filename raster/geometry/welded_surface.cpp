#include "raster/geometry/welded_surface.hpp"

#include "raster/scene/placed_point.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <limits>

namespace halflit::raster {
namespace {

bool finite_as_float(Vec3d p) {
    constexpr double kMost = std::numeric_limits<float>::max();
    const Vec3d a = absolute(p);
    return a.x <= kMost && a.y <= kMost && a.z <= kMost;  // false for NaN
}

}  // namespace

void WeldedSurface::add(const Mesh& mesh, const Mat4& world_from_object) {
    if (mesh.topology != Topology::triangles) return;
    constexpr std::uint32_t kUnknown = PlaceTable<Vec3d>::kEmpty;
    // Files often share one vertex array between many meshes: a mesh with few triangles must not cost as much as all vertices.
    std::vector<std::uint32_t> known(mesh.indices.size() > mesh.positions.size() ? mesh.positions.size() : 0, kUnknown);
    const auto place_of = [&](std::uint32_t vertex, Vec3d at) {
        if (known.empty()) return table_.add(at, places_);
        if (known[vertex] == kUnknown) known[vertex] = table_.add(at, places_);
        return known[vertex];
    };
    if (corners_.empty()) corners_.reserve(mesh.indices.size());
    const bool mirrored = determinant3(world_from_object) < 0.0;
    TimeCheck check;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        check();
        const std::uint32_t number = triangles_++;
        Vec3d at[3];
        for (std::size_t k = 0; k < 3; ++k) at[k] = placed_in_double(world_from_object, mesh.positions[mesh.indices[i + k]]);
        if (!finite_as_float(at[0]) || !finite_as_float(at[1]) || !finite_as_float(at[2])) {
            ++not_finite_;
            continue;
        }
        std::uint32_t place[3];
        for (std::size_t k = 0; k < 3; ++k) place[k] = place_of(mesh.indices[i + k], at[k]);
        if (place[0] == place[1] || place[1] == place[2] || place[2] == place[0]) {
            ++collapsed_;
        } else {
            corners_.insert(corners_.end(), {place[0], place[mirrored ? 2 : 1], place[mirrored ? 1 : 2]});
            numbers_.push_back(number);
        }
    }
}

}  // namespace halflit::raster
