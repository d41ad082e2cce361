#include "raster/choice/framed_part.hpp"

#include "raster/detail/view_math.hpp"
#include "raster/scene/grounds.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/scene/placed_box.hpp"
#include "raster/scene/used_vertices.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <set>
#include <tuple>

namespace halflit::raster {
namespace {

constexpr double kLeastShare = 1.0 / 16.0;  ///< of the whole's radius, below which the rest is looked at closely
constexpr std::size_t kStrayShare = 1000;   ///< one in so many vertices may be left out
constexpr std::size_t kManyVertices = 24;   ///< from which on a triangle, three vertices, may be
/// Clouds of scanners have noise: of points, one in so many may be left out, and the rest need not be as small.
constexpr std::size_t kStrayPoints = 50;
constexpr double kLeastCloud = 1.0 / 4.0;
constexpr int kBins = 256, kMostRounds = 8;

/// A box in double; empty while low > high.
struct WideBox {
    double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
    void add(const WideBox& other) {
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], other.low[k]);
            high[k] = std::max(high[k], other.high[k]);
        }
    }
    [[nodiscard]] bool empty() const { return low[0] > high[0]; }
    [[nodiscard]] double radius() const {
        const double x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
        return empty() ? 0.0 : 0.5 * __builtin_sqrt((x * x + y * y) + z * z);
    }
    [[nodiscard]] WideBox widened(double by) const {
        WideBox out = *this;
        for (int k = 0; k < 3; ++k) out.low[k] -= by, out.high[k] += by;
        return out;
    }
    [[nodiscard]] bool holds(const WideBox& other) const {
        bool inside = true;
        for (int k = 0; k < 3; ++k) inside &= other.low[k] >= low[k] && other.high[k] <= high[k];
        return inside;
    }
    [[nodiscard]] bool finite() const {
        bool all = true;
        for (int k = 0; k < 3; ++k) all &= high[k] - high[k] == 0.0 && low[k] - low[k] == 0.0;
        return all;
    }
};

WideBox box_at(Vec3f p) { return {{p.x, p.y, p.z}, {p.x, p.y, p.z}}; }

/// Finds a box that holds all but a little of the weight, in which the items lie closely together. each(visit) calls visit(box, weight) for
/// each item. Returns nothing if there is none below least_share of the whole's radius. Outliers at very different distances need rounds: a
/// bin of the farthest one's may hold all others.
template <class Each>
std::optional<WideBox> closest_box(const Each& each, std::uint64_t allowed, double least_share = kLeastShare) {
    WideBox kept;
    each([&](const WideBox& box, std::uint64_t) { kept.add(box); });
    const double whole = kept.radius();
    bool found = false;
    for (int round = 0; round < kMostRounds; ++round) {
        std::array<std::array<std::uint64_t, kBins>, 3> first{}, last{};
        const auto bin = [&](double at, int k) {
            const double width = kept.high[k] - kept.low[k];
            return width > 0.0 ? std::clamp(static_cast<int>((at - kept.low[k]) / width * kBins), 0, kBins - 1) : 0;
        };
        std::uint64_t outside = 0;
        each([&](const WideBox& box, std::uint64_t weight) {
            if (!kept.holds(box)) {
                outside += weight;
                return;
            }
            for (int k = 0; k < 3; ++k) {
                const auto axis = static_cast<std::size_t>(k);
                first[axis][static_cast<std::size_t>(bin(box.low[k], k))] += weight;
                last[axis][static_cast<std::size_t>(bin(box.high[k], k))] += weight;
            }
        });
        if (outside > allowed) return std::nullopt;
        const std::uint64_t left = allowed - outside;
        WideBox trimmed;
        for (int k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            const double step = (kept.high[k] - kept.low[k]) / kBins;
            std::size_t low = 0, high = kBins - 1;
            for (std::uint64_t sum = first[axis][0]; sum <= left && low + 1 < kBins; sum += first[axis][low]) ++low;
            for (std::uint64_t sum = last[axis][kBins - 1]; sum <= left && high > 0; sum += last[axis][high]) --high;
            trimmed.low[k] = low == 0 ? kept.low[k] : kept.low[k] + step * (static_cast<double>(low) - 1e-6);
            trimmed.high[k] = high == kBins - 1 ? kept.high[k] : kept.low[k] + step * (static_cast<double>(high + 1) + 1e-6);
            if (trimmed.low[k] > trimmed.high[k]) return found ? std::optional(kept) : std::nullopt;
        }
        std::uint64_t left_out = 0;
        const auto around_items_in = [&](const WideBox& outer) {
            WideBox box;
            left_out = 0;
            each([&](const WideBox& item, std::uint64_t weight) {
                if (outer.holds(item))
                    box.add(item);
                else
                    left_out += weight;
            });
            return box;
        };
        WideBox inside = around_items_in(trimmed);
        if (inside.empty() || !(inside.radius() < least_share * kept.radius())) break;
        // Trimming cuts off what is outermost, stray or not. What lies near the box belongs to it.
        for (int k = 0; k < kMostRounds; ++k) {
            const WideBox grown = around_items_in(inside.widened(inside.radius()));
            if (inside.holds(grown)) break;
            inside = grown;
        }
        if (left_out > allowed || !(inside.radius() < least_share * kept.radius())) break;
        kept = inside;
        found = true;
    }
    return found && kept.radius() < least_share * whole ? std::optional(kept) : std::nullopt;
}

