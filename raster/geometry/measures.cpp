#include "halflit/measures.hpp"

#include "raster/detail/guarded.hpp"
#include "raster/geometry/mesh_topology.hpp"
#include "raster/scene/instance_material.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace halflit {

using namespace raster;

namespace {

constexpr std::uint64_t kMostCorners = (std::uint64_t{1} << 32) - 1;  ///< of triangles, in one surface
constexpr double kFlatVolume = 1e-12;                                 ///< over the area times half the box's diagonal: rounding

/// Sums over triangles, with moments about a middle that lies near them.
struct TriangleSums {
    double area = 0.0, volume = 0.0;
    Vec3d by_area{}, by_volume{};
    std::uint64_t degenerate = 0;

    /// Corners less the middle.
    void add(Vec3d a, Vec3d b, Vec3d c) {
        const double triangle = 0.5 * length(cross(b - a, c - a)), tetrahedron = dot(a, cross(b, c)) * (1.0 / 6.0);
        const Vec3d sum = (a + b) + c;
        area += triangle;
        volume += tetrahedron;
        by_area = by_area + sum * (triangle * (1.0 / 3.0));
        by_volume = by_volume + sum * (tetrahedron * 0.25);
        degenerate += triangle == 0.0 ? 1 : 0;
    }
};

/// Measures of surfaces, with moments in place of the centre.
struct MeasureSums {
    Measures measures;
    Vec3d area_moment{}, volume_moment{};  ///< area or volume times the centre of mass; world space
    bool any = false;                      ///< the box holds something
    bool watertight = true;

    /// Adds the measures of a surface but for its bodies and edges. False: it has no triangle of three different corners.
    bool add(const WeldedSurface& surface);
    void add(const SurfaceTopology& topology);
    void add(const TriangleSums& sums, Vec3d middle);
    [[nodiscard]] Measures result() const;
};

void MeasureSums::add(const TriangleSums& sums, Vec3d middle) {
    measures.area += sums.area;
    measures.volume += sums.volume;
    measures.degenerate_triangles += sums.degenerate;
    area_moment = area_moment + (sums.by_area + middle * sums.area);
    volume_moment = volume_moment + (sums.by_volume + middle * sums.volume);
}

/// Calls body(triangle, a, b, c) for each triangle of corners().
template <class Body>
void for_each_triangle(const WeldedSurface& surface, const Body& body) {
    const std::vector<Vec3d>& places = surface.places();
    const std::vector<std::uint32_t>& corners = surface.corners();
    TimeCheck check;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        check();
        body(i / 3, places[corners[i]], places[corners[i + 1]], places[corners[i + 2]]);
    }
}

bool MeasureSums::add(const WeldedSurface& surface) {
    measures.triangles += surface.corners().size() / 3 + surface.collapsed() + surface.not_finite();
    measures.degenerate_triangles += surface.collapsed();
    measures.not_finite_triangles += surface.not_finite();
    if (surface.places().empty()) return false;
    Vec3d low = surface.places().front(), high = low;
    for (const Vec3d& p : surface.places()) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    Vec3d &min = measures.min, &max = measures.max;
    min = any ? Vec3d{std::min(min.x, low.x), std::min(min.y, low.y), std::min(min.z, low.z)} : low;
    max = any ? Vec3d{std::max(max.x, high.x), std::max(max.y, high.y), std::max(max.z, high.z)} : high;
    any = true;
    const Vec3d middle = (low + high) * 0.5;
    TriangleSums sums;
    for_each_triangle(surface, [&](std::size_t, Vec3d a, Vec3d b, Vec3d c) { sums.add(a - middle, b - middle, c - middle); });
    add(sums, middle);
    return !surface.corners().empty();
}

