#include "raster/view/depth_range.hpp"

#include "raster/detail/view_math.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/scene/placed_point.hpp"
#include "raster/view/culling.hpp"
#include "raster/view/projection.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace halflit::raster {
namespace {

/// Planes at most this many times as far apart as the scene is deep and wide stay where they are: those of cameras that halflit places do.
constexpr double kMostRoom = 8.0;

DepthSpan depth_span(const Camera& camera, const Bounds& box) {
    return {axis(camera.world_from_camera, 3), axis(camera.world_from_camera, 2), box};
}

/// The corners of a surface's part in the view: x and y in shares of half the picture, times w, and the distance along the view axis.
struct CutCorner {
    double x, y, w, depth;
};

/// Whether some part of a triangle lies in the picture and between two distances.
class CutZone {
public:
    CutZone(const Mat4& clip_from_world, const Camera& camera, double from, double to)
        : clip_(clip_from_world),
          back_(axis(camera.world_from_camera, 2)),
          eye_(axis(camera.world_from_camera, 3)),
          orthographic_(camera.orthographic),
          from_(from),
          to_(to) {}

    [[nodiscard]] bool faces_away(const std::array<Vec3d, 3>& p, bool mirrored) const {
        const double side = dot(cross(p[1] - p[0], p[2] - p[0]), orthographic_ ? back_ : eye_ - p[0]);
        return mirrored ? side > 0.0 : side < 0.0;
    }

    /// points: of a triangle, or the corners of a box, of which all may lie outside of one plane.
    template <std::size_t N>
    [[nodiscard]] bool is_outside(const std::array<Vec3d, N>& points) const {
        std::array<CutCorner, N> c{};
        for (std::size_t i = 0; i < N; ++i) c[i] = corner(points[i]);
        for (int plane = 0; plane < kPlanes; ++plane)
            if (std::all_of(c.begin(), c.end(), [&](const CutCorner& p) { return !(inside(p, plane) > 0.0); })) return true;
        return false;
    }

    [[nodiscard]] bool holds_part(const std::array<Vec3d, 3>& points) const {
        std::vector<CutCorner> polygon, rest;
        for (const Vec3d p : points) polygon.push_back(corner(p));
        for (int plane = 0; plane < kPlanes && !polygon.empty(); ++plane) {
            rest.clear();
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const CutCorner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
                const double of_a = inside(a, plane), of_b = inside(b, plane);
                if (of_a > 0.0) rest.push_back(a);
                if ((of_a > 0.0) == (of_b > 0.0)) continue;
                const double t = of_a / (of_a - of_b);
                const auto mixed = [t](double u, double v) { return u + t * (v - u); };
                rest.push_back({mixed(a.x, b.x), mixed(a.y, b.y), mixed(a.w, b.w), mixed(a.depth, b.depth)});
            }
            polygon.swap(rest);
        }
        return polygon.size() >= 3;
    }

private:
    static constexpr int kPlanes = 6;
    [[nodiscard]] CutCorner corner(Vec3d p) const {
        const ClipPlace place = clip_place(clip_, p);
        return {place.x, place.y, place.w, dot(eye_ - p, back_)};
    }
    /// Above 0 inside of a plane.
    [[nodiscard]] double inside(const CutCorner& p, int plane) const {
        const double of[kPlanes] = {p.depth - from_, to_ - p.depth, p.w - p.x, p.w + p.x, p.w - p.y, p.w + p.y};
        return of[plane];
    }

    Mat4 clip_;
    Vec3d back_, eye_;
    bool orthographic_;
    double from_, to_;
};

template <class Box>
std::array<Vec3d, 8> corners_of_box(const Box& at, const Mat4& world_from_object) {
    std::array<Vec3d, 8> out{};
    for (unsigned i = 0; i < 8; ++i) out[i] = placed_in_double(world_from_object, at(i & 1, i & 2, i & 4));
    return out;
}

