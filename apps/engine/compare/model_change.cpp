#include "apps/engine/compare/model_change.hpp"

#include "apps/io/files/in_parts.hpp"
#include "raster/scene/instance_material.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace halflit::engine {
namespace {

constexpr double kSameMeasure = 1e-5;  // relative: areas of another triangulation differ by rounding
constexpr double kNoDistance = 1e-9;   // of the diagonal: rounding of double, far below that of float32 positions

bool same_measure(double a, double b) { return absolute(a - b) <= kSameMeasure * std::max(absolute(a), absolute(b)); }

/// up: of the files' axes that lengths are along.
ModelNumbers numbers_of(const RenderJob& job, const Measures& measures, double scale, UpAxis up) {
    ModelNumbers out;
    out.size = absolute(turned_back(measures.size(), up)) * (1.0 / scale);
    out.area = measures.area / (scale * scale);
    out.volume = measures.watertight ? measures.volume / ((scale * scale) * scale) : 0.0;
    out.triangles = measures.triangles, out.bodies = measures.bodies;
    out.open_edges = measures.open_edges, out.flipped_edges = measures.flipped_edges, out.crowded_edges = measures.crowded_edges;
    out.watertight = measures.watertight;
    const Scene& scene = job.scene();
    out.parts = job.source.parts->list().size(), out.instances = scene.instances.size();
    out.materials = scene.materials.size(), out.textures = scene.textures.size();
    for (const Instance& instance : scene.instances) {
        if (!raster::counts_for_views(scene, instance)) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (is_cloud(mesh)) out.points += mesh.indices.size();
        if (mesh.topology == Topology::lines) out.lines += mesh.indices.size() / 2;
    }
    return out;
}

/// A part that has triangles, with the measures that tell it from others.
struct MeasuredPart {
    std::string name;
    Measures measures;
};

/// whole: measures of all visible instances.
Result<std::vector<MeasuredPart>> measured_parts(const RenderJob& job, const Measures& whole) {
    const Scene& scene = job.scene();
    const bool is_one =
        std::count_if(scene.instances.begin(), scene.instances.end(), [](const Instance& instance) { return instance.visible; }) == 1;
    std::vector<MeasuredPart> out;
    for (const Part& part : job.source.parts->list()) {
        check_time();
        std::vector<int> seen;
        for (const int instance : part.instances)
            if (raster::counts_for_views(scene, scene.instances[static_cast<std::size_t>(instance)])) seen.push_back(instance);
        if (seen.empty()) continue;
        const auto measures = is_one ? Result<Measures>(whole) : measure_geometry(scene, seen);
        if (!measures) return tl::unexpected(measures.error());
        if (measures->triangles > 0) out.push_back({part.name, *measures});
    }
    return out;
}

/// Measures of one model alone.
struct MeasuredModel {
    Result<Measures> whole;
    Result<std::vector<MeasuredPart>> parts;
    std::optional<Surface> surface;  ///< empty: not asked for, or the model could not be measured
};

MeasuredModel measured_model(const RenderJob& job, bool with_surface) {
    MeasuredModel out{measure_geometry(job.scene()), {}, {}};
    if (!out.whole) return out;
    out.parts = measured_parts(job, *out.whole);
    if (with_surface) out.surface.emplace(job.scene());
    return out;
}

/// Calls work(0) and work(1), side by side if the job may have two threads.
template <class Work>
void for_both(const RenderJob& job, const Work& work) {
    io::detail::in_parts(2, io::detail::parts_of(2, 1, job.execution.threads), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) work(i);
    });
}

/// Compares a pair that has one name. tolerance: in the drawn world.
std::optional<PartChange> change_of(const Measures& a, const Measures& b, double tolerance) {
    const auto apart = [&](Vec3d p, Vec3d q) { return length(p - q) > tolerance; };
    const bool same_shape = same_measure(a.area, b.area) && a.watertight == b.watertight && a.bodies == b.bodies &&
                            a.open_edges == b.open_edges && a.flipped_edges == b.flipped_edges &&
                            (!a.watertight || same_measure(a.volume, b.volume));
    if (!same_shape) return PartChange::geometry;
    if (!apart(a.min, b.min) && !apart(a.max, b.max) && !apart(a.center, b.center)) return std::nullopt;
    // Where it moved as a whole, its box and its centre moved alike; a turned part has another box.
    const Vec3d shift = b.center - a.center;
    return apart(a.min + shift, b.min) || apart(a.max + shift, b.max) ? PartChange::geometry : PartChange::moved;
}

/// Pairs parts by their names, and those of one name in their order. A single part has no need of a name.
std::vector<ChangedPart> changed_parts(const std::vector<MeasuredPart>& a, const std::vector<MeasuredPart>& b, double tolerance,
                                       double scale, UpAxis up) {
    std::vector<ChangedPart> out;
    const bool single = a.size() == 1 && b.size() == 1;
    std::map<std::string, std::vector<std::size_t>> named;
    for (std::size_t i = b.size(); i-- > 0;) named[single ? "" : b[i].name].push_back(i);
    for (const MeasuredPart& part : a) {
        std::vector<std::size_t>& places = named[single ? "" : part.name];
        if (places.empty()) {
            out.push_back({part.name, PartChange::removed, {}});
            continue;
        }
        const Measures& now = b[places.back()].measures;
        places.pop_back();
        if (const auto change = change_of(part.measures, now, tolerance))
            out.push_back({part.name, *change, turned_back(now.center - part.measures.center, up) * (1.0 / scale)});
    }
    for (const MeasuredPart& part : b) {
        std::vector<std::size_t>& places = named[single ? "" : part.name];
        if (places.empty() || &b[places.back()] != &part) continue;
        places.pop_back();
        out.push_back({part.name, PartChange::added, {}});
    }
    return out;
}

