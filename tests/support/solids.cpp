#include "tests/support/solids.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace halflit::test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

Vec3d at(Point2 p, double z) { return {p[0], p[1], z}; }

Mat4 random_turn(Random& random) {
    const Vec3f axis{random.real32(-1, 1), random.real32(-1, 1), random.real32(0.1, 1)};
    return rotation(axis, random.real32(0, kTurn));
}

/// A sheet of n x n quads with a wave, open all around.
Mesh wavy_sheet(Random& random, int n) {
    SolidBuilder builder;
    const double height = random.real(0.0, 0.4);
    const auto point = [&](int i, int k) {
        const double x = 2.0 * i / n - 1.0, y = 2.0 * k / n - 1.0;
        return Vec3d{x, y, height * std::sin(4.0 * x) * std::cos(3.0 * y)};
    };
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) builder.quad(point(i, k), point(i + 1, k), point(i + 1, k + 1), point(i, k + 1));
    return builder.take();
}

Mesh holed(Random& random, const Mesh& mesh) {
    std::vector<std::size_t> out;
    const double share = random.real(0.02, 0.2);
    for (std::size_t i = 0; i < mesh.indices.size() / 3; ++i)
        if (random.chance(share)) out.push_back(i);
    return without_triangles(mesh, out);
}

/// A small body within a larger one.
Mesh nested(Random& random) {
    SolidBuilder builder;
    builder.append(box_mesh({-1, -1, -1}, {1, 1, 1}, 3));
    Mesh inner = ball_mesh(random.real(0.2, 0.7), 2);
    if (random.chance(0.5)) flip(inner);
    builder.append(inner);
    return builder.take();
}

}  // namespace

void SolidBuilder::triangle(Vec3d a, Vec3d b, Vec3d c) {
    for (const Vec3d& p : {a, b, c}) {
        mesh_.indices.push_back(static_cast<std::uint32_t>(mesh_.positions.size()));
        mesh_.positions.push_back(to_float(p));
    }
}

void SolidBuilder::quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
    triangle(a, b, c);
    triangle(a, c, d);
}

void SolidBuilder::grid(Vec3d a, Vec3d b, Vec3d c, Vec3d d, int n) {
    const auto point = [&](int i, int k) {
        const double s = static_cast<double>(i) / n, t = static_cast<double>(k) / n;
        return (a * (1 - s) + b * s) * (1 - t) + (d * (1 - s) + c * s) * t;
    };
    for (int k = 0; k < n; ++k)
        for (int i = 0; i < n; ++i) quad(point(i, k), point(i + 1, k), point(i + 1, k + 1), point(i, k + 1));
}

void SolidBuilder::append(const Mesh& mesh) {
    for (const std::uint32_t index : mesh.indices) {
        mesh_.indices.push_back(static_cast<std::uint32_t>(mesh_.positions.size()));
        mesh_.positions.push_back(mesh.positions[index]);
    }
}

Mesh SolidBuilder::take() {
    generate_flat_normals(mesh_);
    return std::move(mesh_);
}

