#include "raster/view/filled_voxels.hpp"

#include "raster/scene/framed_part.hpp"
#include "raster/scene/instance_material.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::raster {
namespace {

constexpr int kMostVoxels = 64;   ///< on a side: bits of a word
constexpr double kSpacing = 0.6;  ///< between points that mark a triangle's voxels, voxels
constexpr double kPhase = 0.38;   ///< of the voxels' borders, so that round coordinates, which are rounded in many ways, are none

/// Points that are marked before large triangles count by their corners alone: a second or so. A scene of a million triangles that each
/// fill the grid has 40 times as many.
constexpr std::uint64_t kMostMarks = std::uint64_t{1} << 28, kBetweenLooks = std::uint64_t{1} << 20, kUnitsAMark = 4;

class Marker {
public:
    explicit Marker(FilledVoxels& voxels) : voxels_(voxels) {}

    /// In voxels, from the first one's corner.
    [[nodiscard]] Vec3d place(Vec3f p) const {
        const double(&origin)[3] = voxels_.origin, scale = voxels_.per_length;
        return {(double{p.x} - origin[0]) * scale, (double{p.y} - origin[1]) * scale, (double{p.z} - origin[2]) * scale};
    }
    void mark(Vec3d p) {
        ++marks_;
        // Comparisons are false for what is not a number.
        const int(&size)[3] = voxels_.size;
        if (!(p.x >= 0.0 && p.x < size[0] && p.y >= 0.0 && p.y < size[1] && p.z >= 0.0 && p.z < size[2])) return;
        voxels_.bits.row(static_cast<int>(p.z), static_cast<int>(p.y)) |= BitGrid::Word{1} << static_cast<int>(p.x);
    }
    void mark(Vec3d a, Vec3d b, Vec3d c) {
        if (marks_ >= next_look_) {
            check_time();
            charge_work(kUnitsAMark * kBetweenLooks);
            next_look_ = marks_ + kBetweenLooks;
        }
        const Vec3d ab = b - a, bc = c - b, ca = a - c;
        const double longest = std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)});
        mark(a);
        if (!(longest > kSpacing * kSpacing)) return;
        mark(b), mark(c);
        if (!(longest < 1e18) || marks_ > kMostMarks) return;
        // Rows along the longest side, from it to the third corner.
        Vec3d from = a, to = b, third = c;
        if (longest == dot(bc, bc))
            from = b, to = c, third = a;
        else if (longest == dot(ca, ca))
            from = c, to = a, third = b;
        const Vec3d across = cross(to - from, third - from);
        const double height = std::sqrt(dot(across, across) / longest);
        const int rows = steps(height);
        for (int r = 0; r <= rows; ++r) {
            const double up = static_cast<double>(r) / rows;
            const Vec3d begin = from + (third - from) * up, side = (to + (third - to) * up) - begin;
            mark_line(begin, side);
        }
    }

private:
    [[nodiscard]] static int steps(double length) { return static_cast<int>(std::min(std::ceil(length / kSpacing), 1e6)) | 1; }
    /// Only the part within the grid, as a triangle may reach far beyond it.
    void mark_line(Vec3d begin, Vec3d side) {
        double first = 0.0, last = 1.0;
        const double at[3] = {begin.x, begin.y, begin.z}, along[3] = {side.x, side.y, side.z};
        for (int axis = 0; axis < 3; ++axis) {
            const double to_low = -at[axis], to_high = voxels_.size[axis] - at[axis];
            if (along[axis] == 0.0) {
                if (to_low > 0.0 || to_high < 0.0) return;
                continue;
            }
            const double one = to_low / along[axis], other = to_high / along[axis];
            first = std::max(first, std::min(one, other));
            last = std::min(last, std::max(one, other));
        }
        if (!(first <= last)) return;
        const int count = steps(length(side) * (last - first));
        for (int k = 0; k <= count; ++k) mark(begin + side * (first + (last - first) * (static_cast<double>(k) / count)));
    }

    FilledVoxels& voxels_;
    std::uint64_t marks_ = 0, next_look_ = kBetweenLooks;
};

bool hides(const Scene& scene, const Instance& instance) {
    if (!counts_for_views(scene, instance)) return false;
    const Material* const material = material_of(scene, instance);
    return material == nullptr || (material->alpha_mode == AlphaMode::opaque && !material->is_layer());
}

void mark_all(const PreparedData& prepared, Marker& marker) {
    TimeCheck check;
    constexpr std::size_t kMostKept = std::size_t{1} << 18;  // vertices; more would take much memory
    const Scene& scene = prepared.scene();
    std::vector<Vec3d> places;
    for (const Instance& instance : scene.instances) {
        if (!hides(scene, instance)) continue;
        const Mesh& mesh = prepared.source_mesh(instance.mesh);
        if (mesh.topology != Topology::triangles) continue;
        const auto place = [&](std::size_t vertex) {
            return marker.place(transform_point(instance.world_from_object, mesh.positions[vertex]));
        };
        const bool kept = mesh.positions.size() <= kMostKept && mesh.positions.size() < mesh.indices.size();
        places.clear();
        for (std::size_t v = 0; kept && v < mesh.positions.size(); ++v) places.push_back(place(v));
        const auto corner = [&](std::size_t i) { return kept ? places[mesh.indices[i]] : place(mesh.indices[i]); };
        for (std::size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) {
            check();
            marker.mark(corner(i), corner(i + 1), corner(i + 2));
        }
    }
}

/// The next one of 1, 1.25, 1.5 and 1.75 times the powers of 2.
double rounded_up(double x) {
    int exponent = 0;
    const double part = std::frexp(x, &exponent);  // 0.5 to 1
    return std::ldexp(std::ceil(part * 8.0) / 8.0, exponent);
}

FilledVoxels filled_voxels(const PreparedData& scene) {
    FilledVoxels voxels;
    const Bounds bounds = main_bounds(scene.scene(), scene.framed_bounds());
    if (bounds.empty) return voxels;
    const Vec3d low = to_double(bounds.min), high = to_double(bounds.max), side = high - low, middle = (low + high) * 0.5;
    const double longest = std::max({side.x, side.y, side.z});
    if (!(longest > 1e-6 * length(middle) && longest > 1e-18 && longest < 1e18)) return voxels;
    const double voxel = rounded_up(longest / (kMostVoxels - 2 * kFreeVoxels - 1));
    voxels.per_length = 1.0 / voxel;
    voxels.lowest = low.y;
    const double lows[3] = {low.x, low.y, low.z}, highs[3] = {high.x, high.y, high.z};
    for (int axis = 0; axis < 3; ++axis) {
        const double first = std::floor(lows[axis] / voxel - kPhase) - kFreeVoxels,
                     last = std::floor(highs[axis] / voxel - kPhase) + kFreeVoxels;
        voxels.origin[axis] = (first + kPhase) * voxel;
        voxels.size[axis] = std::min(kMostVoxels, static_cast<int>(last - first) + 1);
    }
    voxels.bits = {voxels.size[2], voxels.size[1]};
    Marker marker(voxels);
    mark_all(scene, marker);
    return voxels;
}

}  // namespace

void fill_voxels(const PreparedData& scene, FilledVoxels& voxels) {
    SceneRevision revision = scene.revision();
    revision.lights = 0;
    if (voxels.revision == revision) return;
    voxels = filled_voxels(scene);
    voxels.revision = revision;
}

}  // namespace halflit::raster
