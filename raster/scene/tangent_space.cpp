#include "halflit/mesh.hpp"

#include "sh/arc.hpp"

#include "sh/config.hpp"
#include "sh/fp_environment.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <unordered_map>

namespace halflit {

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

bool is_usable(double x) { return x > 1e-300 && x < 1e300; }  // neither zero, infinite nor NaN

Vec3d unit_or_zero(Vec3d v) {
    const double len = length(v);
    return is_usable(len) ? v * (1.0 / len) : Vec3d{};
}
Vec3d project(Vec3d v, Vec3d unit_normal) { return unit_or_zero(v - unit_normal * dot(unit_normal, v)); }

/// The angle in [0, pi] between unit vectors with this cosine: 2 atan(sqrt((1 - c) / (1 + c))).
double angle_of_cosine(double c) {
    if (!(c < 1.0)) return 0.0;
    if (c <= -1.0) return kPi;
    return 2.0 * arc_tangent(__builtin_sqrt((1.0 - c) / (1.0 + c)));
}

/// Bits of f, the same for -0 and +0.
std::uint32_t bits(float f) { return std::bit_cast<std::uint32_t>(f + 0.0f); }

struct BitsHash {
    template <std::size_t N>
    std::size_t operator()(const std::array<std::uint32_t, N>& key) const {
        std::uint64_t h = 0x9E3779B97F4A7C15ull;
        for (const std::uint32_t k : key) {
            h = (h ^ k) * 0xD6E8FEB86659FD93ull;
            h ^= h >> 32;
        }
        return static_cast<std::size_t>(h);
    }
};

struct Triangle {
    std::array<std::uint32_t, 3> welded;                         // vertex ids after welding
    std::array<std::uint32_t, 3> neighbor{kNone, kNone, kNone};  // across the edge from corner i to corner i + 1
    std::array<std::uint32_t, 3> group{kNone, kNone, kNone};
    Vec3d tangent;            // direction of growing u, unit length or zero
    bool degenerate = false;  // two corners at one position
    bool flat_uv = false;     // no area in texture space
    bool positive = false;    // texture space has the orientation of the triangle (with v as stored)
};

struct Group {
    std::uint32_t vertex = 0;  // welded
    bool positive = false;
    std::size_t first_member = 0, member_count = 0;
    Vec3f tangent{1, 0, 0};
};

class TangentMaker {
public:
    TangentMaker(Mesh& mesh, int uv_set) : mesh_(mesh), uv_(uv_set == 1 ? mesh.uv1 : mesh.uv0), triangles_(mesh.indices.size() / 3) {}

    void run() {
        weld();
        for (Triangle& triangle : triangles_) {
            check_();
            measure(triangle);
        }
        connect();
        make_groups();
        for (Group& group : groups_) {
            check_();
            group.tangent = evaluate(group);
        }
        settle_degenerate();
        write();
    }

private:
    [[nodiscard]] std::uint32_t corner_vertex(std::size_t triangle, int corner) const {
        return mesh_.indices[3 * triangle + static_cast<std::size_t>(corner)];
    }

    /// Vertices with equal position, normal and texture coordinates become one.
    void weld() {
        std::unordered_map<std::array<std::uint32_t, 8>, std::uint32_t, BitsHash> seen;
        std::vector<std::uint32_t> id(mesh_.positions.size());
        seen.reserve(id.size());
        for (std::size_t v = 0; v < id.size(); ++v) {
            check_();
            const Vec3f p = mesh_.positions[v], n = mesh_.normals[v];
            const Vec2f t = uv_[v];
            id[v] = seen.try_emplace({bits(p.x), bits(p.y), bits(p.z), bits(n.x), bits(n.y), bits(n.z), bits(t.x), bits(t.y)},
                                     static_cast<std::uint32_t>(v))
                        .first->second;
        }
        for (std::size_t t = 0; t < triangles_.size(); ++t)
            for (int c = 0; c < 3; ++c) triangles_[t].welded[static_cast<std::size_t>(c)] = id[corner_vertex(t, c)];
    }

