#include "apps/engine/compare/surface.hpp"

#include "raster/scene/instance_material.hpp"
#include "raster/scene/placed_point.hpp"
#include "raster/scene/triangle_distance.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace halflit::engine {
namespace {

constexpr std::size_t kLeafTriangles = 4;
/// The hierarchy halves the triangles, so 2^32 of them have 32 levels.
constexpr std::size_t kMostLevels = 40;

/// The largest float that is at most x.
float rounded_down(double x) {
    const auto f = static_cast<float>(x);
    return double{f} > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

bool is_finite(Vec3d p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

double distance_to(const Triangle& triangle, Vec3d point) {
    return std::sqrt(raster::triangle_distance_squared(triangle.a - point, triangle.b - point, triangle.c - point));
}

Surface::Surface(const Scene& scene) {
    TimeCheck check;
    for (const Instance& instance : scene.instances) {
        if (!raster::counts_for_views(scene, instance)) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const auto vertex = [&](std::uint32_t index) {
            return raster::placed_in_double(instance.world_from_object, mesh.positions[index]);
        };
        for (std::size_t t = 0; t < triangles_of(mesh); ++t) {
            check();
            const Triangle placed{vertex(mesh.indices[3 * t]), vertex(mesh.indices[3 * t + 1]), vertex(mesh.indices[3 * t + 2])};
            if (is_finite(placed.a) && is_finite(placed.b) && is_finite(placed.c)) triangles_.push_back(placed);
        }
    }
    if (!triangles_.empty()) sort();
}

void Surface::sort() {
    std::vector<Sorted> sorted;
    sorted.reserve(triangles_.size());
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
        const Triangle& t = triangles_[i];
        sorted.push_back({to_float((t.a + t.b) + t.c), i});
    }
    nodes_.emplace_back();
    split(0, sorted, 0);
    std::vector<Triangle> in_order;
    in_order.reserve(triangles_.size());
    for (const Sorted& one : sorted) in_order.push_back(triangles_[one.triangle]);
    triangles_ = std::move(in_order);
}

void Surface::enclose(std::uint32_t node, std::size_t side, std::span<const Sorted> sorted) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    double low[3] = {kFar, kFar, kFar}, high[3] = {-kFar, -kFar, -kFar};
    for (const Sorted& one : sorted) {
        const Triangle& t = triangles_[one.triangle];
        for (const Vec3d& p : {t.a, t.b, t.c}) {
            low[0] = std::min(low[0], p.x), low[1] = std::min(low[1], p.y), low[2] = std::min(low[2], p.z);
            high[0] = std::max(high[0], p.x), high[1] = std::max(high[1], p.y), high[2] = std::max(high[2], p.z);
        }
    }
    for (std::size_t k = 0; k < 3; ++k)
        nodes_[node].low[k][side] = rounded_down(low[k]), nodes_[node].high[k][side] = -rounded_down(-high[k]);
}

void Surface::split(std::uint32_t node, std::span<Sorted> sorted, std::uint32_t first) {
    check_time();
    Vec3f low = sorted.front().middle, high = low;
    for (const Sorted& one : sorted) {
        const Vec3f p = one.middle;
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Vec3f size = high - low;
    float Vec3f::*const axis = size.x >= size.y && size.x >= size.z ? &Vec3f::x : size.y >= size.z ? &Vec3f::y : &Vec3f::z;
    const std::size_t half = sorted.size() / 2;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(half), sorted.end(),
                     [axis](const Sorted& a, const Sorted& b) {
                         return a.middle.*axis < b.middle.*axis || (a.middle.*axis == b.middle.*axis && a.triangle < b.triangle);
                     });
    const std::span<Sorted> sides[2] = {sorted.first(half), sorted.subspan(half)};
    for (std::size_t side = 0; side < 2; ++side) {
        const std::span<Sorted> part = sides[side];
        enclose(node, side, part);
        const auto begin = static_cast<std::uint32_t>(first + (side == 0 ? 0 : half));
        const bool is_leaf = part.size() <= kLeafTriangles;
        nodes_[node].count[side] = static_cast<std::uint8_t>(is_leaf ? part.size() : 0);
        nodes_[node].begin[side] = begin;
        if (is_leaf) {  // one order, whatever the library's nth_element does
            std::sort(part.begin(), part.end(), [](const Sorted& a, const Sorted& b) { return a.triangle < b.triangle; });
            continue;
        }
        const auto next = static_cast<std::uint32_t>(nodes_.size());
        nodes_[node].begin[side] = next;
        nodes_.emplace_back();
        split(next, part, begin);
    }
}

Surface::Nearest Surface::nearest(Vec3d point, std::uint32_t guess, double enough) const {
    const auto squared_to = [&](std::uint32_t i) {
        const Triangle& t = triangles_[i];
        return raster::triangle_distance_squared(t.a - point, t.b - point, t.c - point);
    };
    const double p[3] = {point.x, point.y, point.z};
    const double enough_squared = enough > 0.0 ? enough * enough : 0.0;
    double best = squared_to(guess);
    std::uint32_t found = guess;
    std::uint64_t steps = 1;
    struct Waiting {
        double squared;
        std::uint32_t begin, count;
    };
    Waiting stack[2 * kMostLevels];
    std::size_t waiting = 0;
    stack[waiting++] = {0.0, 0, 0};
    while (waiting > 0 && best > enough_squared) {
        const Waiting next = stack[--waiting];
        if (!(next.squared < best)) continue;
        steps += 1 + next.count;
        if (next.count > 0) {
            for (std::uint32_t i = next.begin; i < next.begin + next.count; ++i)
                if (const double squared = squared_to(i); squared < best) best = squared, found = i;
            continue;
        }
        const Node& node = nodes_[next.begin];
        double squared[2] = {0.0, 0.0};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t side = 0; side < 2; ++side) {
                const double below = double{node.low[k][side]} - p[k], above = p[k] - double{node.high[k][side]};
                const double larger = below > above ? below : above, outside = larger > 0.0 ? larger : 0.0;
                squared[side] += outside * outside;
            }
        const std::size_t near = squared[0] <= squared[1] ? 0 : 1;
        for (const std::size_t side : {1 - near, near})  // the nearer one is taken first
            if (squared[side] < best) stack[waiting++] = {squared[side], node.begin[side], node.count[side]};
    }
    return {std::sqrt(best), found, steps};
}

}  // namespace halflit::engine