std::uint64_t drawn_triangles(const Scene& scene) {
    std::uint64_t sum = 0;
    for (const Instance& instance : scene.instances)
        if (raster::counts_for_views(scene, instance)) sum += triangles_of(scene.meshes[static_cast<std::size_t>(instance.mesh)]);
    return sum;
}

FarthestPoint in_file(const ModelPair& pair, FarthestPoint found) {
    if (found.at_least <= kNoDistance * pair.diagonal()) found.at_least = 0.0;
    if (found.at_most <= kNoDistance * pair.diagonal()) found.at_most = 0.0;
    found.at_least /= pair.scale(), found.at_most /= pair.scale();
    found.point = pair.out(found.point);
    return found;
}

std::optional<SurfaceDistance> distance_between(const ModelPair& pair, const Surface& a, const Surface& b) {
    if (a.empty() || b.empty()) return std::nullopt;
    const double accuracy = kDistanceAccuracy * pair.diagonal();
    FarthestPoint found[2];
    for_both(pair.a, [&](std::size_t i) { found[i] = i == 0 ? farthest_point(a, b, accuracy) : farthest_point(b, a, accuracy); });
    return SurfaceDistance{in_file(pair, found[0]), in_file(pair, found[1])};
}

}  // namespace

double SurfaceDistance::at_least() const { return std::max(from_a.at_least, from_b.at_least); }
double SurfaceDistance::at_most() const { return std::max(from_a.at_most, from_b.at_most); }

bool ModelChange::differs() const {
    const auto apart = [&](double x, double y) { return absolute(x - y) > 2.0 * tolerance; };
    return !parts.empty() || (distance && distance->at_least() > tolerance) || !same_measure(a.area, b.area) ||
           !same_measure(a.volume, b.volume) || apart(a.size.x, b.size.x) || apart(a.size.y, b.size.y) || apart(a.size.z, b.size.z) ||
           a.watertight != b.watertight || a.bodies != b.bodies || a.open_edges != b.open_edges || a.flipped_edges != b.flipped_edges ||
           a.points != b.points || a.lines != b.lines;
}

SeenTriangles::SeenTriangles(const Scene& scene) : scene_(scene), seen_(scene.instances.size()) {
    for (std::size_t i = 0; i < seen_.size(); ++i)
        if (raster::counts_for_views(scene, scene.instances[i]))
            seen_[i].assign(triangles_of(scene.meshes[static_cast<std::size_t>(scene.instances[i].mesh)]), false);
}

void SeenTriangles::add(const std::vector<std::uint32_t>& instance, const std::vector<std::uint32_t>& triangle) {
    for (std::size_t i = 0; i < instance.size(); ++i) {
        if (instance[i] == 0 || triangle[i] == 0 || instance[i] > seen_.size()) continue;
        std::vector<bool>& seen = seen_[instance[i] - 1];
        if (triangle[i] <= seen.size()) seen[triangle[i] - 1] = true;
    }
}

std::optional<double> SeenTriangles::unseen_area() const {
    double all = 0.0, unseen = 0.0;
    TimeCheck check;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
        if (seen_[i].empty()) continue;
        const Instance& instance = scene_.instances[i];
        const Mesh& mesh = scene_.meshes[static_cast<std::size_t>(instance.mesh)];
        const Mat4& m = instance.world_from_object;
        const Vec3d x = axis(m, 0), y = axis(m, 1), z = axis(m, 2);
        const auto turned = [&](Vec3d v) { return (x * v.x + y * v.y) + z * v.z; };
        for (std::size_t t = 0; t < seen_[i].size(); ++t) {
            check();
            const auto corner = [&](std::size_t k) { return to_double(mesh.positions[mesh.indices[3 * t + k]]); };
            const Vec3d a = corner(0), across = cross(turned(corner(1) - a), turned(corner(2) - a));
            const double area = 0.5 * std::sqrt(dot(across, across));
            if (!std::isfinite(area)) continue;
            all += area;
            if (!seen_[i][t]) unseen += area;
        }
    }
    return all > 0.0 ? std::optional(unseen / all) : std::nullopt;
}

Result<ModelChange> compare_models(const ModelPair& pair) {
    ModelChange out;
    const double scale = pair.scale();
    out.tolerance = kSameShare * pair.diagonal() / scale;
    out.too_many = std::max(drawn_triangles(pair.a.scene()), drawn_triangles(pair.b.scene())) > kMostComparedTriangles;
    std::optional<MeasuredModel> measured[2];
    for_both(pair.a, [&](std::size_t i) { measured[i] = measured_model(i == 0 ? pair.a : pair.b, !out.too_many); });
    const MeasuredModel &a = *measured[0], &b = *measured[1];
    for (const MeasuredModel* const model : {&a, &b}) {
        if (!model->whole) return tl::unexpected(model->whole.error());
        if (!model->parts) return tl::unexpected(model->parts.error());
    }
    const UpAxis up = pair.a.source.placement.up;
    out.a = numbers_of(pair.a, *a.whole, scale, up), out.b = numbers_of(pair.b, *b.whole, scale, up);
    out.parts = changed_parts(*a.parts, *b.parts, out.tolerance * scale, scale, up);
    if (!out.too_many) out.distance = distance_between(pair, *a.surface, *b.surface);
    return out;
}

}  // namespace halflit::engine
