#include "halflit/mesh.hpp"

#include "tests/support/catch.hpp"

#include <limits>

using namespace halflit;

TEST_CASE("flat normals: each triangle has its own vertices and its counter-clockwise normal", "[raster]") {
    Mesh mesh;  // a tetrahedron's three faces at the origin
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
    mesh.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2};
    mesh.uv0 = {{0, 0}, {1, 0}, {2, 0}, {3, 0}};
    mesh.colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {2, 0, 0, 1}, {3, 0, 0, 1}};
    mesh.tangents.assign(4, Vec4f{1, 0, 0, 1});
    const Mesh before = mesh;
    generate_flat_normals(mesh);
    const Vec3f wanted[3] = {{0, 0, -1}, {0, -1, 0}, {-1, 0, 0}};
    REQUIRE(mesh.normals.size() == 9);
    CHECK(mesh.tangents.empty());
    CHECK(mesh.uv1.empty());
    for (std::size_t i = 0; i < 9; ++i) {
        CHECK(mesh.indices[i] == i);
        CHECK(mesh.normals[i] == wanted[i / 3]);
        CHECK(mesh.positions[i] == before.positions[before.indices[i]]);
        CHECK(mesh.uv0[i] == before.uv0[before.indices[i]]);
        CHECK(mesh.colors[i] == before.colors[before.indices[i]]);
    }
}

TEST_CASE("flat normals: tiny and huge triangles keep their direction, empty and broken ones get +z", "[raster]") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float size : {1e-30f, 1e-10f, 1.0f, 1e10f, 1e30f}) {
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {0, size, 0}, {0, 0, size}};
        mesh.indices = {0, 1, 2};
        generate_flat_normals(mesh);
        CHECK(mesh.normals[0] == Vec3f{1, 0, 0});
    }
    for (const Vec3f last : {Vec3f{0, 0, 0}, Vec3f{2, 0, 0}, Vec3f{nan, 0, 0}}) {
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, last};
        mesh.indices = {0, 1, 2};
        generate_flat_normals(mesh);
        CHECK(mesh.normals[0] == Vec3f{0, 0, 1});
    }
}

TEST_CASE("smooth normals: a surface with split vertices has the normals of one that shares them", "[raster]") {
    Mesh shared;  // a pyramid's four sides, and a vertex that no triangle uses
    shared.positions = {{1, 0, 1}, {1, 0, -1}, {-1, 0, -1}, {-1, 0, 1}, {0, 3, 0}, {9, 9, 9}};
    shared.indices = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    Mesh split;
    for (const std::uint32_t index : shared.indices) {
        split.indices.push_back(static_cast<std::uint32_t>(split.positions.size()));
        split.positions.push_back(shared.positions[index]);
    }
    generate_smooth_normals(shared);
    generate_smooth_normals(split);
    for (std::size_t i = 0; i < split.indices.size(); ++i) CHECK(split.normals[i] == shared.normals[shared.indices[i]]);
    CHECK(shared.normals[4] == Vec3f{0, 1, 0});  // by symmetry
    CHECK(shared.normals[5] == Vec3f{0, 1, 0});
    CHECK(split.positions.size() == 12);
}

TEST_CASE("smooth normals: the two sides of a sheet keep their own", "[raster]") {
    Mesh sheet;
    sheet.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    sheet.indices = {0, 1, 2, 3, 5, 4};
    generate_smooth_normals(sheet);
    for (std::size_t i = 0; i < 6; ++i) CHECK(sheet.normals[i] == Vec3f{0, 0, i < 3 ? 1.0f : -1.0f});
}
