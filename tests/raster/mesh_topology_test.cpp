#include "raster/geometry/mesh_topology.hpp"

#include "halflit/shapes.hpp"

#include "tests/support/catch.hpp"

#include <limits>

using namespace halflit;
using namespace halflit::raster;

namespace {

Mesh tetrahedron() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    return mesh;
}

}  // namespace

TEST_CASE("mesh topology: a surface without a border is closed, one with a hole is not", "[raster]") {
    CHECK(is_closed(tetrahedron()));
    Mesh open = tetrahedron();
    open.indices.resize(9);
    CHECK_FALSE(is_closed(open));
    Mesh turned = tetrahedron();
    std::swap(turned.indices[0], turned.indices[1]);
    CHECK_FALSE(is_closed(turned));
    CHECK_FALSE(is_closed(Mesh{}));
}

TEST_CASE("mesh topology: vertices at one place are one, and triangles without area do not count", "[raster]") {
    Mesh parted;  // every triangle has its own vertices, as flat shading asks for
    const Mesh whole = tetrahedron();
    for (const std::uint32_t index : whole.indices) {
        parted.indices.push_back(static_cast<std::uint32_t>(parted.positions.size()));
        parted.positions.push_back(whole.positions[index]);
    }
    parted.positions[0].x = -0.0f;
    CHECK(is_closed(parted));
    parted.indices.insert(parted.indices.end(), {0, 0, 5, 1, 2, 1});
    CHECK(is_closed(parted));
    parted.positions[3].x = std::numeric_limits<float>::quiet_NaN();
    CHECK_FALSE(is_closed(parted));
}

TEST_CASE("mesh topology: built-in shapes are closed where they look it", "[raster]") {
    CHECK(is_closed(make_sphere(1.0f, 24, 12)));
    CHECK(is_closed(make_box({1, 2, 3})));
    CHECK(is_closed(make_torus(1.0f, 0.25f, 16, 8)));
    CHECK_FALSE(is_closed(make_plane(1.0f, 4)));
}
