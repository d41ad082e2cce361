#include "raster/geometry/section_mesh.hpp"

#include "raster/scene/keep_splats.hpp"
#include "raster/scene/placed_point.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"
#include "shading/model/numbers.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace halflit::raster {
namespace {

double between(double a, double b, double t) { return a + (b - a) * t; }
float between(float a, float b, double t) { return static_cast<float>(between(static_cast<double>(a), static_cast<double>(b), t)); }
Vec2f between(Vec2f a, Vec2f b, double t) { return {between(a.x, b.x, t), between(a.y, b.y, t)}; }
Vec3f between(Vec3f a, Vec3f b, double t) { return {between(a.x, b.x, t), between(a.y, b.y, t), between(a.z, b.z, t)}; }
Vec3d between(Vec3d a, Vec3d b, double t) { return {between(a.x, b.x, t), between(a.y, b.y, t), between(a.z, b.z, t)}; }
Vec4f between(Vec4f a, Vec4f b, double t) {
    return {between(a.x, b.x, t), between(a.y, b.y, t), between(a.z, b.z, t), between(a.w, b.w, t)};
}

/// Copies vertices of a mesh, each once, and makes new ones on its edges.
class KeptMesh {
public:
    explicit KeptMesh(const Mesh& from) : from_(from), number_(from.positions.size(), kNone) {
        out_.name = from.name;
        out_.material = from.material;
        out_.topology = from.topology;
    }

    std::uint32_t copy(std::uint32_t v) {
        if (number_[v] == kNone) {
            number_[v] = static_cast<std::uint32_t>(out_.positions.size());
            out_.positions.push_back(from_.positions[v]);
            add(out_.normals, from_.normals, v);
            add(out_.tangents, from_.tangents, v);
            add(out_.uv0, from_.uv0, v);
            add(out_.uv1, from_.uv1, v);
            add(out_.colors, from_.colors, v);
        }
        return number_[v];
    }

    std::uint32_t cut(std::uint32_t kept, std::uint32_t removed, double t, Vec3f position) {
        const auto [found, is_new] = cuts_.try_emplace({kept, removed}, static_cast<std::uint32_t>(out_.positions.size()));
        if (is_new) {
            out_.positions.push_back(position);
            add(out_.normals, from_.normals, kept, removed, t);
            if (!out_.normals.empty() && shading::zero(out_.normals.back())) out_.normals.back() = from_.normals[kept];
            add(out_.tangents, from_.tangents, kept, removed, t);
            if (!out_.tangents.empty()) out_.tangents.back().w = from_.tangents[kept].w;
            add(out_.uv0, from_.uv0, kept, removed, t);
            add(out_.uv1, from_.uv1, kept, removed, t);
            add(out_.colors, from_.colors, kept, removed, t);
        }
        return found->second;
    }

    /// Leaves out triangles that have lost their area.
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const Vec3f &p = out_.positions[a], &q = out_.positions[b], &r = out_.positions[c];
        if (p != q && q != r && r != p) out_.indices.insert(out_.indices.end(), {a, b, c});
    }
    void index(std::uint32_t v) { out_.indices.push_back(v); }
    Mesh take() { return std::move(out_); }

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    template <class T>
    static void add(std::vector<T>& to, const std::vector<T>& from, std::uint32_t v) {
        if (!from.empty()) to.push_back(from[v]);
    }
    template <class T>
    static void add(std::vector<T>& to, const std::vector<T>& from, std::uint32_t a, std::uint32_t b, double t) {
        if (!from.empty()) to.push_back(between(from[a], from[b], t));
    }

    const Mesh& from_;
    Mesh out_;
    std::vector<std::uint32_t> number_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> cuts_;
};

}  // namespace

MeshCut::MeshCut(const Mesh& mesh, const Mat4& world_from_object, const UnitPlane& plane)
    : mesh_(mesh),
      place_(world_from_object),
      plane_(plane),
      mirrors_(determinant3(world_from_object) < 0.0),
      distances_(mesh.positions.size()),
      sides_(mesh.positions.size()) {
    TimeCheck check;
    for (std::size_t i = 0; i < distances_.size(); ++i) {
        check();
        const double d = distances_[i] = plane.distance(placed_in_double(place_, mesh.positions[i]));
        sides_[i] = !shading::finite(d)              ? Side::none
                    : d > plane.tolerance            ? Side::removed
                    : absolute(d) <= plane.tolerance ? Side::on
                                                     : Side::kept;
    }
}

bool MeshCut::is_finite(const std::uint32_t* corners, std::size_t count) const {
    return std::none_of(corners, corners + count, [&](std::uint32_t v) { return sides_[v] == Side::none; });
}

/// A face on the plane whose material is beyond it. Such a triangle is dropped, as if the plane were moved by an infinitely small step.
bool MeshCut::is_dropped_face(const std::uint32_t* corners) const {
    for (int i = 0; i < 3; ++i)
        if (sides_[corners[i]] != Side::on) return false;
    const Vec3d a = vertex(corners[0]).world, b = vertex(corners[1]).world, c = vertex(corners[2]).world;
    const double facing = dot(cross(b - a, c - a), plane_.normal);
    return mirrors_ ? facing > 0.0 : facing < 0.0;
}

/// Share of the way from the kept end to the removed one where the plane is. All edges are cut at a vertex on the plane itself.
double MeshCut::share(std::uint32_t kept, std::uint32_t removed) const {
    const double from = distances_[kept], to = distances_[removed];
    return sides_[kept] == Side::on ? 0.0 : -from / (to - from);
}

