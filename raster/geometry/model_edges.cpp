#include "raster/geometry/model_edges.hpp"

#include "raster/geometry/surface_edges.hpp"
#include "raster/scene/instance_material.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::raster {
namespace {

/// The unit normal of a triangle; 0 if it has no area.
Vec3d normal_of(const WeldedSurface& surface, std::uint32_t face) {
    const std::uint32_t* const c = &surface.corners()[3 * std::size_t{face}];
    const Vec3d& a = surface.places()[c[0]];
    const Vec3d n = cross(surface.places()[c[1]] - a, surface.places()[c[2]] - a);
    const double size = length(n);
    return size > 0.0 ? n * (1.0 / size) : Vec3d{};
}

bool has_edges(const Scene& scene, const Instance& instance) {
    return counts_for_views(scene, instance) && triangles_of(scene.meshes[static_cast<std::size_t>(instance.mesh)]) > 0;
}

/// The triangles along one edge, with their directions and normals.
class EdgeFaces {
public:
    EdgeFaces(const WeldedSurface& surface, const std::vector<Vec3d>& normals, std::uint32_t low, std::span<const EdgeUse> uses,
              double least_cosine)
        : surface_(surface), normals_(normals), low_(low), uses_(uses), least_cosine_(least_cosine) {}

    [[nodiscard]] EdgeKind kind() const {
        if (uses_.size() == 1) return EdgeKind::border;
        if (uses_.size() == 2) return continues(uses_[0], uses_[1]) ? EdgeKind::smooth : EdgeKind::crease;
        const auto some = compared();
        return std::all_of(some.begin(), some.end(), [&](const EdgeUse& a) { return next(a, some) != nullptr; }) ? EdgeKind::smooth
                                                                                                                 : EdgeKind::crease;
    }
    /// The triangle that continues the first one; the last one where none does.
    [[nodiscard]] const EdgeUse& partner() const {
        const EdgeUse* const found = uses_.size() > 2 ? next(uses_[0], compared()) : nullptr;
        return found != nullptr ? *found : uses_.back();
    }
    /// The first one and its partner run along the edge in one direction.
    [[nodiscard]] bool turned() const { return uses_.size() > 1 && upward(uses_[0]) == upward(partner()); }

private:
    /// The first of many, so that an edge of a million triangles takes no million squared.
    [[nodiscard]] std::span<const EdgeUse> compared() const {
        constexpr std::size_t kMost = 16;
        return uses_.first(std::min(uses_.size(), kMost));
    }
    [[nodiscard]] const EdgeUse* next(const EdgeUse& a, std::span<const EdgeUse> some) const {
        for (const EdgeUse& b : some)
            if (upward(a) != upward(b) && continues(a, b)) return &b;
        return nullptr;
    }
    [[nodiscard]] bool upward(const EdgeUse& use) const { return surface_.corners()[use.corner()] == low_; }
    /// The surface goes on from one triangle to the other without a bend. Two that run along the edge in one direction face opposite ways:
    /// one of them is turned. A triangle without area bends nothing.
    [[nodiscard]] bool continues(const EdgeUse& a, const EdgeUse& b) const {
        const Vec3d &of_a = normals_[a.triangle()], &of_b = normals_[b.triangle()];
        if (of_a == Vec3d{} || of_b == Vec3d{}) return true;
        const double cosine = dot(of_a, of_b);
        return (upward(a) != upward(b) ? cosine : -cosine) >= least_cosine_;
    }

    const WeldedSurface& surface_;
    const std::vector<Vec3d>& normals_;
    std::uint32_t low_;
    std::span<const EdgeUse> uses_;
    double least_cosine_;
};

}  // namespace

void ModelEdges::add_surface(WeldedSurface& surface, double least_cosine) {
    surface.end();
    const auto first_place = static_cast<std::uint32_t>(places_.size());
    const auto first_face = static_cast<std::uint32_t>(corners_.size() / 3);
    corners_.resize(corners_.size() + 3 * std::size_t{surface.triangles()});
    neighbours_.resize(corners_.size(), kNone);
    const std::vector<std::uint32_t>&corners = surface.corners(), &numbers = surface.numbers();
    for (std::size_t i = 0; i < corners.size(); ++i)
        corners_[3 * (std::size_t{first_face} + numbers[i / 3]) + i % 3] = first_place + corners[i];
    std::vector<Vec3d> normals(numbers.size());
    TimeCheck check;
    for (std::uint32_t face = 0; face < normals.size(); ++face) check(), normals[face] = normal_of(surface, face);

    for_each_edge(surface, [&](std::uint32_t low, std::span<const EdgeUse> uses) {
        const auto face = [&](const EdgeUse& use) { return first_face + numbers[use.triangle()]; };
        if (uses.size() == 2)
            for (const int k : {0, 1}) neighbours_[3 * std::size_t{face(uses[k])} + uses[k].corner() % 3] = face(uses[1 - k]);
        const EdgeFaces faces(surface, normals, low, uses, least_cosine);
        edges_.push_back(
            {first_place + low, first_place + uses[0].high(), {face(uses.front()), face(faces.partner())}, faces.kind(), faces.turned()});
    });
    if (places_.empty())
        places_ = surface.take_places();
    else
        places_.insert(places_.end(), surface.places().begin(), surface.places().end());
}

