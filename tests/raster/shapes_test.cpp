#include "halflit/shapes.hpp"

#include "sh/trig.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <map>
#include <tuple>
#include <utility>

using namespace halflit;

namespace {

Vec3d corner(const Mesh& mesh, std::size_t index) {
    const Vec3f p = mesh.positions[mesh.indices[index]];
    return {p.x, p.y, p.z};
}

/// Volume by the divergence theorem; positive when triangles are counter-clockwise seen from outside.
double signed_volume(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) sum += dot(corner(mesh, i), cross(corner(mesh, i + 1), corner(mesh, i + 2)));
    return sum / 6;
}

double area(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        sum += length(cross(corner(mesh, i + 1) - corner(mesh, i), corner(mesh, i + 2) - corner(mesh, i)));
    return sum / 2;
}

/// True if every directed edge, by the positions of its ends, occurs once and its opposite once: no hole and no flipped triangle.
bool is_closed(const Mesh& mesh) {
    using Point = std::tuple<float, float, float>;
    std::map<std::pair<Point, Point>, int> edges;
    const auto point = [&](std::size_t i) {
        const Vec3f p = mesh.positions[mesh.indices[i]];
        return Point{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // + 0 makes -0 and 0 one point
    };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        for (std::size_t e = 0; e < 3; ++e) ++edges[{point(i + e), point(i + (e + 1) % 3)}];
    for (const auto& [edge, count] : edges) {
        const auto opposite = edges.find({edge.second, edge.first});
        if (count != 1 || opposite == edges.end() || opposite->second != 1) return false;
    }
    return !edges.empty();
}

/// Checks that normals have length 1, and that the cosine between a triangle's plane normal and those of its corners is large enough.
void check_normals(const Mesh& mesh, double smallest_cosine) {
    REQUIRE(mesh.normals.size() == mesh.positions.size());
    REQUIRE(mesh.uv0.size() == mesh.positions.size());
    double worst_length = 0, worst_cosine = 1;
    for (const Vec3f n : mesh.normals) worst_length = std::max(worst_length, std::abs(length(Vec3d{n.x, n.y, n.z}) - 1.0));
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vec3d face = cross(corner(mesh, i + 1) - corner(mesh, i), corner(mesh, i + 2) - corner(mesh, i));
        REQUIRE(length(face) > 0.0);
        for (std::size_t e = 0; e < 3; ++e) {
            const Vec3f n = mesh.normals[mesh.indices[i + e]];
            worst_cosine = std::min(worst_cosine, dot(face, Vec3d{n.x, n.y, n.z}) / length(face));
        }
    }
    CHECK(worst_length < 1.2e-7);  // float rounding of each component
    CHECK(worst_cosine > smallest_cosine);
}

/// Checks that u grows to the right and v down when seen from outside, so that no texture is mirrored.
void check_texture_is_not_mirrored(const Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vec2f a = mesh.uv0[mesh.indices[i]], b = mesh.uv0[mesh.indices[i + 1]], c = mesh.uv0[mesh.indices[i + 2]];
        INFO("triangle " << i / 3);
        REQUIRE((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) < 0.0f);
    }
}

}  // namespace

TEST_CASE("shapes: a sphere is closed and wound outwards, its volume and area those of a sphere", "[raster][shapes]") {
    const Mesh mesh = make_sphere(2.0f, 96, 64);
    CHECK(mesh.indices.size() == 3u * 2 * 96 * 63);
    CHECK(is_closed(mesh));
    check_normals(mesh, 0.99);
    check_texture_is_not_mirrored(mesh);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) CHECK(mesh.positions[i] == mesh.normals[i] * 2.0f);
    // An inscribed polyhedron falls short by the order of (pi / stacks)^2.
    CHECK(signed_volume(mesh) == Approx(4.0 / 3.0 * kPi * 8.0).epsilon(0.003));
    CHECK(signed_volume(mesh) < 4.0 / 3.0 * kPi * 8.0);
    CHECK(area(mesh) == Approx(4.0 * kPi * 4.0).epsilon(0.003));
}

TEST_CASE("shapes: the smallest sphere is still closed", "[raster][shapes]") {
    CHECK(is_closed(make_sphere(1.0f, 0, 0)));
    CHECK(make_sphere(1.0f, 0, 0).indices.size() == 3u * 6);
    CHECK(is_closed(make_torus(2.0f, 1.0f, 0, 0)));
}

TEST_CASE("shapes: a sphere of N triangles has nearly N of them", "[raster][shapes]") {
    for (const std::int64_t wanted : {12, 100, 1000, 12345, 100000, 1000000}) {
        const auto made = static_cast<std::int64_t>(make_sphere_of(1.0f, wanted).indices.size() / 3);
        INFO(wanted << " wanted, " << made << " made");
        CHECK(std::abs(made - wanted) <= wanted / 25);  // 12 is met exactly, 100 by 96 or 104
    }
    CHECK(make_sphere_of(1.0f, 1000000).indices.size() == 3000000u);
}

TEST_CASE("shapes: a plane has its area and faces up", "[raster][shapes]") {
    const Mesh mesh = make_plane(3.0f, 4);
    CHECK(mesh.indices.size() == 3u * 2 * 16);
    CHECK(area(mesh) == Approx(36.0).epsilon(1e-9));
    check_normals(mesh, 0.999999);
    check_texture_is_not_mirrored(mesh);
    for (const Vec3f n : mesh.normals) CHECK(n == Vec3f{0, 1, 0});
}

TEST_CASE("shapes: a box is closed and has its volume", "[raster][shapes]") {
    const Mesh mesh = make_box({1, 2, 3});
    CHECK(mesh.positions.size() == 24u);
    CHECK(is_closed(mesh));
    CHECK(signed_volume(mesh) == Approx(48.0).epsilon(1e-12));
    check_normals(mesh, 0.999999);
    check_texture_is_not_mirrored(mesh);
}

TEST_CASE("shapes: a torus is closed, its volume and area by Pappus", "[raster][shapes]") {
    const Mesh mesh = make_torus(3.0f, 1.0f, 160, 96);
    CHECK(mesh.indices.size() == 3u * 2 * 160 * 96);
    CHECK(is_closed(mesh));
    check_normals(mesh, 0.99);
    check_texture_is_not_mirrored(mesh);
    CHECK(signed_volume(mesh) == Approx(2.0 * kPi * 3.0 * kPi).epsilon(0.003));
    CHECK(area(mesh) == Approx(2.0 * kPi * 3.0 * 2.0 * kPi).epsilon(0.003));
}
