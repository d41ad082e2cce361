#include "halflit/mesh.hpp"

#include "sh/fp_environment.hpp"
#include "sh/vec3d.hpp"

#include <cstddef>
#include <utility>

namespace halflit {

namespace {

template <class T>
void unshare(std::vector<T>& values, const std::vector<std::uint32_t>& indices) {
    if (values.empty()) return;
    std::vector<T> spread;
    spread.reserve(indices.size());
    for (const std::uint32_t index : indices) spread.push_back(values[index]);
    values = std::move(spread);
}

/// Normal of a triangle. In double, so that the squares of any finite float edge stay finite and above zero.
Vec3f triangle_normal(Vec3f a, Vec3f b, Vec3f c) {
    const Vec3d n = cross(to_double(b) - to_double(a), to_double(c) - to_double(a));
    const double len = length(n);
    if (!(len > 0.0) || !(len < 1e300)) return {0, 0, 1};
    return {static_cast<float>(n.x / len), static_cast<float>(n.y / len), static_cast<float>(n.z / len)};
}

}  // namespace

void generate_flat_normals(Mesh& mesh) {
    const FpEnvironment environment_of_host;
    if (mesh.topology != Topology::triangles) return;
    unshare(mesh.positions, mesh.indices);
    unshare(mesh.uv0, mesh.indices);
    unshare(mesh.uv1, mesh.indices);
    unshare(mesh.colors, mesh.indices);
    mesh.tangents = {};
    mesh.normals.assign(mesh.positions.size(), Vec3f{0, 0, 1});
    for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
        const Vec3f n = triangle_normal(mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]);
        mesh.normals[i] = mesh.normals[i + 1] = mesh.normals[i + 2] = n;
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) mesh.indices[i] = static_cast<std::uint32_t>(i);
}

void generate_smooth_normals(Mesh& mesh) {
    const FpEnvironment environment_of_host;
    if (mesh.topology != Topology::triangles) return;
    std::vector<Vec3d> sums(mesh.positions.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        const Vec3d p = to_double(mesh.positions[a]);
        const Vec3d twice_area = cross(to_double(mesh.positions[b]) - p, to_double(mesh.positions[c]) - p);
        for (const std::uint32_t corner : {a, b, c}) sums[corner] = sums[corner] + twice_area;
    }
    mesh.normals.clear();
    mesh.normals.reserve(sums.size());
    for (const Vec3d& sum : sums) {
        const double size = length(sum);
        mesh.normals.push_back(size > 0.0 && size < 1e300 ? to_float(sum * (1.0 / size)) : Vec3f{0, 1, 0});
    }
}

}  // namespace halflit
