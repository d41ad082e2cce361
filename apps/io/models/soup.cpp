#include "apps/io/models/soup.hpp"

#include "apps/io/files/in_parts.hpp"
#include "apps/io/models/crease_normals.hpp"
#include "sh/place_table.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"
#include "shading/model/numbers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace halflit::io::detail {

namespace {

/// Numbers of the places of a soup's points: equal points have equal ones.
std::vector<std::uint32_t> find_places(const Soup& soup) {
    const std::vector<Vec3f>& positions = soup.points;
    std::vector<std::uint32_t> place;
    if (soup.distinct) {
        place.resize(positions.size());
        std::iota(place.begin(), place.end(), 0u);
        return place;
    }
    PlaceTable<Vec3f> table;
    place.reserve(positions.size());
    TimeCheck check;
    for (const Vec3f& p : positions) {
        check();
        place.push_back(table.find(p, static_cast<std::uint32_t>(place.size()), positions));
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

/// For each corner, the lowest one that is the same vertex: of the same place, part, normal, texture coordinates and colour.
std::vector<std::uint32_t> find_vertices(const Soup& soup, const CornersOfPlaces& corners, int threads) {
    struct Key {
        std::uint32_t part, normal, uv, color, corner;
        [[nodiscard]] auto values() const { return std::tie(part, normal, uv, color); }
    };
    const auto number_at = [](const std::vector<std::uint32_t>& list, std::size_t at) { return list.empty() ? kNone : list[at]; };
    std::vector<std::uint32_t> vertex(soup.position_of.size());
    const auto find = [&](std::size_t /*part*/, std::size_t begin, std::size_t end) {
        std::vector<Key> keys;
        TimeCheck check;
        for (std::size_t place = begin; place < end; ++place) {
            keys.clear();
            for (const std::uint32_t corner : corners.at(static_cast<std::uint32_t>(place))) {
                check();
                keys.push_back({number_at(soup.part_of, corner / 3), soup.normal_of[corner], number_at(soup.uv_of, corner),
                                number_at(soup.color_of, corner), corner});
            }
            std::sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
                check();
                return a.values() == b.values() ? a.corner < b.corner : a.values() < b.values();
            });
            for (std::size_t i = 0; i < keys.size(); ++i) {
                const bool same = i > 0 && keys[i].values() == keys[i - 1].values();
                vertex[keys[i].corner] = same ? vertex[keys[i - 1].corner] : keys[i].corner;
            }
        }
    };
    in_parts(corners.places(), parts_of(corners.places(), kPlacesAThread, threads), find);
    return vertex;
}

class MeshMaker {
public:
    /// vertex_of: find_vertices().
    MeshMaker(const Soup& soup, std::vector<std::uint32_t> vertex_of) : soup_(soup), vertex_of_(std::move(vertex_of)) {}

    /// The mesh of some triangles, given by an increasing list, or all of them.
    Mesh make(const std::vector<std::uint32_t>* triangles) {
        const std::size_t count = triangles != nullptr ? triangles->size() : soup_.triangles();
        const auto for_each_corner = [&](const auto& visit) {
            for (std::size_t i = 0; i < count; ++i) {
                const std::uint32_t t = triangles != nullptr ? (*triangles)[i] : static_cast<std::uint32_t>(i);
                for (std::uint32_t corner = 3 * t; corner < 3 * t + 3; ++corner) visit(corner);
            }
        };
        bool has_uvs = false, has_colors = false;
        std::size_t vertices = 0;
        for_each_corner([&](std::uint32_t corner) {
            vertices += vertex_of_[corner] == corner ? 1 : 0;
            has_uvs = has_uvs || (!soup_.uv_of.empty() && soup_.uv_of[corner] != kNone);
            has_colors = has_colors || (!soup_.color_of.empty() && soup_.color_of[corner] != kNone);
        });
        Mesh mesh;
        mesh.indices.reserve(3 * count);
        mesh.positions.reserve(vertices);
        mesh.normals.reserve(vertices);
        if (has_uvs) mesh.uv0.reserve(vertices);
        if (has_colors) mesh.colors.reserve(vertices);
        // A corner's vertex is that of an earlier corner, whose number is known, or a new one.
        for_each_corner([&](std::uint32_t corner) {
            const std::uint32_t first = vertex_of_[corner];
            if (first == corner) {
                vertex_of_[corner] = static_cast<std::uint32_t>(mesh.positions.size());
                add_vertex(mesh, corner, has_uvs, has_colors);
                mesh.indices.push_back(vertex_of_[corner]);
            } else {
                mesh.indices.push_back(vertex_of_[first]);
            }
        });
        return mesh;
    }

private:
    void add_vertex(Mesh& mesh, std::uint32_t corner, bool has_uvs, bool has_colors) const {
        mesh.positions.push_back(soup_.points[soup_.position_of[corner]]);
        mesh.normals.push_back(soup_.normals[soup_.normal_of[corner]]);
        const std::uint32_t uv = has_uvs ? soup_.uv_of[corner] : kNone, color = has_colors ? soup_.color_of[corner] : kNone;
        if (has_uvs) mesh.uv0.push_back(uv == kNone ? Vec2f{0, 0} : soup_.uvs[uv]);
        if (has_colors) mesh.colors.push_back(color == kNone ? Vec4f{1, 1, 1, 1} : soup_.colors[color]);
    }

