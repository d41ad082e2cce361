#include "raster/view/shadow_cascades.hpp"

#include "raster/scene/placed_box.hpp"
#include "shading/plan/shadow_map_plan.hpp"

#include <algorithm>
#include <optional>

namespace halflit::raster {
namespace {

/// Finds the nearest depth of boxes in view.
class NearestBox {
public:
    explicit NearestBox(const SeenVolume& seen) : seen_(seen) {}
    [[nodiscard]] double depth() const { return best_; }

    /// True if the box may hold something in view that is nearer than all before.
    [[nodiscard]] bool may_be_nearer(Vec3d low, Vec3d high) const {
        if (!(extreme(seen_.axis, low, high, -1.0) < best_)) return false;
        return std::all_of(std::begin(seen_.view), std::end(seen_.view),
                           [&](const HalfSpace& side) { return extreme(side, low, high, 1.0) >= 0.0; });
    }
    void add(Vec3d low, Vec3d high) {
        if (!may_be_nearer(low, high)) return;
        const auto holds = [&](Vec3d p) {
            return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
        };
        if (std::any_of(std::begin(seen_.near_corner), std::end(seen_.near_corner), holds)) best_ = std::min(best_, seen_.depth.low);
        const double x[2] = {low.x, high.x}, y[2] = {low.y, high.y}, z[2] = {low.z, high.z};
        for (int axis = 0; axis < 3; ++axis)
            for (int end = 0; end < 2; ++end) {
                const int first = end << axis, u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
                side_.clear();
                for (const int k : {first, first + u, first + u + v, first + v}) side_.push_back({x[k & 1], y[k >> 1 & 1], z[k >> 2]});
                for (const HalfSpace& keep : seen_.view) clip(side_, keep, scratch_);
                for (const Vec3d p : side_) best_ = std::min(best_, seen_.axis.at(p));
            }
    }

private:
    /// The largest value in the box; sign -1: the least.
    static double extreme(const HalfSpace& f, Vec3d low, Vec3d high, double sign) {
        const auto pick = [sign](double g, double a, double b) { return g * (g * sign > 0.0 ? b : a); };
        return (pick(f.normal.x, low.x, high.x) + pick(f.normal.y, low.y, high.y)) + pick(f.normal.z, low.z, high.z) + f.offset;
    }

    const SeenVolume& seen_;
    double best_ = 1e300;
    Polygon side_, scratch_;
};

Vec3d low_of(const PlacedBox& b) { return {b.low[0], b.low[1], b.low[2]}; }
Vec3d high_of(const PlacedBox& b) { return {b.high[0], b.high[1], b.high[2]}; }

/// The clusters of an instance, those of a supercluster only if its box may be nearer.
void add_clusters(const PreparedMesh& mesh, const Mat4& place, NearestBox& nearest) {
    for (std::size_t s = 0; s < mesh.superclusters.size(); ++s) {
        const Bounds& all = mesh.superclusters[s];
        const float min[3] = {all.min.x, all.min.y, all.min.z}, max[3] = {all.max.x, all.max.y, all.max.z};
        const PlacedBox box(min, max, place);
        if (!nearest.may_be_nearer(low_of(box), high_of(box))) continue;
        const std::size_t end = std::min((s + 1) * kSuperclusterSize, mesh.cluster_count());
        for (std::size_t c = s * kSuperclusterSize; c < end; ++c) {
            const PlacedBox part(mesh.clusters[c].min, mesh.clusters[c].max, place);
            nearest.add(low_of(part), high_of(part));
        }
    }
}

constexpr double kFirstReach = 2.0;    ///< the first map reaches from the nearest thing to so many times its depth, or farther
constexpr double kDepthStep = 1.25;    ///< reaches grow in such steps, as far as a window of their width shows
constexpr double kLeastOfPixel = 0.5;  ///< of a pixel at the nearest thing; finer maps show nothing more
constexpr int kLeastGain = 6;          ///< rungs: eight times finer
constexpr int kWidestStep = 6;         ///< rungs from one map to the next, as far as four maps allow: eight times

}  // namespace

double nearest_depth(const PreparedData& scene, const SeenVolume& seen) {
    NearestBox nearest(seen);
    const std::span<const Bounds> boxes = scene.instance_bounds();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Bounds& box = boxes[i];
        if (box.empty) continue;
        const Vec3d low{box.min.x, box.min.y, box.min.z}, high{box.max.x, box.max.y, box.max.z};
        if (!nearest.may_be_nearer(low, high)) continue;
        const Instance& instance = scene.scene().instances[i];
        const PreparedMesh& mesh = scene.mesh(instance.mesh);
        if (mesh.cluster_count() > 1 && mesh.finite)
            add_clusters(mesh, instance.world_from_object, nearest);
        else
            nearest.add(low, high);
    }
    return nearest.depth();
}

std::vector<double> cascade_depths(const FittedView& view, int size, const SeenVolume& seen, const std::function<double()>& nearest) {
    const double far_z = seen.depth.high;
    const std::optional<int> whole = ladder_rung(view, size, seen);
    if (!seen.perspective || !whole) return {};
    // The rung of what is seen up to the depth t. Nothing casts a shadow on the first of it: the map begins where something does.
    const auto first_rung = [&](double& t) {
        for (; t < far_z; t *= kDepthStep)
            if (const auto k = ladder_rung(view, size, up_to(seen, t))) return *k;
        return *whole;
    };
    double reach = std::max(kFirstReach * seen.depth.low, 1e-9 * far_z);
    const auto gain_from = [&](double depth) {
        int k = first_rung(reach);
        while (k > *whole && ladder_texel(view, k, size) < kLeastOfPixel * seen.pixel * depth) --k;
        return k - *whole;
    };
    if (gain_from(seen.depth.low) < kLeastGain) return {};
    const double nearest_z = nearest();
    reach = std::max(reach, kFirstReach * nearest_z);
    const int gain = gain_from(nearest_z);
    if (gain < kLeastGain) return {};
    std::vector<double> depths;
    const int count = std::min((gain + kWidestStep - 1) / kWidestStep, shading::kMostCascades - 1);
    for (int i = count; i > 0; --i) {
        const int rung = *whole + gain * i / count;
        const auto shown = [&](double t) { return ladder_rung(view, size, up_to(seen, t)).value_or(rung) >= rung; };
        while (reach * kDepthStep < far_z && shown(reach * kDepthStep)) reach *= kDepthStep;
        depths.push_back(reach);
    }
    return depths;
}

std::vector<FittedView> cascade_views(const FittedView& view, const FittedView& last, int size, const SeenVolume& seen,
                                      const std::vector<double>& depths, const Bounds& scene) {
    std::vector<FittedView> views;
    double next = last.half;
    for (std::size_t i = depths.size(); i-- > 0;) {
        FittedView finer = view;
        if (cut_view(finer, true, size, up_to(seen, depths[i]), scene) != MapUse::cut || finer.half > 0.51 * next) continue;
        next = finer.half;
        views.insert(views.begin(), finer);
    }
    return views;
}

}  // namespace halflit::raster
