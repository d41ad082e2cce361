#include "raster/scene/framed_part.hpp"

#include "raster/detail/view_math.hpp"
#include "raster/scene/closest_box.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/scene/mesh_triangles.hpp"
#include "raster/scene/placed_box.hpp"
#include "raster/scene/seen_vertices.hpp"
#include "raster/scene/shell.hpp"
#include "sh/fp_environment.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

namespace halflit::raster {
namespace {

constexpr double kLeastShare = 1.0 / 16.0;  ///< of the whole's radius, below which the rest is looked at closely
constexpr std::size_t kStrayShare = 1000;   ///< one in so many vertices may be left out
constexpr std::size_t kManyVertices = 24;   ///< from which on a triangle, three vertices, may be
constexpr std::size_t kStrayPoints = 50;    ///< one in so many points may be left out, or so much of a surface if it lies apart
constexpr double kLeastCloud = 1.0 / 4.0;   ///< in place of kLeastShare, of points
constexpr double kFlat = 0.01;              ///< height of a ground over its width
constexpr std::size_t kMostSamples = 2048;  ///< triangles or instances that stand for all
constexpr double kWhole = 1e12;             ///< weight of the whole surface

WideBox box_at(Vec3f p) { return {{p.x, p.y, p.z}, {p.x, p.y, p.z}}; }
WideBox wide(const Bounds& b) { return {{b.min.x, b.min.y, b.min.z}, {b.max.x, b.max.y, b.max.z}}; }

std::size_t sampling_stride(const Mesh& mesh) { return triangles_of(mesh) / kMostSamples + 1; }

Vec3d area_vector(const Vec3f (&at)[3]) { return cross(to_double(at[1]) - to_double(at[0]), to_double(at[2]) - to_double(at[0])) * 0.5; }

/// Sum of what triangles cover in the three planes of the axes.
Vec3d covered_planes(const Mesh& mesh) {
    const std::size_t stride = sampling_stride(mesh);
    Vec3d sum{};
    each_triangle(mesh, stride, [&](const Vec3f(&at)[3]) { sum = sum + absolute(area_vector(at)); });
    return sum * static_cast<double>(stride);
}

/// True if what is left of some of the vertices without a share of the outermost along each axis is wider than a box of this radius: a box
/// that holds all others cannot be as small.
bool is_spread(const Mesh& mesh, const std::vector<std::uint32_t>& vertices, double share, double radius) {
    constexpr std::size_t kFew = 1024, kSome = 256;
    constexpr double kBySamples = 0.03;  // of the share
    if (vertices.size() < kFew) return false;
    std::vector<float> places[3];
    for (std::size_t i = 0; i < vertices.size(); i += vertices.size() / kSome) {
        const Vec3f p = mesh.positions[vertices[i]];
        if (finite(p)) places[0].push_back(p.x), places[1].push_back(p.y), places[2].push_back(p.z);
    }
    const auto outer = static_cast<std::ptrdiff_t>((share + kBySamples) * static_cast<double>(places[0].size()));
    if (2 * outer >= static_cast<std::ptrdiff_t>(places[0].size())) return false;
    bool spread = false;
    for (std::vector<float>& along : places) {
        const auto low = along.begin() + outer, high = along.end() - 1 - outer;
        std::nth_element(along.begin(), low, along.end());
        const double first = *low;
        std::nth_element(along.begin(), high, along.end());
        spread |= *high - first > 2.0 * radius;
    }
    return spread;
}

/// The box without a few vertices that lie far from the others.
std::optional<WideBox> box_of_most(const Mesh& mesh, const FramedVertices& framed) {
    const auto finite_count = static_cast<std::uint64_t>(
        std::count_if(framed.vertices.begin(), framed.vertices.end(), [&](std::uint32_t v) { return finite(mesh.positions[v]); }));
    if (finite_count < 8) return std::nullopt;
    TimeCheck check;
    const auto each = [&](const auto& visit) {
        for (const std::uint32_t v : framed.vertices) {
            check();
            if (finite(mesh.positions[v])) visit(box_at(mesh.positions[v]), std::uint64_t{1});
        }
    };
    // A position may be that of several vertices, one for each triangle at a corner.
    const bool is_cloud = mesh.topology == Topology::points;
    const std::uint64_t positions = std::max<std::uint64_t>(finite_count < kManyVertices ? 1 : 3,
                                                            finite_count / (is_cloud ? kStrayPoints : kStrayShare)),
                        most = std::max<std::uint64_t>(finite_count / 3, 1);
    const std::uint64_t allowed = std::min(most, 64 * positions);
    const double least = is_cloud ? kLeastCloud : kLeastShare;
    const WideBox whole = wide(framed.bounds);
    if (is_spread(mesh, framed.vertices, static_cast<double>(allowed) / static_cast<double>(finite_count), least * whole.radius()))
        return std::nullopt;
    const auto box = closest_box(each, whole, allowed, least);
    if (!box) return std::nullopt;
    std::set<std::tuple<float, float, float>> strays;
    for (const std::uint32_t v : framed.vertices) {
        const Vec3f p = mesh.positions[v];
        if (!finite(p) || box->holds(box_at(p))) continue;
        strays.emplace(p.x, p.y, p.z);
        if (strays.size() > positions) return std::nullopt;
    }
    return box;
}

/// The box that holds nearly all of the surface, if nothing else is near to it. each(visit) calls visit(box, area). It may visit a part of
/// the items that stands for all; each_of_all() visits all.
template <class Each, class EachOfAll>
std::optional<WideBox> box_of_surface(const Each& each, const EachOfAll& each_of_all, const WideBox& whole) {
    double area = 0.0;
    each([&](const WideBox&, double weight) { area += weight; });
    if (!(area > 0.0 && area < 1e300)) return std::nullopt;
    const auto weighed = [&](const auto& visit) {
        each([&](const WideBox& item, double weight) { visit(item, static_cast<std::uint64_t>(weight / area * kWhole)); });
    };
    const auto box = closest_box(weighed, whole, static_cast<std::uint64_t>(kWhole / kStrayPoints), kLeastShare);
    if (!box) return std::nullopt;
    const WideBox near = box->widened(box->radius());
    double all = 0.0, outside = 0.0;
    bool apart = true;
    each_of_all([&](const WideBox& item, double weight) {
        all += weight;
        if (box->holds(item)) return;
        outside += weight;
        apart &= !near.meets(item);
    });
    return apart && outside * kStrayPoints <= all ? box : std::nullopt;
}

std::optional<WideBox> box_of_surface(const Mesh& mesh, const FramedVertices& framed) {
    if (mesh.topology != Topology::triangles || !framed.points.empty()) return std::nullopt;
    const auto each = [&](std::size_t stride) {
        return [&mesh, stride](const auto& visit) {
            each_triangle(mesh, stride, [&](const Vec3f(&at)[3]) {
                WideBox box = box_at(at[0]);
                box.add(box_at(at[1])), box.add(box_at(at[2]));
                visit(box, length(area_vector(at)));
            });
        };
    };
    return box_of_surface(each(sampling_stride(mesh)), each(1), wide(framed.bounds));
}

FramedVertices framed_vertices(const Scene& scene, const Mesh& mesh, const Material* material, bool& whole) {
    FramedVertices seen = seen_vertices(scene, mesh, material, whole);
    if (!(seen.bounds.radius() > 0.0f)) return seen;
    auto box = box_of_most(mesh, seen);
    if (!box) box = box_of_surface(mesh, seen);
    if (!box) return seen;
    FramedVertices kept;
    const auto is_kept = [&](const Vec3f& p) { return !finite(p) || box->holds(box_at(p)); };
    for (const std::uint32_t v : seen.vertices)
        if (is_kept(mesh.positions[v])) kept.vertices.push_back(v);
    for (const Vec3f& p : seen.points)
        if (is_kept(p)) kept.points.push_back(p);
    kept.measure(mesh);
    kept.far_left_out = true;
    whole = false;
    return kept;
}

/// An instance: its box, the number of its vertices, and that of its triangles.
struct Placed {
    int instance;
    WideBox box;
    std::uint64_t vertices, triangles;
};

WideBox box_of(const std::vector<Placed>& placed) {
    WideBox box;
    for (const Placed& one : placed) box.add(one.box);
    return box;
}

/// Removes what is_out(one) is true of.
template <class Test>
void leave_out(std::vector<Placed>& placed, FramedPart& part, LeftOutFor reason, const Test& is_out) {
    std::vector<int> out;  // in order, as what is placed
    for (const Placed& one : placed)
        if (is_out(one)) out.push_back(one.instance);
    std::erase_if(part.left_out, [&](const LeftOut& piece) { return std::binary_search(out.begin(), out.end(), piece.instance); });
    for (const int instance : out) part.left_out.push_back({instance, reason});
    std::erase_if(placed, is_out);
}

bool is_ground(const Placed& ground, const WideBox& rest, std::uint64_t rest_triangles) {
    const double width = std::max(ground.box.high[0] - ground.box.low[0], ground.box.high[2] - ground.box.low[2]);
    return ground.box.high[1] - ground.box.low[1] <= kFlat * width && ground.triangles < rest_triangles &&
           ground.box.high[1] <= 0.5 * (rest.low[1] + rest.high[1]);
}

/// Leaves out grounds and shells. False: there is none.
bool leave_out_surroundings(const Scene& scene, std::vector<Placed>& placed, FramedPart& part) {
    constexpr std::size_t kMostTogether = 4;
    const WideBox whole = box_of(placed);
    std::vector<std::size_t> order(placed.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const std::size_t most = std::min(kMostTogether, placed.size());
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end(), [&](std::size_t a, std::size_t b) {
        const double of_a = placed[a].box.radius(), of_b = placed[b].box.radius();
        return of_a != of_b ? of_a > of_b : a < b;
    });
    for (std::size_t count = 1; count <= most && count < placed.size(); ++count) {
        const auto first = order.begin(), end = order.begin() + static_cast<std::ptrdiff_t>(count);
        WideBox rest;
        std::uint64_t triangles = 0;
        for (auto at = end; at != order.end(); ++at) rest.add(placed[*at].box), triangles += placed[*at].triangles;
        if (!(rest.radius() < kLeastShare * whole.radius())) continue;
        std::vector<std::pair<int, LeftOutFor>> found;
        for (auto at = first; at != end; ++at) {
            const Placed& one = placed[*at];
            if (is_ground(one, rest, triangles))
                found.emplace_back(one.instance, LeftOutFor::ground);
            else if (is_shell(scene, one.instance, one.box, rest))
                found.emplace_back(one.instance, LeftOutFor::shell);
        }
        if (found.size() < count) return false;
        for (const auto& [instance, reason] : found)
            leave_out(placed, part, reason, [&, at = instance](const Placed& one) { return one.instance == at; });
        return true;
    }
    return false;
}

/// Shares of the surface of what is placed; those of lines and points are their shares of the vertices.
std::vector<double> shares_of(const Scene& scene, const std::vector<Placed>& placed) {
    std::vector<std::optional<Vec3d>> planes(scene.meshes.size());
    std::vector<double> shares;
    double area = 0.0, vertices = 0.0;
    for (const Placed& one : placed) vertices += static_cast<double>(one.vertices);
    for (const Placed& one : placed) {
        const Instance& instance = scene.instances[static_cast<std::size_t>(one.instance)];
        const auto m = static_cast<std::size_t>(instance.mesh);
        if (!planes[m]) planes[m] = covered_planes(scene.meshes[m]);
        const Vec3d x = axis(instance.world_from_object, 0), y = axis(instance.world_from_object, 1),
                    z = axis(instance.world_from_object, 2), of = *planes[m];
        shares.push_back((of.x * length(cross(y, z)) + of.y * length(cross(z, x))) + of.z * length(cross(x, y)));
        area += shares.back();
    }
    for (std::size_t i = 0; i < placed.size(); ++i)
        shares[i] = placed[i].triangles > 0 ? area > 0.0 ? shares[i] / area : 0.0 : static_cast<double>(placed[i].vertices) / vertices;
    return shares;
}

/// The box without a little that lies far from the others.
std::optional<WideBox> box_of_most(const Scene& scene, const std::vector<Placed>& placed) {
    const WideBox whole = box_of(placed);
    std::uint64_t vertices = 0;
    for (const Placed& one : placed) vertices += one.vertices;
    const auto by_vertices = [&](const auto& visit) {
        for (const Placed& one : placed) visit(one.box, one.vertices);
    };
    if (vertices >= kManyVertices)
        if (const auto box = closest_box(by_vertices, whole, std::max<std::uint64_t>(3, vertices / kStrayShare), kLeastShare)) return box;
    const std::vector<double> shares = shares_of(scene, placed);
    const auto every = [&](std::size_t stride) {
        return [&placed, &shares, stride](const auto& visit) {
            for (std::size_t i = 0; i < placed.size(); i += stride) visit(placed[i].box, shares[i]);
        };
    };
    return box_of_surface(every(placed.size() / kMostSamples + 1), every(1), whole);
}

/// False: there are none.
bool leave_out_strays(const Scene& scene, std::vector<Placed>& placed, FramedPart& part) {
    if (placed.size() < 2) return false;
    const auto box = box_of_most(scene, placed);
    if (box) leave_out(placed, part, LeftOutFor::far, [&](const Placed& one) { return !box->holds(one.box); });
    return box.has_value();
}

/// For each mesh, the material that all its instances have; null: they differ.
std::vector<const Material*> common_materials(const Scene& scene) {
    std::vector<const Material*> materials(scene.meshes.size(), nullptr);
    std::vector<bool> met(scene.meshes.size(), false);
    for (const Instance& instance : scene.instances) {
        const auto m = static_cast<std::size_t>(instance.mesh);
        if (instance.mesh < 0 || m >= scene.meshes.size()) continue;
        const Material* const material = material_of(scene, instance);
        materials[m] = !met[m] || materials[m] == material ? material : nullptr;
        met[m] = true;
    }
    return materials;
}

}  // namespace

void FramedVertices::measure(const Mesh& mesh) {
    bounds = {};
    blocks.clear();
    TimeCheck check;
    for (std::size_t first = 0; first < vertices.size(); first += kBlock) {
        check();
        const std::size_t end = std::min(first + kBlock, vertices.size());
        constexpr float kLargest = std::numeric_limits<float>::max();
        Vec3f low{kLargest, kLargest, kLargest}, high{-kLargest, -kLargest, -kLargest};
        for (std::size_t i = first; i < end; ++i) {
            const Vec3f p = mesh.positions[vertices[i]];
            if (!finite(p)) continue;
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        bounds.include(blocks.emplace_back(Bounds{low, high, !(low.x <= high.x)}));
    }
    for (const Vec3f& p : points) bounds.add(p);
}

FramedPart framed_part(const Scene& scene) {
    FramedPart part;
    part.meshes.resize(scene.meshes.size());
    const std::vector<const Material*> materials = common_materials(scene);
    std::vector<bool> read(scene.meshes.size(), false);
    std::vector<Placed> placed;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size()) continue;
        if (!counts_for_views(scene, instance)) continue;
        const auto m = static_cast<std::size_t>(instance.mesh);
        if (!read[m]) part.meshes[m] = framed_vertices(scene, scene.meshes[m], materials[m], part.whole);
        read[m] = true;
        const Bounds& bounds = part.meshes[m].bounds;
        if (bounds.empty) continue;
        const PlacedBox box({bounds.min.x, bounds.min.y, bounds.min.z}, {bounds.max.x, bounds.max.y, bounds.max.z},
                            instance.world_from_object);
        const WideBox around{{box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}};
        if (!around.finite()) continue;  // a matrix that is not finite: nothing of it is drawn
        placed.push_back({static_cast<int>(i), around, part.meshes[m].vertices.size(), triangles_of(scene.meshes[m])});
        if (part.meshes[m].far_left_out) part.left_out.push_back({static_cast<int>(i), LeftOutFor::far, true});
    }
    const std::size_t all = placed.size();
    const auto is_backdrop = [&](const Placed& one) { return scene.instances[static_cast<std::size_t>(one.instance)].backdrop; };
    if (!std::all_of(placed.begin(), placed.end(), is_backdrop)) leave_out(placed, part, LeftOutFor::backdrop, is_backdrop);
    bool more = true;
    while (more) {
        more = leave_out_strays(scene, placed, part);
        more |= leave_out_surroundings(scene, placed, part);
    }
    part.whole &= placed.size() == all;
    for (const Placed& one : placed) part.instances.push_back(one.instance);
    if (part.whole) return part;
    for (const Placed& one : placed) {
        const Instance& instance = scene.instances[static_cast<std::size_t>(one.instance)];
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const FramedVertices& framed = part.meshes[static_cast<std::size_t>(instance.mesh)];
        for (const std::uint32_t v : framed.vertices) part.bounds.add(transform_point(instance.world_from_object, mesh.positions[v]));
        for (const Vec3f& p : framed.points) part.bounds.add(transform_point(instance.world_from_object, p));
    }
    return part;
}

Bounds framed_bounds(const Scene& scene) {
    const FpEnvironment environment_of_host;
    const FramedPart part = framed_part(scene);
    return part.whole ? scene_bounds(scene) : part.bounds;
}

}  // namespace halflit::raster
