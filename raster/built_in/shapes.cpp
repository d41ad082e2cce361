#include "halflit/shapes.hpp"

#include "sh/fp_environment.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <cstdlib>

namespace halflit {
namespace {

/// Step `i` of `count` around the circle. Step `count` equals step 0 bit for bit, so that seams close.
SinCos circle_step(int i, int count) { return sin_cos(2.0 * kPi * static_cast<double>(i % count) / static_cast<double>(count)); }

float fraction(int i, int count) { return static_cast<float>(static_cast<double>(i) / static_cast<double>(count)); }

void reserve(Mesh& mesh, std::size_t vertices, std::size_t triangles) {
    mesh.positions.reserve(vertices);
    mesh.normals.reserve(vertices);
    mesh.uv0.reserve(vertices);
    mesh.indices.reserve(3 * triangles);
}

void add_vertex(Mesh& mesh, Vec3f position, Vec3f normal, Vec2f uv) {
    mesh.positions.push_back(position);
    mesh.normals.push_back(normal);
    mesh.uv0.push_back(uv);
}

void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) { mesh.indices.insert(mesh.indices.end(), {a, b, c}); }

/// Two triangles for each cell of a grid of (columns + 1) x (rows + 1) vertices in row order. Seen from outside, columns run to the
/// right and rows down. poles: the vertices of the first row are at one point, and so are those of the last row. A cell there is one
/// triangle, whose corner at the pole is the vertex of the cell's column.
void add_grid(Mesh& mesh, int columns, int rows, bool poles) {
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (columns + 1) + i);
            const std::uint32_t b = a + 1, c = a + static_cast<std::uint32_t>(columns) + 1, d = c + 1;
            const bool last_row = poles && j == rows - 1;
            add_triangle(mesh, a, c, last_row ? b : d);
            if (!last_row && !(poles && j == 0)) add_triangle(mesh, a, d, b);
        }
}

}  // namespace

Mesh make_sphere(float radius, int slices, int stacks) {
    const FpEnvironment environment_of_host;
    slices = std::max(slices, 3);
    stacks = std::max(stacks, 2);
    Mesh mesh;
    mesh.name = "sphere";
    reserve(mesh, static_cast<std::size_t>(slices + 1) * static_cast<std::size_t>(stacks + 1),
            2 * static_cast<std::size_t>(slices) * static_cast<std::size_t>(stacks - 1));
    for (int j = 0; j <= stacks; ++j) {
        const bool pole = j == 0 || j == stacks;
        const SinCos polar = sin_cos(kPi * static_cast<double>(j) / static_cast<double>(stacks));
        const double ring = pole ? 0.0 : polar.sin;
        const double height = j == 0 ? 1.0 : j == stacks ? -1.0 : polar.cos;
        for (int i = 0; i <= slices; ++i) {
            const SinCos around = circle_step(i, slices);
            const Vec3d n{ring * around.sin, height, ring * around.cos};
            // In the texture the corner at the pole is above the middle of its triangle's base.
            const float u = pole ? fraction(2 * i + 1, 2 * slices) : fraction(i, slices);
            add_vertex(mesh, to_float(n * static_cast<double>(radius)), to_float(n), {u, fraction(j, stacks)});
        }
    }
    add_grid(mesh, slices, stacks, true);
    return mesh;
}

