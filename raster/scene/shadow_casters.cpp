#include "raster/scene/shadow_casters.hpp"

#include "raster/detail/view_math.hpp"
#include "raster/scene/placed_box.hpp"
#include "sh/mat4.hpp"

#include <algorithm>

namespace halflit::raster {
namespace {

constexpr std::size_t kMostSolids = 64;  ///< boxes; more are merged, neighbours in the scene's order first
constexpr std::size_t kMostPlanes = 64;  ///< further ones count as solids
/// Distance that counts as none, as a share of the coordinates: above the rounding of positions, below any step of a model.
constexpr double kSlack = 4e-6;

double largest_coordinate(const Bounds& b) {
    double largest = 0.0;
    for (const float v : {b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z}) largest = larger(largest, magnitude(double{v}));
    return largest;
}

Vec3d corner(const Bounds& b, int k) { return {k & 1 ? b.max.x : b.min.x, k & 2 ? b.max.y : b.min.y, k & 4 ? b.max.z : b.min.z}; }

class Collector {
public:
    explicit Collector(const Scene& scene) : scene_(scene) {}

    void add(const Instance& instance, const Mesh& mesh, const PreparedMesh& prepared, const Bounds& box) {
        if (box.empty) return;
        const bool blended = mesh.material >= 0 && scene_.materials[static_cast<std::size_t>(mesh.material)].alpha_mode == AlphaMode::blend;
        if (!prepared.has_flat_clusters || !prepared.finite) return add_solid(box);
        for (std::size_t c = 0; c < prepared.cluster_count(); ++c) {
            const Cluster& cluster = prepared.clusters[c];
            if (!(cluster.min[0] <= cluster.max[0])) continue;
            const PlacedBox placed(cluster.min, cluster.max, instance.world_from_object);
            const auto low = [&](int axis, float least) { return std::max(static_cast<float>(placed.low[axis]), least); };
            const auto high = [&](int axis, float most) { return std::min(static_cast<float>(placed.high[axis]), most); };
            const Bounds part{{low(0, box.min.x), low(1, box.min.y), low(2, box.min.z)},
                              {high(0, box.max.x), high(1, box.max.y), high(2, box.max.z)},
                              false};
            const int axis = flat_axis(cluster);
            if (axis < 0 || !add_flat(part, plane_normal(instance.world_from_object, axis), !blended)) add_solid(part);
        }
    }

    [[nodiscard]] ShadowCasters finish() {
        for (FlatCaster& plane : out_.planes)
            for (const FlatCaster& other : out_.planes) {
                if (&other == &plane) continue;
                for (int k = 0; k < 8; ++k) {
                    const double distance = dot(plane.normal, corner(other.box, k)) - plane.offset;
                    plane.lowest = std::min(plane.lowest, distance);
                    plane.highest = std::max(plane.highest, distance);
                }
            }
        return std::move(out_);
    }

private:
    /// World-space normal of an object-space plane; zero if it has none.
    static Vec3d plane_normal(const Mat4& world_from_object, int axis) {
        const Vec3d n = to_double(normal_matrix(world_from_object).c[axis]);
        const double size = length(n);
        return size > 0.0 ? n * (1.0 / size) : Vec3d{};
    }

    /// Returns false if there are too many planes, or this is none.
    bool add_flat(const Bounds& box, Vec3d normal, bool casts) {
        if (normal == Vec3d{}) return false;
        // The box of a tilted plane is thick; its middle lies in the plane.
        const double offset = dot(normal, (corner(box, 0) + corner(box, 7)) * 0.5), slack = kSlack * largest_coordinate(box);
        for (FlatCaster& known : out_.planes) {
            const double along = dot(known.normal, normal);
            if (known.casts != casts || !(magnitude(along) > 1.0 - 1e-10)) continue;
            if (magnitude(known.offset - (along < 0 ? -offset : offset)) > std::min(slack, known.slack)) continue;
            known.box.include(box);
            known.slack = std::max(known.slack, slack);
            return true;
        }
        if (out_.planes.size() == kMostPlanes) return false;
        out_.planes.push_back({box, normal, offset, slack, casts, 0.0, 0.0});
        return true;
    }

    void add_solid(const Bounds& box) {
        std::vector<Bounds>& solids = out_.solids;
        if (in_last_ == merged_ || solids.empty()) {
            if (solids.size() == kMostSolids) {
                for (std::size_t i = 0; i < kMostSolids / 2; ++i) {
                    solids[i] = solids[2 * i];
                    solids[i].include(solids[2 * i + 1]);
                }
                solids.resize(kMostSolids / 2);
                merged_ *= 2;
            }
            solids.emplace_back();
            in_last_ = 0;
        }
        solids.back().include(box);
        ++in_last_;
    }

    const Scene& scene_;
    ShadowCasters out_;
    std::size_t merged_ = 1, in_last_ = 0;  // boxes in each solid, and in the last one
};

}  // namespace

std::vector<Bounds> ShadowCasters::of_light(Vec3d position, bool directional) const {
    std::vector<Bounds> boxes = solids;
    for (const FlatCaster& plane : planes) {
        if (!plane.casts) continue;
        const double side = dot(plane.normal, position) - (directional ? 0.0 : plane.offset);
        const double edge_on = directional ? 1e-6 : plane.slack;
        const bool nothing_behind = side > edge_on ? plane.lowest >= -plane.slack : side < -edge_on && plane.highest <= plane.slack;
        if (!nothing_behind) boxes.push_back(plane.box);
    }
    return boxes;
}

ShadowCasters collect_shadow_casters(const Scene& scene, std::span<const PreparedMesh> meshes, std::span<const Bounds> boxes) {
    Collector collector(scene);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const auto mesh = static_cast<std::size_t>(scene.instances[i].mesh);
        if (!scene.meshes[mesh].indices.empty()) collector.add(scene.instances[i], scene.meshes[mesh], meshes[mesh], boxes[i]);
    }
    return collector.finish();
}

}  // namespace halflit::raster