void MeasureSums::add(const SurfaceTopology& topology) {
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

/// Instances of a surface, by the numbers of their first triangles in it.
struct SurfaceInstance {
    std::uint32_t first;
    std::size_t instance;
};

/// The first bodies of a surface, with its topology.
class SurfaceBodyList {
public:
    SurfaceBodyList(const WeldedSurface& surface, std::size_t most) : surface_(surface), topology_(topology_of(surface, most, bodies_)) {
        found_.resize(bodies_.edges.size());
        measure();
    }
    [[nodiscard]] const SurfaceTopology& topology() const { return topology_; }

    void append_to(std::vector<Body>& list, std::span<const SurfaceInstance> instances) const {
        for (std::size_t i = 0; i < found_.size(); ++i) {
            const Found& body = found_[i];
            const BodyEdges& edges = bodies_.edges[i];
            MeasureSums sums;
            sums.measures.min = body.low, sums.measures.max = body.high, sums.any = true;
            sums.measures.triangles = body.triangles;
            sums.add({edges.open, edges.flipped, edges.crowded, 1, edges.balanced});
            sums.add(body.sums, body.middle());
            const std::uint32_t first = surface_.numbers()[body.first];
            const auto after = std::upper_bound(instances.begin(), instances.end(), first,
                                                [](std::uint32_t number, const SurfaceInstance& one) { return number < one.first; });
            list.push_back({(after - 1)->instance, sums.result()});
        }
    }

private:
    struct Found {
        Vec3d low{}, high{};
        std::size_t first = 0;  ///< index of its first triangle
        std::uint64_t triangles = 0;
        TriangleSums sums;
        [[nodiscard]] Vec3d middle() const { return (low + high) * 0.5; }
    };

    void measure() {
        const auto each = [&](const auto& visit) {
            for_each_triangle(surface_, [&](std::size_t triangle, Vec3d a, Vec3d b, Vec3d c) {
                const std::size_t body = bodies_.of_triangle[triangle];
                if (body < found_.size()) visit(found_[body], triangle, a, b, c);
            });
        };
        each([](Found& body, std::size_t triangle, Vec3d a, Vec3d b, Vec3d c) {
            if (body.triangles++ == 0) body.low = body.high = a, body.first = triangle;
            for (const Vec3d& p : {a, b, c}) {
                body.low = {std::min(body.low.x, p.x), std::min(body.low.y, p.y), std::min(body.low.z, p.z)};
                body.high = {std::max(body.high.x, p.x), std::max(body.high.y, p.y), std::max(body.high.z, p.z)};
            }
        });
        each([](Found& body, std::size_t, Vec3d a, Vec3d b, Vec3d c) {
            const Vec3d middle = body.middle();
            body.sums.add(a - middle, b - middle, c - middle);
        });
    }

    const WeldedSurface& surface_;
    SurfaceBodies bodies_;
    SurfaceTopology topology_;
    std::vector<Found> found_;
};

/// An instance to measure, checked.
struct MeasuredInstance {
    std::size_t number;
    const Mesh* mesh;
    const Mat4* world_from_object;
    bool begins;  ///< it begins a surface; otherwise it belongs to that of the one before
};

Result<MeasuredBodies> measured(std::span<const MeasuredInstance> instances, std::size_t most_bodies) {
    MeasureSums sums;
    MeasuredBodies out;
    for (std::size_t i = 0; i < instances.size();) {
        WeldedSurface surface;
        std::vector<SurfaceInstance> of_surface;
        std::uint64_t corners = 0;
        do {
            const MeasuredInstance& one = instances[i];
            corners += one.mesh->indices.size();
            if (corners > kMostCorners)
                return fail(ErrorCode::limit, "more than " + std::to_string(kMostCorners / 3) + " triangles to measure as one surface");
            of_surface.push_back({surface.triangles(), one.number});
            surface.add(*one.mesh, *one.world_from_object);
        } while (++i < instances.size() && !instances[i].begins);
        if (!sums.add(surface)) continue;
        if (out.bodies.size() == most_bodies) {
            sums.add(topology_of(surface));
            continue;
        }
        const SurfaceBodyList bodies(surface, most_bodies - out.bodies.size());
        sums.add(bodies.topology());
        bodies.append_to(out.bodies, of_surface);
    }
    out.all = sums.result();
    return out;
}

Result<Measures> measured(std::span<const MeasuredInstance> instances) {
    auto all = measured(instances, 0);
    if (!all) return tl::unexpected<Error>(all.error());
    return all->all;
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
        list_.push_back({number, *mesh, &instance.world_from_object, begins});
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

Result<MeasuredBodies> measure_bodies(const Scene& scene, std::size_t most) {
    return guarded("measuring a scene", {}, [&]() -> Result<MeasuredBodies> {
        MeasuredList list(scene);
        for (std::size_t i = 0; i < scene.instances.size(); ++i)
            if (scene.instances[i].visible)
                if (auto ok = list.add(i, true); !ok) return tl::unexpected<Error>(ok.error());
        return measured(list.list(), most);
    });
}

Result<Measures> measure_geometry(const Scene& scene) {
    return measure_bodies(scene, 0).map([](const MeasuredBodies& found) { return found.all; });
}

}  // namespace halflit
