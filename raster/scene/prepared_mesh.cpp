#include "raster/scene/prepared_mesh.hpp"

#include "raster/detail/executor.hpp"
#include "raster/detail/view_math.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace halflit::raster {
namespace {

constexpr std::size_t kClustersPerTask = 64;

/// kNormalError: bound on the error of a normal in float32. Holds if the sine of the angle at the first corner is above kThinnest.
constexpr float kNormalError = 2e-3f, kThinnest = 1e-3f;

/// Corners of a cluster's triangles, as arrays, so that the compiler can vectorise over triangles.
struct Corners {
    alignas(64) float x[3][kClusterTriangles], y[3][kClusterTriangles], z[3][kClusterTriangles];
};

/// Unit normals and altitudes, likewise. thinness: sine of the angle at the first corner. same: not 0 if two vertices are at one position.
struct Shapes {
    alignas(64) float x[kClusterTriangles], y[kClusterTriangles], z[kClusterTriangles];
    alignas(64) float altitude[kClusterTriangles], thinness[kClusterTriangles];
    alignas(64) std::int32_t same[kClusterTriangles];
};

void measure(const Corners& at, std::uint32_t count, Shapes& out) {
    for (std::uint32_t i = 0; i < count; ++i) {
        const float ax = at.x[1][i] - at.x[0][i], ay = at.y[1][i] - at.y[0][i], az = at.z[1][i] - at.z[0][i];
        const float bx = at.x[2][i] - at.x[0][i], by = at.y[2][i] - at.y[0][i], bz = at.z[2][i] - at.z[0][i];
        const float cx = at.x[2][i] - at.x[1][i], cy = at.y[2][i] - at.y[1][i], cz = at.z[2][i] - at.z[1][i];
        const float nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
        const float aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz, cc = cx * cx + cy * cy + cz * cz;
        const float area = __builtin_sqrtf(nx * nx + ny * ny + nz * nz);
        float longest = aa > bb ? aa : bb;
        longest = longest > cc ? longest : cc;
        const float over_area = 1.0f / (area > 1e-37f ? area : 1e-37f);
        out.x[i] = nx * over_area, out.y[i] = ny * over_area, out.z[i] = nz * over_area;
        out.altitude[i] = area / (__builtin_sqrtf(longest) + 1e-37f);
        // 0 where squares come near float32's limits.
        out.thinness[i] = area > 1e-17f && area < 1e17f ? area / (__builtin_sqrtf(aa) * __builtin_sqrtf(bb)) : 0.0f;
        const bool ab = ax == 0.0f && ay == 0.0f && az == 0.0f, ac = bx == 0.0f && by == 0.0f && bz == 0.0f;
        const bool bc = cx == 0.0f && cy == 0.0f && cz == 0.0f;
        out.same[i] = (ab || ac || bc) ? -1 : 0;
    }
}

bool all_finite(const Corners& at, std::uint32_t count) {
    std::int32_t odd = 0;
    for (const auto* const axis : {&at.x, &at.y, &at.z})
        for (const auto& corner : *axis)
            for (std::uint32_t i = 0; i < count; ++i) odd |= static_cast<std::int32_t>(!(corner[i] - corner[i] == 0.0f));
    return odd == 0;
}

/// True if a triangle is flat as FlatFaces has it.
bool has_flat(const Corners& at, std::uint32_t count) {
    std::int32_t flat = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        float extent[3];
        const float(*const axes[3])[kClusterTriangles] = {at.x, at.y, at.z};
        for (int k = 0; k < 3; ++k) {
            const float a = axes[k][0][i], b = axes[k][1][i], c = axes[k][2][i];
            const float low = a < b ? a : b, high = a < b ? b : a;
            extent[k] = (high < c ? c : high) - (c < low ? c : low);
        }
        float size = extent[0] < extent[1] ? extent[1] : extent[0];
        size = 1e-6f * (size < extent[2] ? extent[2] : size);
        flat |= static_cast<std::int32_t>(extent[0] <= size) | static_cast<std::int32_t>(extent[1] <= size) |
                static_cast<std::int32_t>(extent[2] <= size);
    }
    return flat != 0;
}

/// The box of finite corners; count > 0. As Bounds::add has it.
Bounds box_of(const Corners& at, std::uint32_t count) {
    Bounds box;
    box.add({at.x[0][0], at.y[0][0], at.z[0][0]});
    Vec3f low = box.min, high = box.max;
    for (int k = 0; k < 3; ++k)
        for (std::uint32_t i = 0; i < count; ++i) {
            const float x = at.x[k][i], y = at.y[k][i], z = at.z[k][i];
            low = {x < low.x ? x : low.x, y < low.y ? y : low.y, z < low.z ? z : low.z};
            high = {x > high.x ? x : high.x, y > high.y ? y : high.y, z > high.z ? z : high.z};
        }
    box.min = low, box.max = high;
    return box;
}

