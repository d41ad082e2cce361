#include "apps/io/gltf/build/vertex_values.hpp"

#include "sh/vec3d.hpp"
#include "shading/model/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace halflit::io::detail {

namespace {

using shading::finite;
bool finite(Vec2f v) { return finite(v.x) && finite(v.y); }
bool finite(Vec4f v) { return finite(Vec3f{v.x, v.y, v.z}) && finite(v.w); }

template <class T, class Good>
void warn_unless(Document& document, const std::string& list, const char* name, const std::vector<T>& values, const Good& good,
                 const char* what) {
    std::size_t bad = 0, first = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!good(values[i]) && bad++ == 0) first = i;
    if (bad > 0)
        document.warn(fmt::format("{}.{}: {} of {} values {}, the first is number {}", list, name, bad, values.size(), what, first));
}

template <class T>
void warn_unless_finite(Document& document, const std::string& list, const char* name, const std::vector<T>& values) {
    warn_unless(
        document, list, name, values, [](const T& v) { return finite(v); }, "are not finite");
}

/// Length 1 within 5 %: a direction in 8-bit integers is wrong by up to 1 %, and one that is interpolated by an exporter by a little more.
template <class T>
bool is_unit(const T& v) {
    const float length2 = (v.x * v.x + v.y * v.y) + v.z * v.z;
    return length2 > 0.95f * 0.95f && length2 < 1.05f * 1.05f;
}

}  // namespace

void warn_of_values(Document& document, const std::string& list, const Mesh& mesh) {
    warn_unless_finite(document, list, "POSITION", mesh.positions);
    warn_unless_finite(document, list, "TEXCOORD_0", mesh.uv0);
    warn_unless_finite(document, list, "TEXCOORD_1", mesh.uv1);
    warn_unless_finite(document, list, "COLOR_0", mesh.colors);
    warn_unless(document, list, "NORMAL", mesh.normals, is_unit<Vec3f>, "are not of length 1");
    warn_unless(document, list, "TANGENT", mesh.tangents, is_unit<Vec4f>, "are not of length 1");
    warn_unless(
        document, list, "TANGENT", mesh.tangents, [](Vec4f t) { return t.w == 1.0f || t.w == -1.0f; }, "have a sign other than 1 and -1");
}

void mend_zero_directions(Document& document, const std::string& list, Mesh& mesh) {
    if (document.options.strict) return;
    const auto is_zero = [](const auto& v) { return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f; };
    const auto zeros = [&](const auto& values) { return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), is_zero)); };
    const std::size_t normals = zeros(mesh.normals), tangents = zeros(mesh.tangents);
    const auto warn = [&](const char* name, std::size_t count, std::size_t of, const char* instead) {
        document.warn(fmt::format("{}.{}: {} of {} directions are 0; {}", list, name, count, of, instead));
    };
    if (2 * tangents > mesh.tangents.size()) {
        warn("TANGENT", tangents, mesh.tangents.size(), "made anew where they are needed");
        mesh.tangents.clear();
    }
    if (normals == 0) return;
    if (2 * normals > mesh.normals.size()) {
        warn("NORMAL", normals, mesh.normals.size(), "drawn with those of the triangles");
        mesh.normals.clear();
        mesh.tangents.clear();  // they have no meaning without normals
        return;
    }
    if (mesh.topology != Topology::triangles) return;
    warn("NORMAL", normals, mesh.normals.size(), "these are the means of their triangles'");
    std::vector<Vec3d> sums(mesh.normals.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto at = [&](std::size_t corner) { return to_double(mesh.positions[mesh.indices[i + corner]]); };
        const Vec3d normal = cross(at(1) - at(0), at(2) - at(0));
        for (std::size_t c = 0; c < 3; ++c)
            if (const std::uint32_t v = mesh.indices[i + c]; is_zero(mesh.normals[v])) sums[v] = sums[v] + normal;
    }
    for (std::size_t v = 0; v < sums.size(); ++v) {
        const double size = length(sums[v]);
        if (is_zero(mesh.normals[v]) && size > 1e-200 && size < 1e200) mesh.normals[v] = to_float(sums[v] * (1.0 / size));
    }
}

}  // namespace halflit::io::detail