Mesh make_sphere_of(float radius, std::int64_t triangles) {
    const FpEnvironment environment_of_host;
    triangles = std::clamp<std::int64_t>(triangles, 12, std::int64_t{1} << 26);
    // Square quads have slices = 2 * stacks, so stacks is near sqrt(triangles / 4). Values within a tenth of it are searched for the best.
    std::int64_t even = 2;
    while (4 * even * even < triangles) ++even;
    int best_slices = 3, best_stacks = 3;
    std::int64_t best_miss = triangles;
    for (std::int64_t step = 0; step <= even / 10; ++step)
        for (const std::int64_t stacks : {even + step, even - step}) {
            if (stacks < 2) continue;
            const std::int64_t per_slice = 2 * (stacks - 1);
            const std::int64_t slices = std::max<std::int64_t>(3, (triangles + per_slice / 2) / per_slice);
            const std::int64_t miss = std::abs(slices * per_slice - triangles);
            if (miss >= best_miss) continue;
            best_miss = miss;
            best_slices = static_cast<int>(slices);
            best_stacks = static_cast<int>(stacks);
        }
    return make_sphere(radius, best_slices, best_stacks);
}

Mesh make_plane(float half_size, int subdivisions) {
    const FpEnvironment environment_of_host;
    subdivisions = std::max(subdivisions, 1);
    Mesh mesh;
    mesh.name = "plane";
    const auto side = static_cast<std::size_t>(subdivisions);
    reserve(mesh, (side + 1) * (side + 1), 2 * side * side);
    for (int j = 0; j <= subdivisions; ++j)
        for (int i = 0; i <= subdivisions; ++i) {
            const float u = fraction(i, subdivisions), v = fraction(j, subdivisions);
            add_vertex(mesh, {half_size * (2.0f * u - 1.0f), 0.0f, half_size * (2.0f * v - 1.0f)}, {0, 1, 0}, {u, v});
        }
    add_grid(mesh, subdivisions, subdivisions, false);
    return mesh;
}

Mesh make_box(Vec3f half_extents) {
    const FpEnvironment environment_of_host;
    // A face is given by the directions in which u and v grow, seen from outside. cross(down, right) is the outward normal.
    struct Face {
        Vec3f right, down;
    };
    constexpr Face kFaces[6] = {{{0, 0, -1}, {0, -1, 0}}, {{0, 0, 1}, {0, -1, 0}}, {{1, 0, 0}, {0, 0, 1}},
                                {{1, 0, 0}, {0, 0, -1}},  {{1, 0, 0}, {0, -1, 0}}, {{-1, 0, 0}, {0, -1, 0}}};
    Mesh mesh;
    mesh.name = "box";
    reserve(mesh, 24, 12);
    for (const Face& face : kFaces) {
        const Vec3f normal = cross(face.down, face.right);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const float v : {0.0f, 1.0f})
            for (const float u : {0.0f, 1.0f}) {
                const Vec3f corner = (normal + face.right * (2.0f * u - 1.0f)) + face.down * (2.0f * v - 1.0f);
                add_vertex(mesh, corner * half_extents, normal, {u, v});
            }
        add_triangle(mesh, first, first + 2, first + 3);
        add_triangle(mesh, first, first + 3, first + 1);
    }
    return mesh;
}

Mesh make_torus(float radius, float tube, int slices, int sides) {
    const FpEnvironment environment_of_host;
    slices = std::max(slices, 3);
    sides = std::max(sides, 3);
    Mesh mesh;
    mesh.name = "torus";
    reserve(mesh, static_cast<std::size_t>(slices + 1) * static_cast<std::size_t>(sides + 1),
            2 * static_cast<std::size_t>(slices) * static_cast<std::size_t>(sides));
    for (int j = 0; j <= sides; ++j) {
        const SinCos over = circle_step(j, sides);  // from the inner rim (cos = 1 points to the axis) upwards
        for (int i = 0; i <= slices; ++i) {
            const SinCos around = circle_step(i, slices);
            const Vec3d n{-over.cos * around.sin, over.sin, -over.cos * around.cos};
            const Vec3d ring{static_cast<double>(radius) * around.sin, 0.0, static_cast<double>(radius) * around.cos};
            add_vertex(mesh, to_float(ring + n * static_cast<double>(tube)), to_float(n), {fraction(i, slices), fraction(j, sides)});
        }
    }
    add_grid(mesh, slices, sides, false);
    return mesh;
}

}  // namespace halflit
