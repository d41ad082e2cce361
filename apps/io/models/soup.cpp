#include "apps/io/models/soup.hpp"

#include "apps/io/models/crease_normals.hpp"
#include "sh/time_limit.hpp"
#include "shading/model/numbers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <map>
#include <tuple>

namespace halflit::io::detail {

namespace {

/// Numbers of the places of a list of positions: equal positions have equal ones.
std::vector<std::uint32_t> find_places(const std::vector<Vec3f>& positions) {
    struct Key {
        std::uint32_t x, y, z, index;
    };
    const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f + 0.0f); };  // -0 becomes 0
    std::vector<Key> keys;
    keys.reserve(positions.size());
    for (const Vec3f& p : positions) keys.push_back({bits(p.x), bits(p.y), bits(p.z), static_cast<std::uint32_t>(keys.size())});
    std::sort(keys.begin(), keys.end(),
              timed_less([](const Key& a, const Key& b) { return std::tie(a.x, a.y, a.z, a.index) < std::tie(b.x, b.y, b.z, b.index); }));
    std::vector<std::uint32_t> place(positions.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const bool same = i > 0 && keys[i].x == keys[i - 1].x && keys[i].y == keys[i - 1].y && keys[i].z == keys[i - 1].z;
        place[keys[i].index] = same ? place[keys[i - 1].index] : keys[i].index;
    }
    return place;
}

/// Removes triangles that are not finite, which it counts, and those with two corners at one place.
std::size_t remove_bad(Soup& soup, const std::vector<std::uint32_t>& place) {
    std::size_t kept = 0, not_finite = 0;
    const auto all_lists = {&soup.position_of, &soup.normal_of, &soup.uv_of, &soup.color_of};
    for (std::size_t t = 0; t < soup.triangles(); ++t) {
        const std::array corner{soup.position_of[3 * t], soup.position_of[3 * t + 1], soup.position_of[3 * t + 2]};
        const bool finite = std::all_of(corner.begin(), corner.end(), [&](std::uint32_t i) { return shading::finite(soup.points[i]); });
        if (!finite) ++not_finite;
        if (!finite || place[corner[0]] == place[corner[1]] || place[corner[1]] == place[corner[2]] || place[corner[2]] == place[corner[0]])
            continue;
        if (kept != t) {
            for (auto* list : all_lists)
                for (std::size_t c = 0; c < 3 && !list->empty(); ++c) (*list)[3 * kept + c] = (*list)[3 * t + c];
            if (!soup.part_of.empty()) soup.part_of[kept] = soup.part_of[t];
            if (!soup.smoothing_of.empty()) soup.smoothing_of[kept] = soup.smoothing_of[t];
        }
        ++kept;
    }
    for (auto* list : all_lists)
        if (!list->empty()) list->resize(3 * kept);
    if (!soup.part_of.empty()) soup.part_of.resize(kept);
    if (!soup.smoothing_of.empty()) soup.smoothing_of.resize(kept);
    return not_finite;
}

/// A vertex: what its corners have in common, and one of them.
struct VertexKey {
    std::uint32_t place, normal, uv, color, corner;
    [[nodiscard]] auto values() const { return std::tie(place, normal, uv, color); }
};

class MeshMaker {
public:
    MeshMaker(const Soup& soup, const std::vector<std::uint32_t>& place_of) : soup_(soup), place_of_(place_of), made_as_(place_of.size()) {}

    /// The mesh of some triangles.
    Mesh make(const std::vector<std::uint32_t>& triangles) {
        std::vector<VertexKey> keys;
        keys.reserve(3 * triangles.size());
        for (const std::uint32_t t : triangles)
            for (std::uint32_t corner = 3 * t; corner < 3 * t + 3; ++corner)
                keys.push_back({place_of_[corner], soup_.normal_of[corner], number_at(soup_.uv_of, corner),
                                number_at(soup_.color_of, corner), corner});
        std::sort(keys.begin(), keys.end(), timed_less([](const VertexKey& a, const VertexKey& b) {
                      return a.values() == b.values() ? a.corner < b.corner : a.values() < b.values();
                  }));
        // made_as_: of each corner the lowest one of its vertex, and of that the vertex's number, when it is known.
        bool has_uvs = false, has_colors = false;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const bool same = i > 0 && keys[i].values() == keys[i - 1].values();
            made_as_[keys[i].corner] = same ? made_as_[keys[i - 1].corner] : keys[i].corner;
            has_uvs = has_uvs || keys[i].uv != kNone;
            has_colors = has_colors || keys[i].color != kNone;
        }
        Mesh mesh;
        mesh.indices.reserve(keys.size());
        keys.clear();
        for (const std::uint32_t t : triangles)
            for (std::uint32_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
                const std::uint32_t first = made_as_[corner];
                if (first == corner) {
                    made_as_[corner] = static_cast<std::uint32_t>(mesh.positions.size());
                    mesh.indices.push_back(made_as_[corner]);
                    add_vertex(mesh, corner, has_uvs, has_colors);
                } else {
                    mesh.indices.push_back(made_as_[first]);
                }
            }
        return mesh;
    }

