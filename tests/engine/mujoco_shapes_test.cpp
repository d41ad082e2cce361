// Shapes of MuJoCo's renderer against closed forms.
#include "apps/engine/mujoco/shapes.hpp"

#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
using namespace halflit;
using namespace halflit::engine::mujoco;

namespace {

constexpr double kPi = std::numbers::pi;

Vec3d at(const Mesh& mesh, std::size_t corner) {
    const Vec3f p = mesh.positions[mesh.indices[corner]];
    return {p.x, p.y, p.z};
}

/// Volume inside a closed surface whose counter-clockwise side is outside.
double volume(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) sum += dot(at(mesh, i), cross(at(mesh, i + 1), at(mesh, i + 2))) / 6;
    return sum;
}

/// Edges that are not there once more in the other direction. Positions within 1e-4 are one: 2 pi is no float, so the last slice ends
/// 2e-7 before the first one.
int open_edges(const Mesh& mesh) {
    std::map<std::array<long, 6>, int> count;
    const auto key = [&](std::size_t i, std::size_t j) {
        const Vec3d a = at(mesh, i), b = at(mesh, j);
        return std::array<long, 6>{std::lround(a.x * 1e4), std::lround(a.y * 1e4), std::lround(a.z * 1e4),
                                   std::lround(b.x * 1e4), std::lround(b.y * 1e4), std::lround(b.z * 1e4)};
    };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            ++count[key(i + k, i + (k + 1) % 3)];
            --count[key(i + (k + 1) % 3, i + k)];
        }
    int open = 0;
    for (const auto& [edge, n] : count) open += n != 0;
    return open;
}

/// Area of the regular polygon around a circle's points.
double polygon(int slices, double radius) { return slices / 2.0 * std::sin(2 * kPi / slices) * radius * radius; }

/// Volume between two polygons of `slices` corners, that are parallel and alike.
double frustum(int slices, double r1, double r2, double height) {
    return height / 3 * (polygon(slices, r1) + std::sqrt(polygon(slices, r1) * polygon(slices, r2)) + polygon(slices, r2));
}

}  // namespace

TEST_CASE("mujoco shapes: closed ones are closed, and have the volumes of their polyhedra", "[engine][mujoco]") {
    for (const Fineness f : {Fineness{28, 16, 4, 0.3f, {}}, Fineness{3, 2, 1, 0.3f, {}}, Fineness{7, 9, 3, 0.3f, {}}}) {
        INFO(f.slices << " slices, " << f.stacks << " stacks");
        double ball = 0;
        const int half = f.stacks / 2;
        for (int i = 0; i < half; ++i) {
            const double a = kPi / 2 * i / half, b = kPi / 2 * (i + 1) / half;
            ball += 2 * frustum(f.slices, std::cos(a), std::cos(b), std::sin(b) - std::sin(a));
        }
        const struct {
            Shape shape;
            double volume;
        } rows[] = {
            {Shape::sphere, ball}, {Shape::box, 8}, {Shape::cylinder, 2 * polygon(f.slices, 1)}, {Shape::cone, polygon(f.slices, 1) / 3}};
        for (const auto& row : rows) {
            INFO("shape " << static_cast<int>(row.shape));
            const Mesh mesh = make_shape(row.shape, f);
            CHECK(open_edges(mesh) == 0);
            CHECK(volume(mesh) == Approx(row.volume).epsilon(1e-5));  // corners are floats
        }
    }
}

TEST_CASE("mujoco shapes: the parts of a box and of a capsule make up the whole", "[engine][mujoco]") {
    const Fineness f;
    const auto join = [](std::initializer_list<std::pair<Mesh, float>> parts) {
        Mesh all;
        for (const auto& [part, shift] : parts) {
            const auto first = static_cast<std::uint32_t>(all.positions.size());
            for (const Vec3f p : part.positions) all.positions.push_back({p.x, p.y, p.z + shift});
            for (const std::uint32_t i : part.indices) all.indices.push_back(first + i);
        }
        return all;
    };
    const Mesh box = join({{make_shape(Shape::box_top, f), 0.0f}, {make_shape(Shape::box_rest, f), 0.0f}});
    CHECK(open_edges(box) == 0);
    CHECK(box.indices.size() == make_shape(Shape::box, f).indices.size());
    CHECK(make_shape(Shape::box_top, f).indices.size() == 6 * 16);
    // Half spheres are moved by 1 along z already, so they end a tube from -1 to 1.
    const Mesh capsule =
        join({{make_shape(Shape::tube, f), 0.0f}, {make_shape(Shape::upper_cap, f), 0.0f}, {make_shape(Shape::lower_cap, f), 0.0f}});
    CHECK(open_edges(capsule) == 0);
    CHECK(volume(capsule) == Approx(volume(make_shape(Shape::sphere, f)) + volume(make_shape(Shape::cylinder, f))).epsilon(1e-5));
}

TEST_CASE("mujoco shapes: normals are those of the surface, and point outwards", "[engine][mujoco]") {
    const Fineness f;
    const Mesh ball = make_shape(Shape::sphere, f);
    for (std::size_t i = 0; i < ball.positions.size(); ++i) CHECK(length(ball.positions[i] - ball.normals[i]) < 1e-6f);
    const Mesh cone = make_shape(Shape::cone, f);
    for (std::size_t i = 0; i < cone.positions.size(); ++i) {
        const Vec3f p = cone.positions[i], n = cone.normals[i];
        if (n.z < 0)
            CHECK(p.z == 0);  // the base
        else if (p.z < 1)
            CHECK(std::abs(n.x * p.x + n.y * p.y - (1 - p.z) * std::sqrt(0.5f)) < 1e-6f);
    }
    for (const Shape shape :
         {Shape::sphere, Shape::upper_cap, Shape::lower_cap, Shape::box, Shape::cylinder, Shape::tube, Shape::cone, Shape::plane}) {
        const Mesh mesh = make_shape(shape, f);
        REQUIRE(mesh.normals.size() == mesh.positions.size());
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const Vec3d face = cross(at(mesh, i + 1) - at(mesh, i), at(mesh, i + 2) - at(mesh, i));
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3f n = mesh.normals[mesh.indices[i + k]];
                CHECK(std::abs(length(n) - 1) < 1e-6f);
                CHECK(dot(face, Vec3d{n.x, n.y, n.z}) > 0.5 * length(face));
            }
        }
    }
}

