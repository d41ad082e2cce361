#include "apps/io/gltf/build/vertex_values.hpp"

#include "sh/vec3d.hpp"
#include "shading/model/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace halflit::io::detail {

namespace {

using shading::finite;
bool finite(Vec2f v) { return finite(v.x) && finite(v.y); }
bool finite(Vec4f v) { return finite(Vec3f{v.x, v.y, v.z}) && finite(v.w); }

template <class T, class Bad>
std::size_t count_of(const std::vector<T>& values, const Bad& bad) {
    return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), bad));
}

/// A text about the bad ones among values; empty if there are none.
template <class T, class Bad>
std::string found_in(const std::string& list, const char* name, const std::vector<T>& values, const Bad& bad, const char* what) {
    const auto first = std::find_if(values.begin(), values.end(), bad);
    if (first == values.end()) return "";
    return fmt::format("{}.{}: {} of {} values {}, the first is number {}", list, name, count_of(values, bad), values.size(), what,
                       first - values.begin());
}

template <class T, class Bad>
void warn_of(Document& document, const std::string& list, const char* name, const std::vector<T>& values, const Bad& bad,
             const char* what) {
    if (std::string found = found_in(list, name, values, bad, what); !found.empty()) document.warn(std::move(found));
}

constexpr auto kNotFinite = [](const auto& v) { return !finite(v); };
constexpr const char* kAreNotFinite = "are not finite";

template <class T>
void refuse_not_finite(const std::string& list, const char* name, const std::vector<T>& values) {
    if (const std::string found = found_in(list, name, values, kNotFinite, kAreNotFinite); !found.empty()) refuse("", found);
}

/// neutral: stands for what is not finite; null: it stays.
template <class T>
void mend(Document& document, const std::string& list, const char* name, std::vector<T>& values, const T* neutral, const char* instead) {
    const std::string found = found_in(list, name, values, kNotFinite, kAreNotFinite);
    if (found.empty()) return;
    document.go_on_without({{ErrorCode::bad_input, found}}, instead);
    if (neutral != nullptr) std::replace_if(values.begin(), values.end(), kNotFinite, *neutral);
}

/// Length 1 within 5 %: a direction in 8-bit integers is wrong by up to 1 %, and one that is interpolated by an exporter by a little more.
template <class T>
bool is_unit(const T& v) {
    const float length2 = (v.x * v.x + v.y * v.y) + v.z * v.z;
    return length2 > 0.95f * 0.95f && length2 < 1.05f * 1.05f;
}

/// Neither 0 nor NaN, with a square that float holds well.
template <class T>
bool has_direction(const T& v) {
    const float length2 = (v.x * v.x + v.y * v.y) + v.z * v.z;
    return length2 > 1e-30f && length2 < 1e30f;
}

/// Finite, and too long for has_direction(). (What is too short stands for 0.)
template <class T>
bool is_long(const T& v) {
    const double square = dot(Vec3d{v.x, v.y, v.z}, Vec3d{v.x, v.y, v.z});
    return square > 0.99e30 && square < std::numeric_limits<double>::infinity();
}

template <class T>
void shorten(std::vector<T>& directions) {
    for (T& v : directions) {
        if (!is_long(v)) continue;
        const Vec3d wide{v.x, v.y, v.z};
        const Vec3f unit = to_float(wide * (1.0 / length(wide)));
        v.x = unit.x, v.y = unit.y, v.z = unit.z;
    }
}

bool usable(double length) { return length > 1e-200 && length < 1e200; }

/// For each vertex the sum of of_triangle(corners) over its triangles.
template <class Of>
std::vector<Vec3d> sums_at(const Mesh& mesh, const Of& of_triangle) {
    std::vector<Vec3d> sums(mesh.positions.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Vec3d of = of_triangle(&mesh.indices[i]);
        if (!shading::finite(of)) continue;
        for (std::size_t c = 0; c < 3; ++c) sums[mesh.indices[i + c]] = sums[mesh.indices[i + c]] + of;
    }
    return sums;
}

Vec3d edge(const Mesh& mesh, const std::uint32_t* corners, int to) {
    return to_double(mesh.positions[corners[to]]) - to_double(mesh.positions[corners[0]]);
}

void make_normals(Mesh& mesh) {
    std::vector<Vec3d> sums(mesh.normals.size());
    if (mesh.topology == Topology::triangles)
        sums = sums_at(mesh, [&](const std::uint32_t* corners) { return cross(edge(mesh, corners, 1), edge(mesh, corners, 2)); });
    for (std::size_t v = 0; v < sums.size(); ++v)
        if (!has_direction(mesh.normals[v]))
            mesh.normals[v] = usable(length(sums[v])) ? to_float(sums[v] * (1.0 / length(sums[v]))) : Vec3f{0, 0, 1};
}