/// Sets the cone around the mean normal, and the least altitude.
void set_cone(const Shapes& shapes, std::uint32_t count, Cluster& cluster) {
    cluster.cone_sine = 2.0f;
    cluster.cone_cosine = -1.0f;
    cluster.cone_axis[0] = cluster.cone_axis[1] = cluster.cone_axis[2] = 0.0f;
    cluster.least_altitude = 0.0f;
    Vec3d sum{};
    float altitude = 3e38f, thinness = 1.0f;
    bool any = false;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (shapes.same[i] != 0) continue;
        any = true;
        sum = sum + Vec3d{shapes.x[i], shapes.y[i], shapes.z[i]};
        altitude = std::min(altitude, shapes.altitude[i]);
        thinness = std::min(thinness, shapes.thinness[i]);
    }
    const double size = length(sum);
    // Values that are not finite and triangles without area fail these comparisons.
    if (!any || !(size > 1e-3) || !(size < 1e6) || !(thinness > kThinnest)) return;
    const Vec3f axis{static_cast<float>(sum.x / size), static_cast<float>(sum.y / size), static_cast<float>(sum.z / size)};
    float cosine = 1.0f;
    for (std::uint32_t i = 0; i < count; ++i)
        if (shapes.same[i] == 0) cosine = std::min(cosine, dot(axis, Vec3f{shapes.x[i], shapes.y[i], shapes.z[i]}));
    cosine -= kNormalError;
    if (!(cosine > 0.0f)) return;
    cluster.cone_axis[0] = axis.x, cluster.cone_axis[1] = axis.y, cluster.cone_axis[2] = axis.z;
    cluster.cone_cosine = cosine;
    cluster.cone_sine = __builtin_sqrtf(std::max(0.0f, 1.0f - cosine * cosine)) * 1.0001f;
    cluster.least_altitude = altitude * 0.999f;
}

/// Builds a run of consecutive clusters; one per task.
class ClusterRun {
public:
    /// stamp: 0 at first, then shared by runs of the same mesh that follow each other.
    ClusterRun(const Mesh& mesh, std::vector<std::uint32_t>& stamp) : mesh_(mesh), stamp_(stamp) {
        stamp_.resize((mesh.positions.size() + kVertexGroup - 1) / kVertexGroup, 0);
    }

    /// Returns false if an index is out of range. Cluster::first_group counts from the run's first group.
    bool build(std::size_t begin, std::size_t end, Cluster* clusters) {
        for (std::size_t c = begin; c < end; ++c)
            if (!build(c, clusters[c])) return false;
        return true;
    }
    [[nodiscard]] const std::vector<std::uint32_t>& groups() const { return groups_; }

private:
    bool build(std::size_t number, Cluster& cluster) {
        const auto [first, last] = indices_of_cluster(mesh_, number);
        const auto count = static_cast<std::uint32_t>((last - first) / 3);
        const std::uint32_t* index = mesh_.indices.data() + first;
        std::uint32_t largest = 0;
        for (std::uint32_t i = 0; i < 3 * count; ++i) largest = std::max(largest, index[i]);
        if (largest >= mesh_.positions.size()) return false;
        const auto mark = static_cast<std::uint32_t>(number + 1);
        cluster.first_group = static_cast<std::uint32_t>(groups_.size());
        Bounds box;
        for (std::uint32_t i = 0; i < count; ++i) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t v = index[3 * i + k];
                const Vec3f p = mesh_.positions[v];
                corners_.x[k][i] = p.x, corners_.y[k][i] = p.y, corners_.z[k][i] = p.z;
                if (stamp_[v / kVertexGroup] == mark) continue;
                stamp_[v / kVertexGroup] = mark;
                groups_.push_back(v / kVertexGroup);
            }
        }
        cluster.finite = all_finite(corners_, count);
        if (cluster.finite && count > 0)
            box = box_of(corners_, count);
        else
            for (std::size_t i = first; i < last; ++i) box.add(mesh_.positions[mesh_.indices[i]]);
        if (box.empty) box.min = {1, 1, 1}, box.max = {-1, -1, -1};
        cluster.min[0] = box.min.x, cluster.min[1] = box.min.y, cluster.min[2] = box.min.z;
        cluster.max[0] = box.max.x, cluster.max[1] = box.max.y, cluster.max[2] = box.max.z;
        cluster.flat = has_flat(corners_, count);
        measure(corners_, count, shapes_);
        set_cone(shapes_, count, cluster);
        return true;
    }

    const Mesh& mesh_;
    std::vector<std::uint32_t>& stamp_;  // per group: 1 + number of the last cluster that reads it
    std::vector<std::uint32_t> groups_;
    Corners corners_;
    Shapes shapes_;
};

