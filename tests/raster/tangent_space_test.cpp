#include "halflit/mesh.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

using namespace halflit;

namespace {

double angle_deg(Vec4f a, Vec3d b) {
    const double cosine =
        (a.x * b.x + a.y * b.y + a.z * b.z) / std::sqrt((double{a.x} * a.x + double{a.y} * a.y + double{a.z} * a.z) * dot(b, b));
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / 3.14159265358979;
}

/// A unit sphere with u along the longitude (growing to the east) and v along the latitude, 0 at the north pole.
Mesh sphere(int around, int down) {
    Mesh mesh;
    for (int j = 0; j <= down; ++j) {
        for (int i = 0; i <= around; ++i) {
            const double u = double(i) / around, v = double(j) / down, phi = 2 * 3.14159265358979 * u, theta = 3.14159265358979 * v;
            const Vec3f p{float(std::sin(theta) * std::cos(phi)), float(std::cos(theta)), float(-std::sin(theta) * std::sin(phi))};
            mesh.positions.push_back(p);
            mesh.normals.push_back(p);
            mesh.uv0.push_back({float(u), float(v)});
        }
    }
    for (int j = 0; j < down; ++j) {
        for (int i = 0; i < around; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (around + 1) + i), b = a + 1, c = a + static_cast<std::uint32_t>(around) + 1,
                       d = c + 1;
            mesh.indices.insert(mesh.indices.end(), {a, c, d, a, d, b});
        }
    }
    return mesh;
}

Mesh plane(Vec2f uv00, Vec2f uv10, Vec2f uv11, Vec2f uv01) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.normals.assign(4, Vec3f{0, 0, 1});
    mesh.uv0 = {uv00, uv10, uv11, uv01};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

}  // namespace

TEST_CASE("tangents: a plane's tangent is the direction of u, and w says where the picture's top is", "[raster]") {
    Mesh upright = plane({0, 1}, {1, 1}, {1, 0}, {0, 0});  // v down: the picture's top is +y
    generate_tangents(upright, 0);
    for (const Vec4f& t : upright.tangents) CHECK(t == Vec4f{1, 0, 0, 1});  // cross(z, x) * 1 = +y
    Mesh mirrored = plane({1, 1}, {0, 1}, {0, 0}, {1, 0});
    generate_tangents(mirrored, 0);
    for (const Vec4f& t : mirrored.tangents) CHECK(t == Vec4f{-1, 0, 0, -1});  // cross(z, -x) * -1 = +y
    Mesh turned = plane({0, 0}, {0, 1}, {1, 1}, {1, 0});                       // u along +y, the picture's top towards -x
    generate_tangents(turned, 0);
    for (const Vec4f& t : turned.tangents) CHECK(t == Vec4f{0, 1, 0, 1});  // cross(z, y) * 1 = -x
    CHECK(upright.positions.size() == 4);
    CHECK(upright.indices == std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
}

TEST_CASE("tangents: on a sphere they point east, within the size of a facet", "[raster]") {
    Mesh mesh = sphere(64, 32);
    const std::size_t triangles = mesh.indices.size();
    generate_tangents(mesh, 0);
    CHECK(mesh.indices.size() == triangles);
    REQUIRE(mesh.tangents.size() == mesh.positions.size());
    double worst = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3f p = mesh.positions[v];
        if (std::abs(p.y) > 0.99f) continue;  // at the poles there is no east
        worst = std::max(worst, angle_deg(mesh.tangents[v], {p.z, 0, -p.x}));
        CHECK(mesh.tangents[v].w == 1.0f);  // cross(outwards, east) is north, the picture's top
    }
    CHECK(worst < 3.0);  // half a facet is 2.8 degrees; measured 2.8 at the seam, where only one side counts
}

TEST_CASE("tangents: a mirrored seam splits its vertices, a plain one does not", "[raster]") {
    Mesh mesh;  // two quads side by side; on both, u grows away from the common edge
    mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.normals.assign(6, Vec3f{0, 0, 1});
    mesh.uv0 = {{1, 1}, {0, 1}, {1, 1}, {1, 0}, {0, 0}, {1, 0}};
    mesh.colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {2, 0, 0, 1}, {3, 0, 0, 1}, {4, 0, 0, 1}, {5, 0, 0, 1}};
    mesh.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    const Mesh before = mesh;
    generate_tangents(mesh, 0);
    CHECK(mesh.positions.size() == 8);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t v = mesh.indices[i], old = before.indices[i];
        CHECK(mesh.positions[v] == before.positions[old]);
        CHECK(mesh.colors[v] == before.colors[old]);
        CHECK(mesh.uv0[v] == before.uv0[old]);
        CHECK(mesh.tangents[v] == (i < 6 ? Vec4f{-1, 0, 0, -1} : Vec4f{1, 0, 0, 1}));
    }
}

