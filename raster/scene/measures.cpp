#include "halflit/measures.hpp"

#include "raster/detail/guarded.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/scene/mesh_topology.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace halflit {

using namespace raster;

namespace {

constexpr std::uint64_t kMostCorners = (std::uint64_t{1} << 32) - 1;  ///< of triangles, in one surface
constexpr double kFlatVolume = 1e-12;                                 ///< over the area times half the box's diagonal: rounding

/// Measures of surfaces, with moments in place of the centre.
struct MeasureSums {
    Measures measures;
    Vec3d area_moment{}, volume_moment{};  ///< area or volume times the centre of mass; world space
    bool any = false;                      ///< the box holds something
    bool watertight = true;

    void add(const WeldedSurface& surface);
    [[nodiscard]] Measures result() const;

private:
    void add_triangles(const WeldedSurface& surface, Vec3d middle);
};

void MeasureSums::add_triangles(const WeldedSurface& surface, Vec3d middle) {
    const std::vector<Vec3d>& places = surface.places();
    const std::vector<std::uint32_t>& corners = surface.corners();
    double area = 0.0, volume = 0.0;
    Vec3d by_area{}, by_volume{};  // moments about the middle
    TimeCheck check;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        check();
        const Vec3d a = places[corners[i]] - middle, b = places[corners[i + 1]] - middle, c = places[corners[i + 2]] - middle;
        const double triangle = 0.5 * length(cross(b - a, c - a)), tetrahedron = dot(a, cross(b, c)) * (1.0 / 6.0);
        const Vec3d sum = (a + b) + c;
        area += triangle;
        volume += tetrahedron;
        by_area = by_area + sum * (triangle * (1.0 / 3.0));
        by_volume = by_volume + sum * (tetrahedron * 0.25);
        measures.degenerate_triangles += triangle == 0.0 ? 1 : 0;
    }
    measures.area += area;
    measures.volume += volume;
    area_moment = area_moment + (by_area + middle * area);
    volume_moment = volume_moment + (by_volume + middle * volume);
}

void MeasureSums::add(const WeldedSurface& surface) {
    measures.triangles += surface.corners().size() / 3 + surface.collapsed() + surface.not_finite();
    measures.degenerate_triangles += surface.collapsed();
    measures.not_finite_triangles += surface.not_finite();
    if (surface.places().empty()) return;
    Vec3d low = surface.places().front(), high = low;
    for (const Vec3d& p : surface.places()) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    Vec3d &min = measures.min, &max = measures.max;
    min = any ? Vec3d{std::min(min.x, low.x), std::min(min.y, low.y), std::min(min.z, low.z)} : low;
    max = any ? Vec3d{std::max(max.x, high.x), std::max(max.y, high.y), std::max(max.z, high.z)} : high;
    any = true;
    add_triangles(surface, (low + high) * 0.5);
    if (surface.corners().empty()) return;
    const SurfaceTopology topology = topology_of(surface);
    measures.bodies += topology.bodies;
    measures.open_edges += topology.open_edges;
    measures.flipped_edges += topology.flipped_edges;
    measures.crowded_edges += topology.crowded_edges;
    watertight &= topology.balanced;
}

Measures MeasureSums::result() const {
    Measures all = measures;
    all.watertight = watertight && all.bodies > 0 && all.not_finite_triangles == 0;
    const double flat = kFlatVolume * all.area * (0.5 * length(all.size()));
    if (all.watertight && absolute(all.volume) > flat)
        all.center = volume_moment * (1.0 / all.volume);
    else if (all.area > 0.0)
        all.center = area_moment * (1.0 / all.area);
    return all;
}