/// Largest of components(value) over all values, and not below `least`. NaN is ignored.
template <class T, class Components>
float largest_of(const std::vector<T>& values, float least, const Components& components) {
    float largest = least;
    for (const T& value : values) {
        const float magnitude = components(value);
        largest = magnitude > largest ? magnitude : largest;
    }
    return largest;
}

/// Sets what follows from the clusters.
void sum_up_clusters(PreparedMesh& prepared) {
    const std::size_t count = prepared.cluster_count();
    prepared.superclusters.resize((count + kSuperclusterSize - 1) / kSuperclusterSize);
    for (std::size_t c = 0; c < count; ++c) {
        const Cluster& cluster = prepared.clusters[c];
        prepared.finite &= cluster.finite;
        if (cluster.min[0] > cluster.max[0]) continue;
        Bounds& box = prepared.superclusters[c / kSuperclusterSize];
        box.add(Vec3f{cluster.min[0], cluster.min[1], cluster.min[2]});
        box.add(Vec3f{cluster.max[0], cluster.max[1], cluster.max[2]});
    }
    for (const Bounds& box : prepared.superclusters) prepared.bounds.include(box);
}

template <class T>
std::vector<T> at_indices(const std::vector<T>& values, const std::vector<std::uint32_t>& indices) {
    std::vector<T> spread;
    if (values.empty()) return spread;
    spread.reserve(indices.size());
    for (const std::uint32_t index : indices) spread.push_back(values[index]);
    return spread;
}

/// Copy of a mesh with vertices of its own for each primitive. Requires: indices in range.
Mesh with_own_vertices(const Mesh& mesh) {
    Mesh out;
    out.topology = mesh.topology;
    out.material = mesh.material;
    out.splats = mesh.splats;
    out.positions = at_indices(mesh.positions, mesh.indices);
    out.normals = at_indices(mesh.normals, mesh.indices);
    out.tangents = at_indices(mesh.tangents, mesh.indices);
    out.uv0 = at_indices(mesh.uv0, mesh.indices);
    out.uv1 = at_indices(mesh.uv1, mesh.indices);
    out.colors = at_indices(mesh.colors, mesh.indices);
    out.indices.resize(mesh.indices.size());
    std::iota(out.indices.begin(), out.indices.end(), 0u);
    return out;
}

/// Clusters of lines or points. As vertex i belongs to primitive i / 2 or i, a cluster reads two vertex groups or one, in order. Returns
/// false if an index is out of range.
bool prepare_quads(const Mesh& mesh, PreparedMesh& prepared) {
    bool in_order = mesh.indices.size() == mesh.positions.size();
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        if (mesh.indices[i] >= mesh.positions.size()) return false;
        in_order &= mesh.indices[i] == i;
    }
    if (!in_order) prepared.unshared = std::make_shared<const Mesh>(with_own_vertices(mesh));
    const std::size_t count = (triangle_count(mesh) + kClusterTriangles - 1) / kClusterTriangles;
    prepared.clusters.resize(count + 1);
    for (std::size_t c = 0; c < count; ++c) {
        Cluster& cluster = prepared.clusters[c];
        cluster = {};
        cluster.cone_sine = 2.0f;
        cluster.cone_cosine = -1.0f;
        cluster.finite = true;
        cluster.first_group = static_cast<std::uint32_t>(prepared.vertex_groups.size());
        const auto [begin, end] = indices_of_cluster(mesh, c);
        Bounds box;
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3f p = mesh.positions[mesh.indices[i]];
            box.add(p);
            cluster.finite &= finite(p);
            if (i % kVertexGroup == 0) prepared.vertex_groups.push_back(static_cast<std::uint32_t>(i / kVertexGroup));
        }
        if (box.empty) box.min = {1, 1, 1}, box.max = {-1, -1, -1};
        cluster.min[0] = box.min.x, cluster.min[1] = box.min.y, cluster.min[2] = box.min.z;
        cluster.max[0] = box.max.x, cluster.max[1] = box.max.y, cluster.max[2] = box.max.z;
    }
    prepared.clusters[count] = {};
    prepared.clusters[count].first_group = static_cast<std::uint32_t>(prepared.vertex_groups.size());
    sum_up_clusters(prepared);
    return true;
}