bool cuts_instance(const PreparedData& scene, std::size_t index, const View& view, const CutZone& zone) {
    constexpr std::uint64_t kUnitsAGroup = 1024, kUnitsATriangle = 32;
    const Instance& instance = scene.scene().instances[index];
    const Mat4& placed = instance.world_from_object;
    const PreparedMesh& prepared = scene.mesh(instance.mesh);
    const Mesh& mesh = scene.scene().meshes[static_cast<std::size_t>(instance.mesh)];
    const bool mirrored = determinant3(placed) < 0.0, both_sides = scene.material(scene.material_of(index)).double_sided;
    const Culler culler(view, multiply_in_double(view.clip_from_world, placed), mirrored, !both_sides);
    const auto outside = [&](Vec3f min, Vec3f max) {
        const auto corner = [&](bool x, bool y, bool z) { return Vec3f{x ? max.x : min.x, y ? max.y : min.y, z ? max.z : min.z}; };
        return zone.is_outside(corners_of_box(corner, placed));
    };
    const auto cuts_cluster = [&](std::size_t c) {
        const IndexRange range = indices_of_cluster(mesh, c);
        check_time();
        charge_work(kUnitsATriangle * (range.end - range.begin) / 3);
        for (std::size_t i = range.begin; i + 3 <= range.end; i += 3) {
            std::array<Vec3d, 3> p{};
            for (std::size_t k = 0; k < 3; ++k) p[k] = placed_in_double(placed, mesh.positions[mesh.indices[i + k]]);
            if ((both_sides || !zone.faces_away(p, mirrored)) && !zone.is_outside(p) && zone.holds_part(p)) return true;
        }
        return false;
    };
    for (std::size_t s = 0; s < prepared.superclusters.size(); ++s) {
        charge_work(kUnitsAGroup);
        const Bounds& all = prepared.superclusters[s];
        if (all.empty || outside(all.min, all.max)) continue;
        const std::size_t end = std::min((s + 1) * kSuperclusterSize, prepared.cluster_count());
        for (std::size_t c = s * kSuperclusterSize; c < end; ++c) {
            const Cluster& one = prepared.clusters[c];
            if (!one.finite || culler.faces_away(one)) continue;
            if (outside({one.min[0], one.min[1], one.min[2]}, {one.max[0], one.max[1], one.max[2]})) continue;
            if (cuts_cluster(c)) return true;
        }
    }
    return false;
}

}  // namespace

DepthSpan::DepthSpan(Vec3d eye, Vec3d back, const Bounds& box) {
    const Vec3d middle = (to_double(box.min) + to_double(box.max)) * 0.5, half = (to_double(box.max) - to_double(box.min)) * 0.5;
    const double centre = dot(eye - middle, back), reach = dot(half, absolute(back));
    nearest = centre - reach, farthest = centre + reach;
}

Camera drawn_camera(const Camera& camera, const PreparedData& scene) {
    Camera drawn = completed(camera, scene.framed_bounds());
    const Bounds& box = scene.bounds();
    if (!drawn.orthographic || box.empty || !finite(drawn.near_z)) return drawn;
    const DepthSpan span = depth_span(drawn, box);
    const double deep = span.farthest - span.nearest, radius = box.radius(), room = deep + radius;
    if (!(room > 0.0 && room < 1e37)) return drawn;
    const bool has_far = finite(drawn.far_z) && drawn.far_z > drawn.near_z;
    if (has_far && double{drawn.far_z} - double{drawn.near_z} <= kMostRoom * (room + radius)) return drawn;
    const double near_z = larger(drawn.near_z, span.nearest - room);
    const double far_z = has_far ? std::min(double{drawn.far_z}, span.farthest + room) : span.farthest + room;
    if (!(far_z > near_z)) return drawn;  // all lies outside of the planes
    drawn.near_z = static_cast<float>(near_z), drawn.far_z = static_cast<float>(far_z);
    return drawn;
}

void add_cut_warning(const PreparedData& scene, const Camera& camera, const View& view, std::vector<std::string>& warnings) {
    const double near_z = camera.near_z;
    if (scene.bounds().empty || !finite(camera.near_z) || !(depth_span(camera, scene.bounds()).nearest < near_z)) return;
    const std::vector<Instance>& instances = scene.scene().instances;
    std::size_t first = 0, count = 0;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const Bounds& box = scene.instance_bounds()[i];
        if (box.empty || !counts_for_views(scene.scene(), instances[i])) continue;
        if (scene.scene().meshes[static_cast<std::size_t>(instances[i].mesh)].topology != Topology::triangles) continue;
        const DepthSpan span = depth_span(camera, box);
        if (!(span.nearest < near_z)) continue;
        const bool crosses = camera.orthographic && span.farthest > near_z;
        const double from = crosses ? span.nearest - 1.0 : 0.0;
        if (!(from < near_z && span.farthest > from)) continue;
        if (!cuts_instance(scene, i, view, CutZone(view.clip_from_world, camera, from, near_z))) continue;
        if (count++ == 0) first = i;
    }
    if (count == 0) return;
    const std::string& name = scene.scene().meshes[static_cast<std::size_t>(instances[first].mesh)].name;
    std::string warning = "the camera's near plane cuts " + (name.empty() ? "" : "'" + name + "', ") + "instance " + std::to_string(first);
    if (count > 1) warning += " (and " + std::to_string(count - 1) + (count == 2 ? " other)" : " others)");
    warnings.push_back(warning + ": what lies between the camera and the plane is not drawn");
}

}  // namespace halflit::raster