std::uint64_t ModelEdges::most_bytes(const Scene& scene) {
    // Lists that grow have at most twice the room that they need, and the old one beside the new one while they are copied.
    struct Sums {
        std::uint64_t triangles = 0, vertices = 0, meshes = 0;
        /// A place has at most 32 bytes in the table and 48 in the list; 24 more while either grows. Corners are reserved for one mesh.
        [[nodiscard]] std::uint64_t to_weld() const { return (104 + 4) * vertices + (12 + (meshes > 1 ? 36 : 12)) * triangles; }
        /// Normals and uses of corners, besides what is left of the welding.
        [[nodiscard]] std::uint64_t to_list() const { return (48 + 4) * vertices + (8 + (meshes > 1 ? 24 : 12) + 24 + 24) * triangles; }
    };
    Sums all, surface;
    std::uint64_t weld = 0, list = 0, surfaces = 0;
    const Instance* before = nullptr;
    for (const Instance& instance : scene.instances) {
        if (!has_edges(scene, instance)) continue;
        if (before == nullptr || !(before->world_from_object == instance.world_from_object)) surface = {}, ++surfaces;
        before = &instance;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        for (Sums* const sums : {&all, &surface}) {
            sums->triangles += triangles_of(mesh), ++sums->meshes;
            sums->vertices += std::min(mesh.positions.size(), mesh.indices.size());
        }
        weld = std::max(weld, surface.to_weld()), list = std::max(list, surface.to_list());
    }
    // Edges have room for 1.5 a triangle, as a closed surface has, and grow once where there are more.
    constexpr std::uint64_t kEdges = 3 * sizeof(ModelEdge) / 2, kMoreEdges = 3 * sizeof(ModelEdge);
    constexpr std::uint64_t kNumbers = 2 * 3 * sizeof(std::uint32_t) + 1;  // corners, neighbours, sides
    return (kNumbers + kEdges) * all.triangles + (surfaces > 1 ? 72 * all.vertices : 0) + 12 * scene.instances.size() +
           std::max(weld, list + kMoreEdges * all.triangles);
}

std::size_t ModelEdges::bytes() const {
    return places_.capacity() * sizeof(Vec3d) +
           (corners_.capacity() + neighbours_.capacity() + first_face_.capacity()) * sizeof(std::uint32_t) +
           (single_sided_.capacity() + dark_.capacity()) / 8 + edges_.capacity() * sizeof(ModelEdge);
}

void ModelEdges::find(const Scene& scene, double crease_deg, const std::function<bool(const Instance&)>& is_dark) {
    *this = {};
    const double least_cosine = sin_cos(crease_deg * (kPi / 180.0)).cos;
    std::size_t triangles = 0;
    for (const Instance& instance : scene.instances)
        if (has_edges(scene, instance)) triangles += triangles_of(scene.meshes[static_cast<std::size_t>(instance.mesh)]);
    corners_.reserve(3 * triangles), neighbours_.reserve(3 * triangles);
    edges_.reserve(3 * triangles / 2);
    WeldedSurface surface;
    const Mat4* place = nullptr;
    std::uint32_t faces = 0;
    for (const Instance& instance : scene.instances) {
        const bool counts = has_edges(scene, instance);
        first_face_.push_back(counts ? faces : kNone);
        if (!counts) continue;
        const Material* const material = material_of(scene, instance);
        if (place != nullptr && !(*place == instance.world_from_object)) {
            add_surface(surface, least_cosine);
            surface = {};
        }
        place = &instance.world_from_object;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        surface.add(mesh, instance.world_from_object);
        faces += static_cast<std::uint32_t>(triangles_of(mesh));
        single_sided_.resize(faces, material == nullptr || !material->double_sided);
        dark_.resize(faces, is_dark && is_dark(instance));
    }
    if (place != nullptr) add_surface(surface, least_cosine);
}

}  // namespace halflit::raster