private:
    static std::uint32_t number_at(const std::vector<std::uint32_t>& list, std::size_t corner) {
        return corner < list.size() ? list[corner] : kNone;
    }
    void add_vertex(Mesh& mesh, std::uint32_t corner, bool has_uvs, bool has_colors) const {
        mesh.positions.push_back(soup_.points[soup_.position_of[corner]]);
        mesh.normals.push_back(soup_.normals[soup_.normal_of[corner]]);
        const std::uint32_t uv = number_at(soup_.uv_of, corner), color = number_at(soup_.color_of, corner);
        if (has_uvs) mesh.uv0.push_back(uv == kNone ? Vec2f{0, 0} : soup_.uvs[uv]);
        if (has_colors) mesh.colors.push_back(color == kNone ? Vec4f{1, 1, 1, 1} : soup_.colors[color]);
    }

    const Soup& soup_;
    const std::vector<std::uint32_t>& place_of_;
    std::vector<std::uint32_t> made_as_;
};

/// A normal that the renderer can use; others are replaced by computed ones.
void forget_bad_normals(Soup& soup) {
    for (std::uint32_t& n : soup.normal_of)
        if (n != kNone && (!shading::finite(soup.normals[n]) || soup.normals[n] == Vec3f{})) n = kNone;
}

}  // namespace

Vec3d origin_of(const DoubleBox& box) { return box.is_far() ? box.center() : Vec3d{}; }

Vec3f rounded_near(Vec3d position, Vec3d origin) {
    const auto rounded = [](double x) {
        constexpr double kMost = std::numeric_limits<float>::max();
        if (x > kMost) return std::numeric_limits<float>::infinity();
        if (x < -kMost) return -std::numeric_limits<float>::infinity();
        return static_cast<float>(x);
    };
    return {rounded(position.x - origin.x), rounded(position.y - origin.y), rounded(position.z - origin.z)};
}

bool fits_float(Vec3d position) { return shading::finite(rounded_near(position, {})); }

Vec3d move_near(Soup& soup, bool recentre) {
    Vec3d origin{};
    if (recentre) {
        DoubleBox box;
        for (const std::uint32_t i : soup.position_of)
            if (fits_float(soup.positions[i])) box.include(soup.positions[i]);
        origin = origin_of(box);
    }
    soup.points.reserve(soup.positions.size());
    for (const Vec3d& p : soup.positions) soup.points.push_back(rounded_near(p, origin));
    soup.positions = {};
    return origin;
}

std::vector<SoupMesh> make_meshes(Soup&& soup, double crease_deg, std::size_t& left_out) {
    check_time();
    std::vector<SoupMesh> meshes;
    std::vector<std::uint32_t> place_of;  // of corners
    {
        const std::vector<std::uint32_t> place = find_places(soup.points);
        for (auto* list : {&soup.normal_of, &soup.uv_of, &soup.color_of})
            if (!list->empty()) list->resize(soup.position_of.size(), kNone);
        if (!soup.part_of.empty()) soup.part_of.resize(soup.triangles(), 0);
        if (!soup.smoothing_of.empty()) soup.smoothing_of.resize(soup.triangles(), Soup::kByCrease);
        left_out += remove_bad(soup, place);
        place_of.reserve(soup.position_of.size());
        for (const std::uint32_t position : soup.position_of) place_of.push_back(place[position]);
    }
    if (soup.position_of.empty()) return meshes;
    forget_bad_normals(soup);
    add_crease_normals(soup, place_of, crease_deg);

    MeshMaker maker(soup, place_of);
    std::map<std::uint32_t, std::size_t> mesh_of_part;
    std::vector<std::vector<std::uint32_t>> triangles;
    for (std::uint32_t t = 0; t < soup.triangles(); ++t) {
        const std::uint32_t part = soup.part_of.empty() ? 0 : soup.part_of[t];
        std::size_t mesh = 0;
        if (t > 0 && (soup.part_of.empty() || soup.part_of[t - 1] == part)) {
            mesh = mesh_of_part[part];
        } else {
            const auto [entry, is_new] = mesh_of_part.try_emplace(part, triangles.size());
            if (is_new) {
                meshes.push_back({part, {}});
                triangles.emplace_back();
            }
            mesh = entry->second;
        }
        triangles[mesh].push_back(t);
    }
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        check_time();
        meshes[m].mesh = maker.make(triangles[m]);
        triangles[m] = {};
    }
    return meshes;
}

}  // namespace halflit::io::detail