/// The squares of the spherical harmonics of a direction have the sum count / 4 pi [Sloan08]: it bounds a colour by Cauchy and Schwarz.
double largest_color_of(const Splats& splats) {
    const auto count = static_cast<std::size_t>((splats.degree + 1) * (splats.degree + 1));
    float largest = 0.0f;
    TimeCheck check;
    for (std::size_t i = 0; i < splats.opacities.size(); ++i) {
        check();
        const float* const c = splats.harmonics.data() + 3 * count * i;
        float red = 0.0f, green = 0.0f, blue = 0.0f;
        for (std::size_t k = 0; k < 3 * count; k += 3) red += c[k] * c[k], green += c[k + 1] * c[k + 1], blue += c[k + 2] * c[k + 2];
        largest = std::max({largest, red, green, blue});
    }
    constexpr double kPerCoefficient = 0.079577471545947673, kMost = 1e6;  // 1 / 4 pi; the kernels hold colours at kMost
    return std::clamp(0.5 + 1.001 * std::sqrt(kPerCoefficient * static_cast<double>(count) * static_cast<double>(largest)), 1.0, kMost);
}

const char* what_is_wrong(const Mesh& mesh) {
    const std::size_t n = mesh.positions.size();
    if (mesh.topology > Topology::points) return "topology: found a value that no name stands for";
    if (mesh.splats != nullptr) {
        const Splats& s = *mesh.splats;
        if (mesh.topology != Topology::points) return "splats: expected a mesh of points";
        if (s.degree < 0 || s.degree > 4) return "splats: expected a degree from 0 to 4";
        const auto coefficients = harmonics_per_splat(s.degree);
        const std::size_t count = s.opacities.size();
        if (count > n || s.rotations.size() != count || s.scales.size() != count || s.harmonics.size() != coefficients * count)
            return "splats: an array is not as long as the opacities require, or there are fewer positions";
    }
    if (mesh.topology == Topology::triangles && mesh.indices.size() % 3 != 0) return "the number of indices is not a multiple of three";
    if (mesh.topology == Topology::lines && mesh.indices.size() % 2 != 0) return "the number of indices of lines is not a multiple of two";
    const auto fits = [n](std::size_t size) { return size == 0 || size == n; };
    if (!fits(mesh.normals.size()) || !fits(mesh.tangents.size()) || !fits(mesh.uv0.size()) || !fits(mesh.uv1.size()) ||
        !fits(mesh.colors.size()))
        return "an attribute array is not as long as the positions";
    return nullptr;
}

}  // namespace

Result<PreparedMesh> prepare_mesh(const Mesh& mesh, Executor& executor) {
    if (const char* wrong = what_is_wrong(mesh)) return fail(ErrorCode::bad_input, wrong);
    PreparedMesh prepared;
    prepared.largest_color = largest_of(mesh.colors, 1.0f, [](Vec4f c) { return std::max({c.x, c.y, c.z}); });
    if (mesh.splats != nullptr) prepared.largest_splat_color = largest_color_of(*mesh.splats);
    if (mesh.indices.empty()) return prepared;
    if (mesh.topology != Topology::triangles) {
        if (!prepare_quads(mesh, prepared)) return fail(ErrorCode::bad_input, "an index is not below the number of vertices");
        return prepared;
    }

    const std::size_t count = (mesh.indices.size() / 3 + kClusterTriangles - 1) / kClusterTriangles;
    prepared.clusters.resize(count + 1);
    const std::size_t tasks = (count + kClustersPerTask - 1) / kClustersPerTask;
    std::vector<std::vector<std::uint32_t>> groups(tasks);
    Pool<std::vector<std::uint32_t>> stamps;
    std::atomic<bool> out_of_range{false};
    executor.run(static_cast<int>(tasks), [&](int task) {
        const std::size_t begin = static_cast<std::size_t>(task) * kClustersPerTask;
        Pool<std::vector<std::uint32_t>>::Loan stamp(stamps);
        ClusterRun run(mesh, *stamp);
        if (!run.build(begin, std::min(begin + kClustersPerTask, count), prepared.clusters.data())) out_of_range = true;
        groups[static_cast<std::size_t>(task)] = run.groups();
    });
    if (out_of_range) return fail(ErrorCode::bad_input, "an index is not below the number of vertices");

    std::size_t group_count = 0;
    for (const auto& list : groups) group_count += list.size();
    prepared.vertex_groups.reserve(group_count);
    for (std::size_t task = 0; task < tasks; ++task) {
        const auto base = static_cast<std::uint32_t>(prepared.vertex_groups.size());
        for (std::size_t c = task * kClustersPerTask; c < std::min((task + 1) * kClustersPerTask, count); ++c)
            prepared.clusters[c].first_group += base;
        prepared.vertex_groups.insert(prepared.vertex_groups.end(), groups[task].begin(), groups[task].end());
    }
    prepared.clusters[count] = {};
    prepared.clusters[count].first_group = static_cast<std::uint32_t>(prepared.vertex_groups.size());
    sum_up_clusters(prepared);
    prepared.faces = find_flat_faces(mesh, std::span(prepared.clusters).first(count));
    prepared.few_vertices = 2 * mesh.positions.size() < mesh.indices.size();
    return prepared;
}

}  // namespace halflit::raster
