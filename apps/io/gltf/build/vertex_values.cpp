#include "apps/io/gltf/build/vertex_values.hpp"

#include "shading/model/numbers.hpp"

#include <fmt/format.h>

#include <cstddef>
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

}  // namespace halflit::io::detail
