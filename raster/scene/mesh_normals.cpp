#include "halflit/mesh.hpp"

#include "sh/fp_environment.hpp"
#include "sh/place_table.hpp"
#include "sh/time_limit.hpp"
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
    TimeCheck check;
    for (const std::uint32_t index : indices) {
        check();
        spread.push_back(values[index]);
    }
    values = std::move(spread);
}

/// Normal of a triangle. In double, so that the squares of any finite float edge stay finite and above zero.
Vec3f triangle_normal(Vec3f a, Vec3f b, Vec3f c) {
    const Vec3d n = cross(to_double(b) - to_double(a), to_double(c) - to_double(a));
    const double len = length(n);
    if (!(len > 0.0) || !(len < 1e300)) return {0, 0, 1};
    return {static_cast<float>(n.x / len), static_cast<float>(n.y / len), static_cast<float>(n.z / len)};
}

/// For each vertex the first one that has its position.
std::vector<std::uint32_t> places_of(const std::vector<Vec3f>& positions) {
    PlaceTable<Vec3f> table;
    table.reserve(positions.size(), positions);
    std::vector<std::uint32_t> places(positions.size());
    TimeCheck check;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        check();
        if (v + 16 < positions.size()) table.prefetch(positions[v + 16]);
        places[v] = table.find(positions[v], static_cast<std::uint32_t>(v), positions);
    }
    return places;
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
    TimeCheck check;
    for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
        check();
        const Vec3f n = triangle_normal(mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]);
        mesh.normals[i] = mesh.normals[i + 1] = mesh.normals[i + 2] = n;
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) mesh.indices[i] = static_cast<std::uint32_t>(i);
}

void generate_smooth_normals(Mesh& mesh) {
    const FpEnvironment environment_of_host;
    if (mesh.topology != Topology::triangles) return;
    const std::vector<std::uint32_t> places = places_of(mesh.positions);
    // By vertices, and by places: where one surface is split into several vertices, as at a seam of texture coordinates.
    std::vector<Vec3d> sums(mesh.positions.size()), place_sums(mesh.positions.size());
    TimeCheck check;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        check();
        const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        const Vec3d p = to_double(mesh.positions[a]);
        const Vec3d twice_area = cross(to_double(mesh.positions[b]) - p, to_double(mesh.positions[c]) - p);
        for (const std::uint32_t corner : {a, b, c}) {
            sums[corner] = sums[corner] + twice_area;
            place_sums[places[corner]] = place_sums[places[corner]] + twice_area;
        }
    }
    mesh.normals.clear();
    mesh.normals.reserve(sums.size());
    for (std::size_t v = 0; v < sums.size(); ++v) {
        check();
        // The back of a sheet, whose triangles face the other way, keeps a normal of its own.
        const Vec3d& of_place = place_sums[places[v]];
        const Vec3d& sum = dot(of_place, sums[v]) > 0.0 ? of_place : sums[v];
        const double size = length(sum);
        mesh.normals.push_back(size > 0.0 && size < 1e300 ? to_float(sum * (1.0 / size)) : Vec3f{0, 1, 0});
    }
}

}  // namespace halflit