Mesh box_mesh(Vec3d l, Vec3d h, int n) {
    SolidBuilder builder;
    builder.grid({l.x, h.y, l.z}, {h.x, h.y, l.z}, {h.x, l.y, l.z}, {l.x, l.y, l.z}, n);
    builder.grid({l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z}, n);
    builder.grid({l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z}, n);
    builder.grid({h.x, h.y, l.z}, {l.x, h.y, l.z}, {l.x, h.y, h.z}, {h.x, h.y, h.z}, n);
    builder.grid({h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z}, {h.x, l.y, h.z}, n);
    builder.grid({l.x, h.y, l.z}, {l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, n);
    return builder.take();
}

Mesh prism_mesh(std::span<const Point2> outer, std::span<const Point2> inner, double low, double high) {
    SolidBuilder builder;
    for (std::size_t i = 0; i < outer.size(); ++i) {
        const std::size_t next = (i + 1) % outer.size();
        const Point2 a = outer[i], b = outer[next];
        builder.quad(at(a, low), at(b, low), at(b, high), at(a, high));
        if (inner.empty()) {
            builder.triangle(at({0, 0}, high), at(a, high), at(b, high));
            builder.triangle(at({0, 0}, low), at(b, low), at(a, low));
            continue;
        }
        const Point2 c = inner[next], d = inner[i];
        builder.quad(at(a, high), at(b, high), at(c, high), at(d, high));
        builder.quad(at(d, low), at(c, low), at(b, low), at(a, low));
        builder.quad(at(c, low), at(d, low), at(d, high), at(c, high));
    }
    return builder.take();
}

std::vector<Point2> circle(double radius, int points, Point2 middle) {
    std::vector<Point2> out;
    for (int i = 0; i < points; ++i)
        out.push_back({middle[0] + radius * std::cos(kTurn * i / points), middle[1] + radius * std::sin(kTurn * i / points)});
    return out;
}

std::vector<Point2> gear_contour(double root, double tip, int teeth) {
    std::vector<Point2> out;
    for (int i = 0; i < 4 * teeth; ++i) {
        const double radius = i % 4 < 2 ? root : tip, angle = kTurn * (i + (i % 2 == 0 ? 0.15 : -0.15)) / (4 * teeth);
        out.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return out;
}

Mesh torus_mesh(double radius, double tube, int around, int across) {
    SolidBuilder builder;
    const auto point = [&](int i, int k) {
        const double u = kTurn * (i % around) / around, v = kTurn * (k % across) / across, r = radius + tube * std::cos(v);
        return Vec3d{r * std::cos(u), r * std::sin(u), tube * std::sin(v)};
    };
    for (int i = 0; i < around; ++i)
        for (int k = 0; k < across; ++k) builder.quad(point(i, k), point(i + 1, k), point(i + 1, k + 1), point(i, k + 1));
    return builder.take();
}

Mesh ball_mesh(double radius, int level) {
    const double t = (1.0 + std::sqrt(5.0)) / 2.0;
    const Vec3d p[] = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                       {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
    constexpr int kFaces[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    SolidBuilder builder;
    const auto on_ball = [&](Vec3d q) { return q * (radius / length(q)); };
    const auto split = [&](auto&& self, Vec3d a, Vec3d b, Vec3d c, int left) -> void {
        if (left == 0) return builder.triangle(a, b, c);
        const Vec3d ab = on_ball(a + b), bc = on_ball(b + c), ca = on_ball(c + a);
        self(self, a, ab, ca, left - 1);
        self(self, ab, b, bc, left - 1);
        self(self, ca, bc, c, left - 1);
        self(self, ab, bc, ca, left - 1);
    };
    for (const auto& face : kFaces) split(split, on_ball(p[face[0]]), on_ball(p[face[1]]), on_ball(p[face[2]]), level);
    return builder.take();
}

void flip(Mesh& mesh) {
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    generate_flat_normals(mesh);
}

Mesh without_triangles(const Mesh& mesh, std::span<const std::size_t> left_out) {
    Mesh out = mesh;
    out.indices.clear();
    for (std::size_t i = 0; i < mesh.indices.size() / 3; ++i)
        if (std::find(left_out.begin(), left_out.end(), i) == left_out.end())
            for (std::size_t k = 0; k < 3; ++k) out.indices.push_back(mesh.indices[3 * i + k]);
    return out;
}

void move(Mesh& mesh, Vec3d by) {
    for (Vec3f& p : mesh.positions) p = to_float(to_double(p) + by);
}

// Numbers are drawn into variables: the order of a call's arguments differs between compilers.
Mesh random_closed_solid(Random& random) {
    const int kind = random.index(5), around = static_cast<int>(random.integer(5, 40)), across = static_cast<int>(random.integer(4, 10));
    const double first = random.real(0, 1), second = random.real(0, 1);
    const int teeth = std::max(5, around / 2);
    if (kind == 0) return box_mesh({-1, -0.2 - 0.8 * first, -0.2 - 0.8 * second}, {1, 1, 1}, 1 + across % 4);
    if (kind == 1) return prism_mesh(circle(1, around), {}, -0.1 - 0.9 * first, 1);
    if (kind == 2) return torus_mesh(0.7, 0.05 + 0.25 * first, around, across);
    if (kind == 3) return ball_mesh(1, across % 3);
    return prism_mesh(gear_contour(0.75, 1, teeth), circle(0.1 + 0.5 * first, 4 * teeth), -0.3, -0.2 + 0.8 * second);
}

Mesh random_solid(Random& random) {
    const int kind = random.index(9), pieces = static_cast<int>(random.integer(2, 10));
    const double thickness = random.real(1e-4, 0.02);
    const bool other = random.chance(0.5);
    if (kind == 0) return holed(random, other ? ball_mesh(1, 2) : box_mesh({-1, -1, -1}, {1, 1, 1}, 4));
    if (kind == 1) return nested(random);
    if (kind == 2) {  // a thin wall
        const Mesh wall = box_mesh({-1, -1, 0}, {1, 1, thickness}, 1 + pieces % 4);
        return other ? wall : holed(random, wall);
    }
    if (kind == 3) return wavy_sheet(random, pieces);
    return random_closed_solid(random);
}

Scene random_model(std::uint64_t seed) {
    Random random(seed);
    Scene scene;
    scene.materials.resize(3);
    scene.materials[1].double_sided = true;
    scene.materials[2].alpha_mode = AlphaMode::blend;
    scene.materials[2].base_color.w = 0.5f;
    const int bodies = static_cast<int>(random.integer(1, 5));
    for (int i = 0; i < bodies; ++i) {
        Mesh mesh = random_solid(random);
        if (random.chance(0.05)) flip(mesh);
        mesh.material = random.chance(0.3) ? 1 : random.chance(0.08) ? 2 : 0;
        scene.meshes.push_back(std::move(mesh));
        for (int copies = random.chance(0.25) ? 3 : 1; copies > 0; --copies) {
            Instance instance;
            instance.mesh = i;
            Vec3f scale{random.real32(0.3, 1.5), random.real32(0.3, 1.5), random.real32(0.3, 1.5)};
            if (random.chance(0.25)) scale.x = -scale.x;
            const double reach = random.chance(0.3) ? 0.3 : 2.5;  // bodies go through each other
            const Vec3f place{random.real32(-reach, reach), random.real32(-reach, reach), random.real32(-reach, reach)};
            instance.world_from_object = translation(place) * (random.chance(0.4) ? Mat4{} : random_turn(random)) * scaling(scale);
            instance.visible = scene.instances.empty() || !random.chance(0.05);
            scene.instances.push_back(instance);
        }
    }
    return scene;
}

}  // namespace halflit::test