TEST_CASE("mujoco shapes: corners that are equal are one vertex", "[engine][mujoco]") {
    const Fineness f;
    CHECK(make_shape(Shape::sphere, f).positions.size() == 29 * 15 + 2);
    CHECK(make_shape(Shape::plane, f).positions.size() == 25);
    CHECK(make_shape(Shape::box, f).positions.size() == 6 * 25);
    CHECK(make_shape(Shape::tube, f).positions.size() == 29 * 17);
    CHECK(make_shape(Shape::sphere, f).indices.size() == 3 * 28 * (2 + 2 * 2 * 7));
}

TEST_CASE("mujoco shapes: texture coordinates are the angle around z and the way down, and split no surface", "[engine][mujoco]") {
    Fineness with;
    with.has_uv = true;
    struct Row {
        Shape shape;
        float (*down)(Vec3f);  ///< v of a round surface
    };
    const Row rows[] = {
        {Shape::sphere, [](Vec3f p) { return 0.5f - std::asin(p.z) / float(kPi); }},
        {Shape::upper_cap, [](Vec3f p) { return 1 - std::asin(p.z - 1) / float(kPi / 2); }},
        {Shape::lower_cap, [](Vec3f p) { return -std::asin(p.z + 1) / float(kPi / 2); }},
        {Shape::tube, [](Vec3f p) { return (1 - p.z) / 2; }},
        {Shape::cylinder, [](Vec3f p) { return (1 - p.z) / 2; }},
        {Shape::cone, [](Vec3f p) { return 1 - p.z; }},
    };
    for (const Row& row : rows) {
        INFO("shape " << static_cast<int>(row.shape));
        const Mesh mesh = make_shape(row.shape, with), plain = make_shape(row.shape, {});
        REQUIRE(plain.uv0.empty());
        REQUIRE(mesh.uv0.size() == mesh.positions.size());
        REQUIRE(mesh.indices.size() == plain.indices.size());
        for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
            CHECK(mesh.positions[mesh.indices[i]] == plain.positions[plain.indices[i]]);
            const Vec3f p = mesh.positions[mesh.indices[i]], n = mesh.normals[mesh.indices[i]];
            const Vec2f uv = mesh.uv0[mesh.indices[i]];
            const bool is_disk = (row.shape == Shape::cylinder && std::abs(n.z) == 1) || (row.shape == Shape::cone && n.z < 0);
            if (is_disk) {
                CHECK(uv.x == Approx(0.5f + 0.5f * p.x).margin(1e-6));
                CHECK(uv.y == Approx(0.5f + 0.5f * p.y).margin(1e-6));
                continue;
            }
            CHECK(uv.y == Approx(row.down(p)).margin(2e-3));  // asin is steep at the poles
            if (std::hypot(p.x, p.y) < 1e-3f) continue;
            const double turns = std::atan2(p.y, p.x) / (2 * kPi), difference = static_cast<double>(uv.x) - turns;
            CHECK(std::abs(difference - std::round(difference)) < 1e-6);
        }
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {  // no triangle goes back across the whole texture
            const auto u = [&](std::size_t k) { return mesh.uv0[mesh.indices[i + k]].x; };
            CHECK(std::max({u(0), u(1), u(2)}) - std::min({u(0), u(1), u(2)}) < 0.51f);
        }
    }
    const Mesh box = make_shape(Shape::box, with);
    for (std::size_t i = 0; i < box.positions.size(); ++i) {
        const Vec3f p = box.positions[i], n = box.normals[i];
        const float along = n.x != 0 ? p.y : p.x, up = n.z != 0 ? p.y : p.z;
        CHECK(box.uv0[i] == Vec2f{(along + 1) / 2, (1 - up) / 2});
    }
    CHECK(make_shape(Shape::triangle, with).uv0 == std::vector<Vec2f>{{0, 1}, {1, 1}, {0, 0}});
}

TEST_CASE("mujoco shapes: haze is clear at both ends", "[engine][mujoco]") {
    for (const float r : {0.0f, 0.3f, 1.0f}) {
        const Mesh haze = make_shape(Shape::haze, {28, 16, 4, r, {0.2f, 0.4f, 0.6f}});
        REQUIRE(haze.colors.size() == haze.positions.size());
        // The height at which a ray of 45 degrees from the rim meets the cone, by the sines of its angles.
        const double a = std::atan2(1.0, static_cast<double>(r)),
                     middle = std::sqrt(0.5) * static_cast<double>(r) * std::sin(a) / std::sin(0.75 * kPi - a);
        for (std::size_t i = 0; i < haze.positions.size(); ++i) {
            const Vec3f p = haze.positions[i];
            CHECK(haze.colors[i].y == 0.4f);
            if (haze.colors[i].w == 1)
                CHECK(static_cast<double>(p.z) == Approx(middle).margin(1e-6));
            else
                CHECK((p.z == 0 || p.z == 1));
            CHECK(std::hypot(p.x, p.y) == Approx(1 - r * (1 - p.z)).margin(1e-6));
        }
    }
}