    void measure(Triangle& triangle) const {
        const auto [a, b, c] = triangle.welded;
        const Vec3d p0 = to_double(mesh_.positions[a]), p1 = to_double(mesh_.positions[b]), p2 = to_double(mesh_.positions[c]);
        triangle.degenerate = p0 == p1 || p0 == p2 || p1 == p2;
        const double t21x = double{uv_[b].x} - uv_[a].x, t21y = double{uv_[b].y} - uv_[a].y;
        const double t31x = double{uv_[c].x} - uv_[a].x, t31y = double{uv_[c].y} - uv_[a].y;
        const double area = t21x * t31y - t21y * t31x;
        triangle.positive = area > 0.0;
        triangle.flat_uv = !is_usable(area < 0.0 ? -area : area);
        const Vec3d along_u = unit_or_zero((p1 - p0) * t31y - (p2 - p0) * t21y),
                    along_v = unit_or_zero((p2 - p0) * t21x - (p1 - p0) * t31x);
        triangle.tangent = along_u * (triangle.positive ? 1.0 : -1.0);
        if (along_u == Vec3d{} || along_v == Vec3d{}) triangle.flat_uv = true;
    }

    /// Finds for each edge the triangle on its other side. An edge that more than two triangles share pairs them in their order.
    void connect() {
        struct Edge {
            std::uint32_t low, high, triangle;
            std::uint8_t side;
            bool forward;
        };
        std::vector<Edge> edges;
        edges.reserve(3 * triangles_.size());
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            if (triangles_[t].degenerate) continue;
            for (std::uint8_t i = 0; i < 3; ++i) {
                const std::uint32_t from = triangles_[t].welded[i], to = triangles_[t].welded[(i + 1u) % 3u];
                edges.push_back({std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(t), i, from < to});
            }
        }
        std::sort(edges.begin(), edges.end(), timed_less([](const Edge& a, const Edge& b) {
                      return std::tie(a.low, a.high, a.triangle, a.side) < std::tie(b.low, b.high, b.triangle, b.side);
                  }));
        for (std::size_t begin = 0; begin < edges.size();) {
            std::size_t end = begin;
            while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high) ++end;
            std::size_t back = begin;  // the k-th forward edge meets the k-th backward edge
            for (std::size_t i = begin; i < end; ++i) {
                if (!edges[i].forward) continue;
                while (back < end && edges[back].forward) ++back;
                if (back == end) break;
                triangles_[edges[i].triangle].neighbor[edges[i].side] = edges[back].triangle;
                triangles_[edges[back].triangle].neighbor[edges[back].side] = edges[i].triangle;
                ++back;
            }
            begin = end;
        }
    }

    void make_groups() {
        for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
            check_();
            if (triangles_[t].degenerate || triangles_[t].flat_uv) continue;
            for (std::uint32_t corner = 0; corner < 3; ++corner)
                if (triangles_[t].group[corner] == kNone) grow_group(t, corner);
        }
    }

    /// Walks from triangle to triangle around a vertex, in both directions, while the orientation in texture space stays the same.
    void grow_group(std::uint32_t first, std::uint32_t first_corner) {
        const auto id = static_cast<std::uint32_t>(groups_.size());
        Group& group = groups_.emplace_back();
        group.vertex = triangles_[first].welded[first_corner];
        group.positive = triangles_[first].positive;
        group.first_member = members_.size();
        pending_.assign(1, first);
        while (!pending_.empty()) {
            const std::uint32_t t = pending_.back();
            pending_.pop_back();
            Triangle& triangle = triangles_[t];
            std::uint32_t corner = 0;
            while (corner < 3 && triangle.welded[corner] != group.vertex) ++corner;
            if (corner == 3 || triangle.group[corner] != kNone) continue;
            // A triangle without an area in texture space takes the orientation of the first group that reaches it.
            if (triangle.flat_uv && triangle.group == std::array{kNone, kNone, kNone}) triangle.positive = group.positive;
            if (triangle.positive != group.positive) continue;
            triangle.group[corner] = id;
            members_.push_back(t);
            for (const std::uint32_t next : {triangle.neighbor[corner], triangle.neighbor[(corner + 2) % 3]})
                if (next != kNone) pending_.push_back(next);
        }
        group.member_count = members_.size() - group.first_member;
    }

    [[nodiscard]] Vec3f evaluate(const Group& group) const {
        const Vec3d normal = unit_or_zero(to_double(mesh_.normals[group.vertex]));
        Vec3d sum{};
        for (std::size_t m = 0; m < group.member_count; ++m) {
            const Triangle& triangle = triangles_[members_[group.first_member + m]];
            if (triangle.flat_uv) continue;
            std::uint32_t corner = 0;
            while (triangle.welded[corner] != group.vertex) ++corner;
            const Vec3d at = to_double(mesh_.positions[group.vertex]);
            const Vec3d to_next = project(to_double(mesh_.positions[triangle.welded[(corner + 1) % 3]]) - at, normal);
            const Vec3d to_last = project(to_double(mesh_.positions[triangle.welded[(corner + 2) % 3]]) - at, normal);
            sum = sum + project(triangle.tangent, normal) * angle_of_cosine(dot(to_next, to_last));
        }
        const Vec3d unit = unit_or_zero(sum);
        if (unit == Vec3d{}) return {1, 0, 0};
        return {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)};
    }

    /// Corners of triangles without an area take any group at the same vertex.
    void settle_degenerate() {
        std::vector<std::uint32_t> group_at(mesh_.positions.size(), kNone);
        for (const Triangle& triangle : triangles_)
            for (std::size_t c = 0; c < 3; ++c)
                if (triangle.group[c] != kNone && group_at[triangle.welded[c]] == kNone) group_at[triangle.welded[c]] = triangle.group[c];
        for (Triangle& triangle : triangles_)
            for (std::size_t c = 0; c < 3; ++c)
                if (triangle.group[c] == kNone && triangle.degenerate) triangle.group[c] = group_at[triangle.welded[c]];
    }

    [[nodiscard]] Vec4f tangent_of(std::uint32_t group) const {
        if (group == kNone) return {1, 0, 0, 1};  // MikkTSpace's default where no triangle defines a tangent
        const Group& g = groups_[group];
        // v points down: if texture space has the triangle's orientation, the upward bitangent is -cross(normal, tangent).
        return {g.tangent.x, g.tangent.y, g.tangent.z, g.positive ? -1.0f : 1.0f};
    }

    /// Keeps the first tangent of each vertex; copies the vertex for each other tangent.
    void write() {
        std::vector<bool> has(mesh_.positions.size(), false);
        std::unordered_map<std::array<std::uint32_t, 5>, std::uint32_t, BitsHash> copies;  // by source vertex and tangent
        mesh_.tangents.assign(mesh_.positions.size(), Vec4f{1, 0, 0, 1});
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            for (std::size_t c = 0; c < 3; ++c) {
                std::uint32_t& index = mesh_.indices[3 * t + c];
                const Vec4f tangent = tangent_of(triangles_[t].group[c]);
                if (!has[index]) {
                    has[index] = true;
                    mesh_.tangents[index] = tangent;
                }
                if (mesh_.tangents[index] == tangent) continue;
                const auto [copy, is_new] =
                    copies.try_emplace({index, bits(tangent.x), bits(tangent.y), bits(tangent.z), bits(tangent.w)}, 0u);
                if (is_new) {
                    copy->second = duplicate(index);
                    mesh_.tangents.push_back(tangent);
                }
                index = copy->second;
            }
        }
    }

    std::uint32_t duplicate(std::uint32_t vertex) {
        const auto again = [vertex](auto& values) {
            if (!values.empty()) values.push_back(typename std::decay_t<decltype(values)>::value_type(values[vertex]));
        };
        again(mesh_.positions);
        again(mesh_.normals);
        again(mesh_.uv0);
        again(mesh_.uv1);
        again(mesh_.colors);
        return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
    }

    Mesh& mesh_;
    const std::vector<Vec2f>& uv_;
    std::vector<Triangle> triangles_;
    TimeCheck check_;
    std::vector<Group> groups_;
    std::vector<std::uint32_t> members_;  // triangles of all groups, one group after the other
    std::vector<std::uint32_t> pending_;
};

}  // namespace

void generate_tangents(Mesh& mesh, int uv_set) {
    const FpEnvironment environment_of_host;
    if (mesh.topology != Topology::triangles) return;
    const std::size_t count = mesh.positions.size();
    HALFLIT_ASSERT(mesh.normals.size() == count && (uv_set == 1 ? mesh.uv1 : mesh.uv0).size() == count);
    if (count == 0) return;
    TangentMaker(mesh, uv_set).run();
}

}  // namespace halflit