CutPoint MeshCut::vertex(std::uint32_t v) const { return {placed_in_double(place_, mesh_.positions[v]), mesh_.positions[v]}; }

CutPoint MeshCut::cut_point(std::uint32_t kept, std::uint32_t removed) const {
    const double t = share(kept, removed);
    const CutPoint from = vertex(kept), to = vertex(removed);
    return {between(from.world, to.world, t), between(from.object, to.object, t)};
}

Left MeshCut::left() const {
    if (mesh_.splats != nullptr) {
        const auto end = sides_.begin() + static_cast<std::ptrdiff_t>(mesh_.splats->opacities.size());
        const auto kept = std::count_if(sides_.begin(), end, [](Side side) { return side == Side::kept || side == Side::on; });
        return kept == end - sides_.begin() ? Left::all : kept > 0 ? Left::some : Left::nothing;
    }
    const std::size_t corners = corners_of(mesh_.topology);
    bool some_kept = false, some_removed = false;
    TimeCheck check;
    for (std::size_t i = 0; i + corners <= mesh_.indices.size() && !(some_kept && some_removed); i += corners) {
        check();
        const std::uint32_t* const at = &mesh_.indices[i];
        if (!is_finite(at, corners)) continue;
        const bool dropped = corners == 3 && is_dropped_face(at);
        some_removed = some_removed || dropped;
        for (std::size_t c = 0; c < corners; ++c) {
            some_kept = some_kept || (is_kept(at[c]) && !dropped && sides_[at[c]] != Side::on);
            some_removed = some_removed || !is_kept(at[c]);
        }
        // A primitive on the plane is kept whole.
        some_kept = some_kept || (!dropped && std::all_of(at, at + corners, [&](std::uint32_t v) { return sides_[v] == Side::on; }));
    }
    return !some_removed ? Left::all : some_kept ? Left::some : Left::nothing;
}

/// Splats whose middles are kept, whole.
Mesh MeshCut::kept_splats() const {
    std::vector<Vec3f> positions = mesh_.positions;
    Splats kept = *mesh_.splats;
    TimeCheck check;
    keep_splats(positions, kept, [&](std::size_t i) {
        check();
        return is_kept(static_cast<std::uint32_t>(i));
    });
    Mesh out = make_splat_mesh(std::move(positions), std::move(kept));
    out.name = mesh_.name, out.material = mesh_.material;
    return out;
}

Mesh MeshCut::kept() const {
    if (mesh_.splats != nullptr) return kept_splats();
    KeptMesh out(mesh_);
    const std::size_t corners = corners_of(mesh_.topology);
    TimeCheck check;
    const auto cut = [&](std::uint32_t kept, std::uint32_t removed) {
        return out.cut(kept, removed, share(kept, removed), cut_point(kept, removed).object);
    };
    for (std::size_t i = 0; i + corners <= mesh_.indices.size(); i += corners) {
        check();
        const std::uint32_t* const at = &mesh_.indices[i];
        if (!is_finite(at, corners)) continue;
        if (corners == 1) {
            if (is_kept(at[0])) out.index(out.copy(at[0]));
            continue;
        }
        if (corners == 2) {
            if (!is_kept(at[0]) && !is_kept(at[1])) continue;
            out.index(is_kept(at[0]) ? out.copy(at[0]) : cut(at[1], at[0]));
            out.index(is_kept(at[1]) ? out.copy(at[1]) : cut(at[0], at[1]));
            continue;
        }
        if (is_dropped_face(at)) continue;
        std::uint32_t polygon[4];
        int n = 0;
        for (int c = 0; c < 3; ++c) {
            const std::uint32_t v = at[c], next = at[(c + 1) % 3];
            if (is_kept(v)) polygon[n++] = out.copy(v);
            if (is_kept(v) != is_kept(next)) polygon[n++] = is_kept(v) ? cut(v, next) : cut(next, v);
        }
        if (n >= 3) out.triangle(polygon[0], polygon[1], polygon[2]);
        if (n == 4) out.triangle(polygon[0], polygon[2], polygon[3]);
    }
    return out.take();
}

void MeshCut::add_section(std::vector<CutSegment>& segments) const {
    if (mesh_.topology != Topology::triangles) return;
    const auto add = [&](const CutPoint& from, const CutPoint& to) {
        if (from.world != to.world) segments.push_back(mirrors_ ? CutSegment{to, from} : CutSegment{from, to});
    };
    TimeCheck check;
    for (std::size_t i = 0; i + 3 <= mesh_.indices.size(); i += 3) {
        check();
        const std::uint32_t* const at = &mesh_.indices[i];
        const int kept = is_kept(at[0]) + is_kept(at[1]) + is_kept(at[2]);
        if (kept == 0 || !is_finite(at, 3)) continue;
        if (kept == 3) {
            if (!is_dropped_face(at)) continue;
            for (int c = 0; c < 3; ++c) add(vertex(at[c]), vertex(at[(c + 1) % 3]));
            continue;
        }
        CutPoint entry, exit;
        for (int c = 0; c < 3; ++c) {
            const std::uint32_t v = at[c], next = at[(c + 1) % 3];
            if (is_kept(v) && !is_kept(next)) exit = cut_point(v, next);
            if (!is_kept(v) && is_kept(next)) entry = cut_point(next, v);
        }
        add(entry, exit);  // the other way than the kept part of the triangle has it
    }
}

}  // namespace halflit::raster