TEST_CASE("tangents: unshared vertices get the tangents of shared ones", "[raster]") {
    Mesh shared = sphere(24, 12), apart = shared;
    std::mt19937 random(7);
    for (Vec2f& uv : shared.uv0) uv = {uv.x + float(random() % 1000) * 2e-5f, uv.y + float(random() % 1000) * 2e-5f};
    apart = Mesh{};
    for (const std::uint32_t i : shared.indices) {
        apart.indices.push_back(static_cast<std::uint32_t>(apart.positions.size()));
        apart.positions.push_back(shared.positions[i]);
        apart.normals.push_back(shared.normals[i]);
        apart.uv0.push_back(shared.uv0[i]);
    }
    generate_tangents(shared, 0);
    generate_tangents(apart, 0);
    for (std::size_t i = 0; i < shared.indices.size(); ++i) CHECK(shared.tangents[shared.indices[i]] == apart.tangents[apart.indices[i]]);
}

TEST_CASE("tangents: an uneven fan is weighted by angle, not by area or count", "[raster]") {
    // Three triangles around the origin in the plane z = 0, with texture directions of their own; the corner at the origin is welded by
    // equal uv there. Angles at the origin: 90, 60 and 30 degrees; tangents given by each triangle's own uv.
    Mesh mesh;
    const double deg = 3.14159265358979 / 180;
    const auto at = [&](double a, double r) { return Vec3f{float(r * std::cos(a * deg)), float(r * std::sin(a * deg)), 0}; };
    mesh.positions = {{0, 0, 0}, at(0, 1), at(90, 5), at(150, 1), at(180, 30)};
    mesh.normals.assign(5, Vec3f{0, 0, 1});
    // u = x + 0.3 y at the first two points of the rim, then sheared: each triangle has its own gradient.
    mesh.uv0 = {{0, 0}, {1, -0.2f}, {1.5f, -5}, {-0.5f, -0.6f}, {-20, -4}};
    mesh.indices = {0, 1, 2, 0, 2, 3, 0, 3, 4};
    Vec3d sum{};
    for (std::size_t t = 0; t < 3; ++t) {
        const Vec3f p = mesh.positions[t + 1], q = mesh.positions[t + 2];
        const Vec2f a = mesh.uv0[t + 1], b = mesh.uv0[t + 2];
        // P = S u + T v solved for S by Cramer's rule.
        const double det = double{a.x} * b.y - double{b.x} * a.y;
        const Vec3d s{(p.x * double{b.y} - q.x * double{a.y}) / det, (p.y * double{b.y} - q.y * double{a.y}) / det, 0};
        const double weight[3] = {90, 60, 30};
        sum = sum + s * (weight[t] / length(s));
    }
    generate_tangents(mesh, 0);
    CHECK(angle_deg(mesh.tangents[mesh.indices[0]], sum) < 1e-4);
    CHECK(mesh.positions.size() == 5);
}

TEST_CASE("tangents: triangles without an area, in space or in texture, take part without harm", "[raster]") {
    Mesh mesh = plane({0, 1}, {1, 1}, {1, 0}, {0, 0});
    mesh.positions.push_back({2, 0, 0});
    mesh.normals.push_back({0, 0, 1});
    mesh.uv0.push_back({1, 1});                                            // flat in texture: u and v as at vertex 1
    mesh.indices.insert(mesh.indices.end(), {1, 4, 2, 0, 0, 1, 2, 2, 2});  // joins its neighbour; two without area
    generate_tangents(mesh, 0);
    for (const std::uint32_t i : mesh.indices) {
        CHECK(std::isfinite(mesh.tangents[i].x));
        if (i < 4) CHECK(mesh.tangents[i] == Vec4f{1, 0, 0, 1});
    }
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    Mesh broken = plane({nan, 1}, {1, inf}, {1, 0}, {0, 0});
    broken.positions[2].x = nan;
    broken.normals[3] = {nan, 0, inf};
    generate_tangents(broken, 0);
    for (const Vec4f& t : broken.tangents)
        CHECK((std::isfinite(t.x) && std::isfinite(t.y) && std::isfinite(t.z) && (t.w == 1.0f || t.w == -1.0f)));
}

TEST_CASE("tangents: the second set of texture coordinates is used when asked for", "[raster]") {
    Mesh mesh = plane({0, 1}, {1, 1}, {1, 0}, {0, 0});
    mesh.uv1 = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    generate_tangents(mesh, 1);
    CHECK(mesh.tangents[0] == Vec4f{0, 1, 0, 1});
}