    const Soup& soup_;
    std::vector<std::uint32_t> vertex_of_;  ///< of corners that a mesh has, and that are the first of their vertex: its number in the mesh
};

/// Cosine between a triangle and a corner's normal below which the normal is against it by itself: smooth normals of coarse meshes may lean
/// over an edge, but not so far.
constexpr double kAgainst = -0.3;

/// Normals that the renderer cannot use are replaced by computed ones. Those of a triangle that point away from the side which its corners
/// go around counter-clockwise are turned, as mirrored parts have them: surfaces are drawn from both sides, and lit on the side that is
/// seen, by that side's normals. A triangle with normals of both sides takes those of most.
void mend_normals(Soup& soup) {
    for (std::uint32_t& n : soup.normal_of)
        if (n != kNone && (!shading::finite(soup.normals[n]) || soup.normals[n] == Vec3f{})) n = kNone;
    std::vector<std::uint32_t> turned;  // of a normal: the number of its opposite
    TimeCheck check;
    for (std::size_t t = 0; 3 * t < soup.normal_of.size(); ++t) {
        check();
        const auto point = [&](std::size_t c) { return to_double(soup.points[soup.position_of[3 * t + c]]); };
        const Vec3d face = cross(point(1) - point(0), point(2) - point(0));
        const double size = length(face);
        double cosine[3] = {0, 0, 0};  // 0 too where a corner has no normal
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t n = soup.normal_of[3 * t + c];
            if (n == kNone) continue;
            const Vec3d normal = to_double(soup.normals[n]);
            cosine[c] = dot(normal, face) / (length(normal) * size);
        }
        const bool all = cosine[0] + cosine[1] + cosine[2] < 0;
        if (!all && !(std::min({cosine[0], cosine[1], cosine[2]}) < kAgainst)) continue;
        turned.resize(soup.normals.size(), kNone);
        for (std::size_t c = 0; c < 3; ++c) {
            std::uint32_t& n = soup.normal_of[3 * t + c];
            if (n == kNone || (all ? cosine[c] > -kAgainst : cosine[c] >= kAgainst)) continue;
            if (turned[n] == kNone) {
                turned[n] = static_cast<std::uint32_t>(soup.normals.size());
                const Vec3f normal = soup.normals[n];
                soup.normals.push_back({-normal.x, -normal.y, -normal.z});
            }
            n = turned[n];
        }
    }
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
    soup.distinct = soup.distinct && origin == Vec3d{};
    return origin;
}

CornersOfPlaces::CornersOfPlaces(const std::vector<std::uint32_t>& place_of, std::size_t places)
    : first_(places + 1), corner_(place_of.size()) {
    for (const std::uint32_t place : place_of) ++first_[place + 1];
    for (std::size_t i = 1; i <= places; ++i) first_[i] += first_[i - 1];
    // Each list is filled from its end: then its beginning is where it was counted to.
    for (std::size_t corner = place_of.size(); corner-- > 0;) corner_[--first_[place_of[corner] + 1]] = static_cast<std::uint32_t>(corner);
    first_.erase(first_.begin());
    first_.push_back(static_cast<std::uint32_t>(place_of.size()));
}

std::vector<SoupMesh> make_meshes(Soup&& soup, double crease_deg, int threads, std::size_t& left_out) {
    check_time();
    std::vector<SoupMesh> meshes;
    for (auto* list : {&soup.normal_of, &soup.uv_of, &soup.color_of})
        if (!list->empty()) list->resize(soup.position_of.size(), kNone);
    if (!soup.part_of.empty()) soup.part_of.resize(soup.triangles(), 0);
    if (!soup.smoothing_of.empty()) soup.smoothing_of.resize(soup.triangles(), Soup::kByCrease);
    {
        const std::vector<std::uint32_t> place = find_places(soup);
        left_out += remove_bad(soup, place);
        for (std::uint32_t& position : soup.position_of) position = place[position];
    }
    if (soup.position_of.empty()) return meshes;
    mend_normals(soup);
    std::vector<std::uint32_t> vertices;
    {
        const CornersOfPlaces corners(soup.position_of, soup.points.size());
        check_time();
        add_crease_normals(soup, corners, crease_deg, threads);
        vertices = find_vertices(soup, corners, threads);
    }

    MeshMaker maker(soup, std::move(vertices));
    if (soup.part_of.empty()) {
        meshes.push_back({0, maker.make(nullptr)});
        return meshes;
    }
    std::map<std::uint32_t, std::size_t> mesh_of_part;
    std::vector<std::vector<std::uint32_t>> triangles;
    for (std::uint32_t t = 0; t < soup.triangles(); ++t) {
        const std::uint32_t part = soup.part_of[t];
        std::size_t mesh = 0;
        if (t > 0 && soup.part_of[t - 1] == part) {
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
        meshes[m].mesh = maker.make(&triangles[m]);
        triangles[m] = {};
    }
    return meshes;
}

}  // namespace halflit::io::detail