/// The direction in which u grows, across the normal.
void make_tangents(Mesh& mesh) {
    const std::vector<Vec2f>& uv = mesh.uv0.empty() ? mesh.uv1 : mesh.uv0;
    std::vector<Vec3d> sums(mesh.tangents.size());
    if (!uv.empty() && mesh.topology == Topology::triangles)
        sums = sums_at(mesh, [&](const std::uint32_t* corners) {
            const auto v = [&](int to) { return double{uv[corners[to]].y} - double{uv[corners[0]].y}; };
            const auto u = [&](int to) { return double{uv[corners[to]].x} - double{uv[corners[0]].x}; };
            const Vec3d along = edge(mesh, corners, 1) * v(2) - edge(mesh, corners, 2) * v(1);
            return u(1) * v(2) - u(2) * v(1) < 0.0 ? along * -1.0 : along;
        });
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (has_direction(mesh.tangents[i])) continue;
        const Vec3d n = to_double(mesh.normals[i]), side = n.x * n.x > n.y * n.y ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
        Vec3d along = sums[i] * dot(n, n) - n * dot(n, sums[i]);
        if (!usable(length(along))) along = side * dot(n, n) - n * dot(n, side);
        const Vec3f t = to_float(along * (1.0 / length(along)));
        mesh.tangents[i] = {t.x, t.y, t.z, mesh.tangents[i].w};
    }
}

}  // namespace

void mend_values(Document& document, const std::string& list, Mesh& mesh) {
    constexpr Vec2f kOrigin{};
    constexpr Vec4f kWhite{1, 1, 1, 1};
    mend(document, list, "POSITION", mesh.positions, static_cast<const Vec3f*>(nullptr), "their triangles are not drawn");
    mend(document, list, "TEXCOORD_0", mesh.uv0, &kOrigin, "read as 0");
    mend(document, list, "TEXCOORD_1", mesh.uv1, &kOrigin, "read as 0");
    mend(document, list, "COLOR_0", mesh.colors, &kWhite, "read as white");
    // mend_directions() warns of directions of length 0.
    const auto not_unit = [strict = document.options.strict](const auto& v) {
        return (strict || has_direction(v) || is_long(v)) && !is_unit(v);
    };
    warn_of(document, list, "NORMAL", mesh.normals, not_unit, "are not of length 1");
    warn_of(document, list, "TANGENT", mesh.tangents, not_unit, "are not of length 1");
    warn_of(
        document, list, "TANGENT", mesh.tangents, [](Vec4f t) { return t.w != 1.0f && t.w != -1.0f; }, "have a sign other than 1 and -1");
    mend_directions(document, list, mesh);
}

template <class T>
void mend_deltas(Document& document, const std::string& list, const char* name, std::vector<T>& values) {
    constexpr T kNone{};
    mend(document, list, name, values, &kNone, "read as 0");
}
template void mend_deltas(Document&, const std::string&, const char*, std::vector<Vec2f>&);
template void mend_deltas(Document&, const std::string&, const char*, std::vector<Vec3f>&);
template void mend_deltas(Document&, const std::string&, const char*, std::vector<Vec4f>&);

void mend_directions(Document& document, const std::string& list, Mesh& mesh) {
    shorten(mesh.normals);
    shorten(mesh.tangents);
    if (document.options.strict) {
        refuse_not_finite(list, "NORMAL", mesh.normals);
        refuse_not_finite(list, "TANGENT", mesh.tangents);
        return;
    }
    const auto lacking = [](const auto& v) { return !has_direction(v); };
    const std::size_t normals = count_of(mesh.normals, lacking), tangents = count_of(mesh.tangents, lacking);
    const auto warn = [&](const char* name, std::size_t count, std::size_t of, const char* instead) {
        document.warn(fmt::format("{}.{}: {} of {} directions are 0 or not finite; {}", list, name, count, of, instead));
    };
    if (2 * tangents > mesh.tangents.size()) {
        warn("TANGENT", tangents, mesh.tangents.size(), "made anew where they are needed");
        mesh.tangents.clear();
    }
    if (2 * normals > mesh.normals.size()) {
        warn("NORMAL", normals, mesh.normals.size(), "drawn with those of the triangles");
        mesh.normals.clear();
        mesh.tangents.clear();  // they have no meaning without normals
        return;
    }
    if (normals > 0) {
        warn("NORMAL", normals, mesh.normals.size(), "these are the means of their triangles'");
        make_normals(mesh);
    }
    if (tangents > 0 && !mesh.tangents.empty()) {
        warn("TANGENT", tangents, mesh.tangents.size(), "these are the means of their triangles'");
        make_tangents(mesh);
    }
}

}  // namespace halflit::io::detail
