// OFF: headers as they are written, colours of vertices and faces, polygons, and what is refused.
#include "tests/io/model_maker.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

using namespace halflit;
using namespace halflit::test;

namespace {

std::string off_of(const Polyhedron& p, const std::string& header, const std::string& after_face = "") {
    std::string text = header + std::to_string(p.points.size()) + " " + std::to_string(p.polygons.size()) + " 0\n# a comment\n\n";
    for (const Vec3f& v : p.points) text += text_of(v) + "  # a vertex\n";
    for (const auto& polygon : p.polygons) {
        text += std::to_string(polygon.size());
        for (const unsigned i : polygon) text += " " + std::to_string(i);
        text += after_face + "\n";
    }
    return text;
}

}  // namespace

TEST_CASE("OFF: every way to write the header gives the mesh of the same OBJ", "[io][off]") {
    const LoadedScene expected = load_any_ok(obj_of(letter()));
    for (const char* const header : {"OFF\n", "OFF ", "OFF", "# first a comment\nOFF\n\n"}) {
        INFO(header);
        const LoadedScene loaded = load_any_ok(to_bytes(off_of(letter(), header)));
        CHECK(loaded.info.format == "OFF");
        CHECK(loaded.warnings.empty());
        REQUIRE(loaded.scene.meshes.size() == 1);
        CHECK(loaded.scene.meshes[0].positions == expected.scene.meshes[0].positions);
        CHECK(loaded.scene.meshes[0].indices == expected.scene.meshes[0].indices);
        CHECK(loaded.scene.meshes[0].normals == expected.scene.meshes[0].normals);
    }
}

TEST_CASE("OFF: colours are sRGB codes or shares, of vertices or of faces", "[io][off]") {
    const auto first_color = [](const std::string& text) {
        const LoadedScene loaded = load_any_ok(to_bytes(text));
        REQUIRE(loaded.scene.meshes.at(0).colors.size() == loaded.scene.meshes[0].positions.size());
        return loaded.scene.meshes[0].colors[0];
    };
    CHECK(first_color("COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n0 1 0 255 0 0 255\n3 0 1 2\n") == Vec4f{1, 0, 0, 1});
    CHECK(first_color("COFF\n3 1 0\n0 0 0 0.0 1.0 0 1\n1 0 0 0 1 0 1\n0 1 0 0 1 0 1\n3 0 1 2\n") == Vec4f{0, 1, 0, 1});
    // A dark code is no share where another vertex has codes.
    CHECK(first_color("COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 255 0 0 1\n0 1 0 255 0 0 1\n3 0 1 2\n").x < 0.001f);
    CHECK(first_color("COFF\n3 1 0\n0 0 0 1 0 0 255\n1 0 0 1 0 0 255\n0 1 0 1 0 0 255\n3 0 1 2\n").x < 0.001f);
    CHECK(first_color(off_of(letter(), "OFF\n", " 0 0 255")) == Vec4f{0, 0, 1, 1});
    CHECK(first_color(off_of(letter(), "OFF\n", " 0.0 0.0 1.0 0.5")) == Vec4f{0, 0, 1, 1});
    CHECK(first_color("OFF\n3 1 0\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 1") == Vec4f{1, 0, 0, 1});  // cut off among the vertices
    // An index into a table of colours that no file has.
    CHECK(load_any_ok(to_bytes(off_of(letter(), "OFF\n", " 3"))).scene.meshes[0].colors.empty());
}

TEST_CASE("OFF: normals and texture coordinates of vertices are read", "[io][off]") {
    const LoadedScene loaded = load_any_ok(to_bytes("STNOFF\n3 1 0\n0 0 0 0 0 2 0.25 1\n1 0 0 0 0 1 1 1\n0 1 0 0 0 1 0 0\n3 0 1 2\n"));
    const Mesh& mesh = loaded.scene.meshes.at(0);
    CHECK(mesh.uv0.at(0) == Vec2f{0.25f, 0});
    CHECK(mesh.normals.at(0).z > 0);
}

TEST_CASE("OFF: what is cut off, out of range or no number is refused at its line", "[io][off]") {
    const auto refused = [](const std::string& text) { return refusal_of(to_bytes(text)); };
    CHECK(refused("OFF\n3 1 0\n0 0 0\n1 0 0\n").find("line 4: expected a vertex, the file ends") != std::string::npos);
    CHECK(refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n").find("line 6: a vertex out of range: there are 3") != std::string::npos);
    CHECK(refused("OFF\n3 1 0\n0 0 zero\n1 0 0\n0 1 0\n3 0 1 2\n").find("line 3: expected a number") != std::string::npos);
    CHECK(refused("OFF\n9999999999 1 0\n0 0 0\n").find("line 2: 9999999999 vertices, faces or corners do not fit into the file") !=
          std::string::npos);
    CHECK(refused("OFF BINARY\n").find("it was cut off") != std::string::npos);
    CHECK(refused("4OFF\n1 0 0\n0 0 0 0\n").find("three dimensions") != std::string::npos);
    const LoadOptions tolerant;
    const LoadedScene loaded = load_any_ok(to_bytes("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n3 0 1 2\n"), tolerant);
    CHECK(loaded.info.triangles_drawn == 1);
    CHECK(loaded.warnings.size() == 1);
}