FramedVertices framed_vertices(const Mesh& mesh, bool& whole) {
    const std::vector<bool> used = used_vertices(mesh);
    FramedVertices out;
    std::uint64_t finite_count = 0;
    for (std::uint32_t v = 0; v < used.size(); ++v) {
        if (!used[v]) continue;
        out.vertices.push_back(v);
        out.bounds.add(mesh.positions[v]);
        finite_count += finite(mesh.positions[v]) ? 1 : 0;
    }
    if (finite_count < 8 || !(out.bounds.radius() > 0.0f)) return out;
    TimeCheck check;
    const auto each = [&](const auto& visit) {
        for (const std::uint32_t v : out.vertices) {
            check();
            if (finite(mesh.positions[v])) visit(box_at(mesh.positions[v]), std::uint64_t{1});
        }
    };
    // A position may be that of several vertices, one for each triangle at a corner.
    const bool is_cloud = mesh.topology == Topology::points;
    const std::uint64_t positions = std::max<std::uint64_t>(finite_count < kManyVertices ? 1 : 3,
                                                            finite_count / (is_cloud ? kStrayPoints : kStrayShare)),
                        most = std::max<std::uint64_t>(finite_count / 3, 1);
    const auto box = closest_box(each, std::min(most, 64 * positions), is_cloud ? kLeastCloud : kLeastShare);
    if (!box) return out;
    std::set<std::tuple<float, float, float>> strays;
    FramedVertices kept;
    for (const std::uint32_t v : out.vertices) {
        const Vec3f p = mesh.positions[v];
        if (finite(p) && !box->holds(box_at(p))) {
            strays.emplace(p.x, p.y, p.z);
            if (strays.size() > positions) return out;
            continue;
        }
        kept.vertices.push_back(v);
        kept.bounds.add(p);
    }
    whole = false;
    return kept;
}

/// An instance: its box, the number of its vertices, and that of its triangles.
struct Placed {
    int instance;
    WideBox box;
    std::uint64_t vertices, triangles;
};

void leave_out_grounds(std::vector<Placed>& placed) {
    std::vector<PlacedTriangles> boxes;
    for (const Placed& one : placed) {
        const double(&low)[3] = one.box.low, (&high)[3] = one.box.high;
        boxes.push_back({{low[0], low[1], low[2]}, {high[0], high[1], high[2]}, one.triangles});
    }
    std::vector<std::size_t> grounds = grounds_of(boxes);
    std::sort(grounds.begin(), grounds.end(), std::greater<>());
    for (const std::size_t ground : grounds) placed.erase(placed.begin() + static_cast<std::ptrdiff_t>(ground));
}

void leave_out_strays(std::vector<Placed>& placed) {
    std::uint64_t vertices = 0;
    for (const Placed& one : placed) vertices += one.vertices;
    if (placed.size() < 2 || vertices < kManyVertices) return;
    const auto each = [&](const auto& visit) {
        for (const Placed& one : placed) visit(one.box, one.vertices);
    };
    if (const auto box = closest_box(each, std::max<std::uint64_t>(3, vertices / kStrayShare)))
        std::erase_if(placed, [&](const Placed& one) { return !box->holds(one.box); });
}

}  // namespace

FramedPart framed_part(const Scene& scene) {
    FramedPart part;
    part.meshes.resize(scene.meshes.size());
    std::vector<bool> read(scene.meshes.size(), false);
    std::vector<Placed> placed;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size()) continue;
        if (!counts_for_views(scene, instance)) continue;
        const auto m = static_cast<std::size_t>(instance.mesh);
        if (!read[m]) part.meshes[m] = framed_vertices(scene.meshes[m], part.whole);
        read[m] = true;
        const Bounds& bounds = part.meshes[m].bounds;
        if (bounds.empty) continue;
        const PlacedBox box({bounds.min.x, bounds.min.y, bounds.min.z}, {bounds.max.x, bounds.max.y, bounds.max.z},
                            instance.world_from_object);
        const WideBox wide{{box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}};
        if (!wide.finite()) continue;  // a matrix that is not finite: nothing of it is drawn
        placed.push_back({static_cast<int>(i), wide, part.meshes[m].vertices.size(), triangles_of(scene.meshes[m])});
    }
    const std::size_t all = placed.size();
    const auto is_backdrop = [&](const Placed& one) { return scene.instances[static_cast<std::size_t>(one.instance)].backdrop; };
    if (!std::all_of(placed.begin(), placed.end(), is_backdrop)) std::erase_if(placed, is_backdrop);
    leave_out_strays(placed);
    leave_out_grounds(placed);
    part.whole &= placed.size() == all;
    for (const Placed& one : placed) part.instances.push_back(one.instance);
    if (part.whole) return part;
    for (const Placed& one : placed) {
        const Instance& instance = scene.instances[static_cast<std::size_t>(one.instance)];
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        for (const std::uint32_t v : part.meshes[static_cast<std::size_t>(instance.mesh)].vertices)
            part.bounds.add(transform_point(instance.world_from_object, mesh.positions[v]));
    }
    return part;
}

}  // namespace halflit::raster