/// The mesh of an instance if it counts; null: it does not. Fails for a faulty scene.
Result<const Mesh*> mesh_to_measure(const Scene& scene, const Instance& instance, std::size_t number) {
    if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size())
        return fail(ErrorCode::bad_input, "instance " + std::to_string(number) + ": mesh " + std::to_string(instance.mesh) +
                                              ", expected an index below " + std::to_string(scene.meshes.size()));
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    return triangles_of(mesh) == 0 || catches_shadows(scene, instance) ? nullptr : &mesh;
}

/// Fails if a mesh has an index out of range.
Result<void> check_indices(const Mesh& mesh, std::size_t number) {
    TimeCheck check;
    for (const std::uint32_t index : mesh.indices) {
        check();
        if (index >= mesh.positions.size())
            return fail(ErrorCode::bad_input, "mesh " + std::to_string(number) + ": vertex " + std::to_string(index) +
                                                  ", expected an index below " + std::to_string(mesh.positions.size()));
    }
    return {};
}

/// An instance to measure, checked.
struct MeasuredInstance {
    const Mesh* mesh;
    const Mat4* world_from_object;
    bool begins;  ///< it begins a surface; otherwise it belongs to that of the one before
};

Result<Measures> measured(std::span<const MeasuredInstance> instances) {
    MeasureSums sums;
    for (std::size_t i = 0; i < instances.size();) {
        WeldedSurface surface;
        std::uint64_t corners = 0;
        do {
            const MeasuredInstance& one = instances[i];
            corners += one.mesh->indices.size();
            if (corners > kMostCorners)
                return fail(ErrorCode::limit, "more than " + std::to_string(kMostCorners / 3) + " triangles to measure as one surface");
            surface.add(*one.mesh, *one.world_from_object);
        } while (++i < instances.size() && !instances[i].begins);
        sums.add(surface);
    }
    return sums.result();
}

/// Checks instances of a scene, and lists those that count.
class MeasuredList {
public:
    explicit MeasuredList(const Scene& scene) : scene_(scene), checked_(scene.meshes.size(), false) {}

    /// apart: if its transform is not that of the instance before it, it begins a surface of its own.
    Result<void> add(std::size_t number, bool apart) {
        const Instance& instance = scene_.instances[number];
        const auto mesh = mesh_to_measure(scene_, instance, number);
        if (!mesh) return tl::unexpected<Error>(mesh.error());
        if (*mesh == nullptr) return {};
        const auto m = static_cast<std::size_t>(instance.mesh);
        if (!checked_[m])
            if (auto ok = check_indices(**mesh, m); !ok) return ok;
        checked_[m] = true;
        const bool begins = list_.empty() || (apart && !(*list_.back().world_from_object == instance.world_from_object));
        list_.push_back({*mesh, &instance.world_from_object, begins});
        return {};
    }
    [[nodiscard]] std::span<const MeasuredInstance> list() const { return list_; }

private:
    const Scene& scene_;
    std::vector<bool> checked_;
    std::vector<MeasuredInstance> list_;
};

}  // namespace

Result<Measures> measure_geometry(const Scene& scene, std::span<const int> instances) {
    return guarded("measuring a scene", {}, [&]() -> Result<Measures> {
        MeasuredList list(scene);
        for (const int number : instances) {
            if (number < 0 || static_cast<std::size_t>(number) >= scene.instances.size())
                return fail(ErrorCode::usage,
                            "instance " + std::to_string(number) + ", expected an index below " + std::to_string(scene.instances.size()));
            if (auto ok = list.add(static_cast<std::size_t>(number), false); !ok) return tl::unexpected<Error>(ok.error());
        }
        return measured(list.list());
    });
}

Result<Measures> measure_geometry(const Scene& scene) {
    return guarded("measuring a scene", {}, [&]() -> Result<Measures> {
        MeasuredList list(scene);
        for (std::size_t i = 0; i < scene.instances.size(); ++i)
            if (scene.instances[i].visible)
                if (auto ok = list.add(i, true); !ok) return tl::unexpected<Error>(ok.error());
        return measured(list.list());
    });
}

}  // namespace halflit
