// Files of other formats than glTF as programs write them: what can be read is drawn, with a warning.
#include "tests/io/model_maker.hpp"

#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::test;

namespace {

/// A PLY text of three points with these properties and values behind the coordinates.
LoadedScene points(const std::string& properties, const std::array<const char*, 3>& values) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" + properties + "end_header\n";
    for (int i = 0; i < 3; ++i) text += fmt::format("{} {} {} {}\n", i, i * i, 2 * i, values[static_cast<std::size_t>(i)]);
    return read(text);
}

int code(float linear) {
    const double x = static_cast<double>(linear);
    return static_cast<int>(std::lround(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055)));
}

std::array<int, 3> color(const LoadedScene& loaded, std::size_t i) {
    const Vec4f c = loaded.scene.meshes.at(0).colors.at(i);
    return {code(c.x), code(c.y), code(c.z)};
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("tolerance: colours of PLY are by the range of their values", "[io][ply]") {
    const std::string rgb = "red\nproperty TYPE green\nproperty TYPE blue\n";
    const auto of = [&](std::string type, const std::array<const char*, 3>& values) {
        std::string text = "property TYPE " + rgb;
        for (std::size_t at = text.find("TYPE"); at != std::string::npos; at = text.find("TYPE")) text.replace(at, 4, type);
        return points(text, values);
    };
    CHECK(color(of("float", {"255 40 0", "0 0 0", "9 9 9"}), 0) == std::array<int, 3>{255, 40, 0});
    CHECK(color(of("float", {"1 0.2 0", "0 0 0", "0 0 0"}), 0) == std::array<int, 3>{255, 51, 0});
    CHECK(color(of("ushort", {"255 40 0", "0 0 0", "9 9 9"}), 0) == std::array<int, 3>{255, 40, 0});
    CHECK(color(of("ushort", {"65535 10280 0", "0 0 0", "9 9 9"}), 0) == std::array<int, 3>{255, 40, 0});
    CHECK(color(of("uchar", {"1 1 1", "0 0 0", "1 1 1"}), 0) == std::array<int, 3>{1, 1, 1});
    CHECK(color(points("property uint rgb\n", {"16711935", "0", "255"}), 0) == std::array<int, 3>{255, 0, 255});
    // HDR: most channels are shares. What is above 1 is 1, and a vertex that is not finite is white.
    const LoadedScene hdr = of("float", {"0.2 0.4 300.5", "0.6 0.8 0.2", "nan 0 0"});
    CHECK(color(hdr, 0) == std::array<int, 3>{51, 102, 255});
    CHECK(color(hdr, 1) == std::array<int, 3>{153, 204, 51});
    CHECK(color(hdr, 2) == std::array<int, 3>{255, 255, 255});
    CHECK(is_warned(hdr, "its colours are fractions up to 300.5: read as from 0 to 1, what is above as 1"));
    CHECK(is_warned(hdr, "1 colours are not finite, and drawn as white"));
    const LoadedScene means = of("float", {"127.25 40 0", "200 9.5 0", "9 9 1.5"});
    CHECK(color(means, 0) == std::array<int, 3>{127, 40, 0});
    CHECK(is_warned(means, "fractions up to 200: read as from 0 to 255"));
}

TEST_CASE("tolerance: rows of a PLY text count before the header's numbers, and its format may be missing", "[io][ply]") {
    const auto header = [](int vertices, int faces, const char* more = "") {
        return fmt::format(
            "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n{}"
            "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
            vertices, more, faces);
    };
    const std::string rows = "0 0 0\n1 0 0\n1 1 0\ncomment a square\n0 1 0\n\n3 0 1 2\n3 0 2 3\n";
    for (const auto& [vertices, faces] : {std::pair(4, 2), {3, 2}, {1, 1}, {9, 2}, {5, 1}, {4, 1}, {2, 9}, {4, 0}}) {
        INFO(vertices << " vertices, " << faces << " faces");
        const std::string text = header(vertices, faces) + rows;
        const LoadedScene loaded = read(text);
        CHECK(loaded.info.triangles_drawn == 2);
        CHECK(loaded.scene.meshes.at(0).positions.size() == 4);
        const bool is_right = vertices == 4 && faces == 2;
        CHECK(loaded.warnings.empty() == is_right);
        if (vertices != 4)
            CHECK(is_warned(loaded, fmt::format("the header says {} elements \"vertex\", but there are 4", vertices).c_str()));
        CHECK(load_any(to_bytes(text)).has_value() == is_right);
    }
    // Rows of one more value look like triangles where it is 3: then the header counts.
    const std::string more = "property float quality\n", scalars = "0 0 0 3\n1 0 0 3\n1 1 0 3\n0 1 0 3\n";
    CHECK(read(header(4, 2, more.c_str()) + scalars + "3 0 1 2\n3 0 2 3\n").info.triangles_drawn == 2);
    CHECK(read(header(4, 1, more.c_str()) + scalars + "3 0 1 2\n3 0 2 3\n").info.triangles_drawn == 2);

    const std::string no_format = replaced(header(4, 2), "format ascii 1.0\n", "") + rows;
    const LoadedScene loaded = read(no_format);
    CHECK(loaded.info.triangles_drawn == 2);
    CHECK(is_warned(loaded, "the header has no format; read as text"));
    CHECK_FALSE(load_any(to_bytes(no_format)));
    CHECK_FALSE(load_any(to_bytes(replaced(header(4, 2), "format ascii 1.0\n", "") + std::string(48, '\0')), {}));
}

TEST_CASE("tolerance: clouds with a scalar, with normals of 0, and 3D Gaussians are coloured", "[io][ply]") {
    const LoadedScene scalar = points("property float intensity\n", {"10", "20", "30"});
    CHECK(is_warned(scalar, "intensity, from 10 (dark blue) to 30 (yellow)"));
    CHECK(color(scalar, 0) == std::array<int, 3>{68, 1, 84});
    CHECK(color(scalar, 2)[0] > 240);
    const LoadedScene normals = points("property float nx\nproperty float ny\nproperty float nz\n", {"0 0 0", "0 0 0", "0 0 0"});
    CHECK(normals.scene.meshes.at(0).normals.empty());
    const LoadedScene splats = points(
        "property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\nproperty float opacity\n"
        "property float scale_0\nproperty float rot_0\n",
        {"1 0 -1 0 0 1", "0 0 0 9 0 1", "0 0 0 0 0 1"});
    CHECK(is_warned(splats, "3D Gaussians"));
    CHECK(color(splats, 0)[1] == 128);
    CHECK(std::fabs(splats.scene.meshes.at(0).colors.at(0).w - 0.5f) < 1e-3f);
    const LoadedScene survey = read(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nend_header\n"
        "0 0 0\n9 0 1\n0 9 1\n9 9 0\n");
    CHECK(is_warned(survey, "with z up"));
}

TEST_CASE("tolerance: PLY that is cut off, has longer rows or unknown header lines is read as far as it goes", "[io][ply]") {
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string vertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    const LoadedScene cut = read(header + vertices + "3 0 1 2\n3 0 ");
    CHECK(cut.info.triangles_drawn == 1);
    CHECK(is_warned(cut, "it was cut off: 1 of 2 elements \"face\" are there"));
    const LoadedScene cloud = read(header + "0 0 0\n1 0 0\n1 1");
    CHECK(cloud.scene.meshes.at(0).topology == Topology::points);
    CHECK(cloud.scene.meshes.at(0).positions.size() == 2);
    const LoadedScene longer = read(header + "0 0 0 7\n1 0 0 7\n1 1 0 7\n0 1 0 7\n3 0 1 2\n3 0 2 3\n");
    CHECK(longer.info.triangles_drawn == 2);
    CHECK(is_warned(longer, "4 lines have more values"));
    CHECK(read(replaced(header, "element vertex", "created by a program\nelement vertex") + vertices + "3 0 1 2\n3 0 2 3\n")
              .info.triangles_drawn == 2);
    CHECK_FALSE(load_any(to_bytes(header + vertices + "3 0 1 2\n3 0 ")));
    // A binary list that is longer than the file has no line.
    Bytes binary = ply_of(letter(), PlyKind::little);
    const std::string_view text(reinterpret_cast<const char*>(binary.data()), binary.size());
    binary.resize(text.find("end_header\n") + 11 + 17 * letter().points.size() + 10);
    CHECK(refusal_of(binary).find("line") == std::string::npos);
}

TEST_CASE("tolerance: OBJ with odd numbers, faces and orders is drawn", "[io][obj]") {
    CHECK(read("v 0,0 0 0\nv 1,0 0 0\nv 0 1,5 0\nf 1 2 3\n").scene.meshes.at(0).positions.at(2).y == 1.5f);
    CHECK(read(kTriangle + "vn nan(ind) 1.#QNAN 0\nf 1 2 3\n").info.triangles_drawn == 1);
    CHECK(read(kTriangle + "f 1 2\nf 1 2 3\n").info.triangles_drawn == 1);
    CHECK(read(kTriangle + "vt 0 0\nf 1/9 2/1 3/1\n").info.triangles_drawn == 1);
    CHECK(read("f 1 2 3\n" + kTriangle).info.triangles_drawn == 1);
    const LoadedScene late = read("o a\nf 1 2 3\nl 1 2\np 3\nf 1 2 9\nf 1/x 2 3\no b\n" + kTriangle + "f 1 3 2\n");
    REQUIRE(late.scene.meshes.size() == 4);  // of the object a: faces, lines, points
    CHECK(std::count_if(late.scene.meshes.begin(), late.scene.meshes.end(), [](const Mesh& mesh) { return mesh.name == "a"; }) == 3);
    CHECK(late.info.triangles_drawn == 3);
    CHECK(is_warned(late, "1 faces, lines or points with indices out of range"));
    CHECK(is_warned(late, "line 6: expected an index, found \"x\""));
    const LoadedScene cloud = read(kTriangle);
    CHECK(cloud.scene.meshes.at(0).topology == Topology::points);
    for (const char* text :
         {"v (0, 0, 0)\nv (1, 0, 0)\nv (0, 1.5, 0)\nf 1 2 3\n", "v ( 0 0 0 )\nv [1 0 0]\nv (0,1.5,0)\nf ( 1 2 3 )\nf (1/ 2 3),\n",
          "V 0 0 0\nV 1 0 0\nv 0 1.5 0\nVN 0 0 1\nF 1//1 2//1 3//1\n", "v (0 0 0\nv (1 0 0\nv (0 1.5 0\nf (1) (2) (3)\n"}) {
        INFO(text);
        const LoadedScene loaded = read(text);
        CHECK(loaded.info.triangles_drawn >= 1);
        CHECK(loaded.scene.meshes.at(0).positions.at(2) == Vec3f{0, 1.5f, 0});
        REQUIRE(loaded.warnings.size() == 1);
        CHECK(loaded.warnings[0].find("; read as it is meant") != std::string::npos);
        CHECK_FALSE(load_any(to_bytes(text)));
    }
    for (const char* bad : {"f 1 2\nf 1 2 3\n", "vt 0 0\nf 1/9 2/1 3/1\n"}) CHECK_FALSE(load_any(to_bytes(kTriangle + bad)));
}

TEST_CASE("tolerance: text of two bytes a character is read, in both orders, pairs too", "[io]") {
    const std::u16string text = u"# \U0001F600\xD800 caf\u00E9\no \U0001F600\u00E9\xD800\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const bool little : {true, false}) {
        Bytes file;
        for (const char16_t unit : u"\uFEFF" + text) {
            const std::byte low{static_cast<std::uint8_t>(unit & 0xFF)}, high{static_cast<std::uint8_t>(unit >> 8)};
            file.push_back(little ? low : high);
            file.push_back(little ? high : low);
        }
        const LoadedScene loaded = load_any_ok(file);
        CHECK(loaded.info.triangles_drawn == 1);
        CHECK(is_warned(loaded, "UTF-16"));
        CHECK_FALSE(load_any(file));
    }
}

TEST_CASE("tolerance: STL with a count of 0, a wrong one, and a text that was cut off", "[io][stl]") {
    Bytes file(84, std::byte{0});
    for (int t = 0; t < 2; ++t) {
        append<float>(file, {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, static_cast<float>(t)});
        append<std::uint16_t>(file, {0});
    }
    CHECK(load_any_ok(file).info.triangles_drawn == 2);
    put<std::uint32_t>(file, 80, 9);
    const LoadedScene fewer = load_any_ok(file);
    CHECK(fewer.info.triangles_drawn == 2);
    CHECK_FALSE(fewer.warnings.empty());
    const std::string facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    CHECK(read("solid a\n" + facet + "facet normal 0 0 1\nouter loop\nvertex 0 0").info.triangles_drawn == 1);
}
