// STL, OBJ, OFF and PLY as programs write them: words wherever lines end, words that the formats do not have, values that are not used, and
// colours that stand for none.
#include "apps/io/files/model_files.hpp"
#include "apps/io/models/text_scanner.hpp"
#include "halflit/image.hpp"
#include "halflit/target.hpp"
#include "tests/io/model_maker.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>

using namespace halflit;
using namespace halflit::test;

namespace {

std::string text_of_bytes(const Bytes& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// All occurrences replaced.
std::string each(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
    return text;
}

void check_same_surface(const LoadedScene& made, const LoadedScene& expected) {
    REQUIRE(made.scene.meshes.size() == 1);
    const Mesh &a = made.scene.meshes[0], &b = expected.scene.meshes.at(0);
    REQUIRE(a.indices.size() == b.indices.size());
    for (std::size_t i = 0; i < a.indices.size(); ++i) REQUIRE(a.positions[a.indices[i]] == b.positions[b.indices[i]]);
}

const std::string kFacet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("scanner: words and numbers by one rule", "[io][text]") {
    LoadOptions options;
    io::detail::Document document(options, "");
    document.geometry.set_limit(1000);
    std::vector<std::string_view> kept;
    io::detail::TextScanner scanner(
        "one \t two\v# a comment\r\n#kept 1\n\n  1.5 2, 3;4 0,5 1.5D+01 -2.f nan(ind) 1,2,3 word 7\nlast \\\nname # no\nnames a.mtl \\\r\n "
        "b.mtl\\\nc.mtl\nMaterial #25 "
        "\n\x1A",
        document, "", true);
    scanner.keep_comments("#kept ", kept);
    CHECK(scanner.word() == "one");
    CHECK(scanner.words_in_line(9) == 1);
    CHECK(scanner.word_in_line() == "two");
    CHECK(scanner.word_in_line().empty());
    CHECK(scanner.line() == 1);
    for (const double expected : {1.5, 2.0, 3.0, 4.0, 0.5, 15.0, -2.0}) CHECK(scanner.number() == expected);
    CHECK(std::isnan(scanner.number()));
    for (const double expected : {1.0, 2.0, 3.0}) CHECK(scanner.number_in_line() == expected);
    CHECK(scanner.line() == 4);
    CHECK(std::isnan(scanner.number_in_line()));  // "word"
    double value = 0;
    CHECK(scanner.take_number(value));
    CHECK_FALSE(scanner.take_number(value));
    CHECK(scanner.word() == "last");
    CHECK(scanner.rest_of_line() == "name");
    CHECK(scanner.word() == "names");
    CHECK(scanner.words_in_line(9) == 3);
    CHECK(scanner.rest_size() == 23);
    CHECK(scanner.rest_of_line() == "a.mtl   b.mtl c.mtl");
    CHECK(scanner.line() == 9);
    CHECK(scanner.word() == "Material");
    CHECK(scanner.rest_of_line(true) == "#25");
    CHECK(scanner.word().empty());
    CHECK_THROWS_AS(scanner.number(), io::detail::CutOff);
    REQUIRE(kept.size() == 1);
    CHECK(kept[0] == "1");
    scanner.warn();
    REQUIRE(document.warnings.size() == 1);
    CHECK(document.warnings[0] == "line 4: expected a number, found \"word\"; what needs the value is left out");
    for (const auto& [word, count] : {std::pair("12", 12), {"3.0", 3}, {"7,", 7}})
        CHECK(io::detail::TextScanner::parse_count(word) == static_cast<std::uint64_t>(count));
    for (const char* word : {"-1", "1.5", "x", "", "1e300", "nan"}) CHECK_FALSE(io::detail::TextScanner::parse_count(word));
}

TEST_CASE("STL: text is read wherever its lines end, and by whatever its writers leave out or add", "[io][stl]") {
    const std::string text = text_of_bytes(stl_text_of(letter()));
    const LoadedScene expected = read(text);
    CHECK(expected.warnings.empty());
    struct Way {
        const char* what;
        std::string text;
        bool is_warned;
    };
    const Way ways[] = {
        {"one line", each(text, "\n", " "), false},
        {"\\r alone", each(text, "\n", "\r"), false},
        {"end loop", each(text, "endloop", "end loop"), false},
        {"end facet", each(each(text, "endfacet", "end facet"), "endsolid", "end solid"), false},
        {"capitals", each(each(text, "facet", "FACET"), "vertex", "Vertex"), false},
        {"no endfacet", each(text, "endfacet\n", ""), false},
        {"no endloop", each(text, "endloop\n", ""), false},
        {"no normal", each(text, " normal 0 0 0", ""), false},
        {"no outer loop", each(text, " outer loop\n", ""), false},
        {"a normal of words", each(text, "normal 0 0 0", "normal +inf -inf weird"), false},
        {"a normal of one word", each(text, "normal 0 0 0", "normal -nan(ind)"), false},
        {"a comment first", "# by a script\n# of ours\n" + text, false},
        {"blank lines first", "\n\n\t\n" + text, false},
        {"no solid", text.substr(text.find('\n') + 1), false},
        {"no endsolid", text.substr(0, text.find("endsolid")), true},
        {"two solids", text + each(text.substr(0, text.find("facet")), "letter", "b") + "endsolid b\n", false},
        {"commas", each(text, " 0\n", ", 0\n"), false},
        {"an unknown word", each(text, "endfacet", "endfacet\nlayer"), true},
        {"a zero byte at the end", text + std::string(3, '\0'), false},
        {"DOS's end of file", text + "\x1A", false},
    };
    for (const Way& way : ways) {
        INFO(way.what);
        const LoadedScene made = read(way.text);
        check_same_surface(made, expected);
        CHECK(made.warnings.empty() == !way.is_warned);
        CHECK(made.warnings.size() <= 1);
    }
    CHECK(read(each(kFacet, "vertex 0 1 0", "vertex 1 1 0\nvertex 0 1 0")).info.triangles_drawn == 2);  // four corners
    CHECK(read("solid a\n" + each(kFacet, "1 0 0", "1.0D+00 0 0") + "endsolid").scene.meshes.at(0).positions.at(1).x == 1.0f);
    const LoadedScene wrong = read("solid a\n" + kFacet + each(kFacet, "1 0 0", "1 zero 0") + "endsolid a\n");
    CHECK(wrong.info.triangles_drawn == 1);
    CHECK(is_warned(wrong, "line 12: expected a number, found \"zero\""));
    for (const Way& way : ways)
        if (way.is_warned && std::string(way.what) != "no endsolid") CHECK_FALSE(load_any(to_bytes(way.text)));
}

TEST_CASE("STL: colours of text are read", "[io][stl]") {
    const LoadedScene red = read("solid a\ncolor 1 0 0\n" + kFacet + "color 0 255 0\n" + each(kFacet, "0 1 0", "0 2 0") + "endsolid\n");
    const Mesh& mesh = red.scene.meshes.at(0);
    REQUIRE(mesh.colors.size() == 6);
    CHECK(mesh.colors[mesh.indices[0]] == Vec4f{1, 0, 0, 1});
    CHECK(mesh.colors[mesh.indices[3]] == Vec4f{0, 1, 0, 1});
    // Anywhere in a facet it is the facet's.
    for (const char* before : {"facet normal", "outer", "vertex 0 0 0", "vertex 1 0 0", "vertex 0 1 0", "endloop"})
        for (const char* color : {"color 1 0 0\n", "color 255 0 0 ", "COLOR 1.0 0.0 0.0 1.0\n"}) {
            INFO(color << " before " << before);
            const LoadedScene within = read("solid a\n" + each(kFacet, before, color + std::string(before)) + "endsolid\n");
            CHECK(within.warnings.empty());
            CHECK(within.info.triangles_drawn == 1);
            CHECK(within.scene.meshes.at(0).colors == std::vector<Vec4f>(3, {1, 0, 0, 1}));
        }
    const LoadedScene behind = read("solid a\n" + each(kFacet, "endfacet", "color 1 0 0\nendfacet") + "endsolid\n");
    CHECK(behind.scene.materials.at(0).base_color.x == 0.5f);  // no facet follows: the usual grey
}

TEST_CASE("STL: attributes that writers set where they have no colour are none", "[io][stl]") {
    const std::size_t triangles = letter().triangles.size();
    const auto colors_of = [&](const std::string& title, std::uint16_t attribute, std::uint16_t first) {
        std::vector<std::uint16_t> attributes(triangles, attribute);
        attributes[0] = first;
        const LoadedScene loaded = load_any_ok(stl_binary_of(letter(), title, attributes));
        const Scene& scene = loaded.scene;
        return std::pair(scene.meshes.at(0).colors, scene.materials.at(0).base_color);
    };
    const std::string meshlab = "STL MeshLab COLOR=\x7f\x7f\x7f\xff MATERIAL=", magics = std::string("COLOR=\xff\0\0\xff", 10);
    for (const auto& [title, attribute] :
         {std::pair(meshlab, 0), {std::string("x"), 0}, {std::string("x"), 0xffff}, {meshlab, 0xffff}, {std::string("x"), 0x8000}}) {
        const auto value = static_cast<std::uint16_t>(attribute);
        const auto [colors, base] = colors_of(title, value, value);
        CHECK(colors.empty());
        CHECK(base.x == 0.5f);  // the usual grey
    }
    const auto [whole, white] = colors_of(magics, 0, 0);  // the file's own colour, no facet has another
    REQUIRE_FALSE(whole.empty());
    for (const Vec4f& color : whole) CHECK(color == Vec4f{1, 0, 0, 1});
    // One facet that differs: then attributes are meant.
    const auto [meant, unused] = colors_of(meshlab, 0, 0x001f);
    REQUIRE_FALSE(meant.empty());
    CHECK(std::count(meant.begin(), meant.end(), Vec4f{1, 0, 0, 1}) == 3);
}

TEST_CASE("models: the kind of a text is a score over its first lines", "[io]") {
    const std::string obj = text_of_bytes(obj_of(letter())), prose = "Exported by a program\n$ on a day\n$\nwith words of its own\n";
    CHECK(read(prose + obj).info.format == "OBJ");
    CHECK(is_warned(read(prose + obj), "line 1: expected a statement of OBJ, found \"Exported\" (and 3 more)"));
    CHECK(read("solid matter that is none\n" + obj).info.format == "OBJ");
    CHECK(read("# facet normal\n" + text_of_bytes(stl_text_of(letter()))).info.format == "STL");
    CHECK(read("newmtl blue\nKd 0 0 1\nusemtl blue\n" + obj).scene.materials.at(0).base_color == Vec4f{0, 0, 1, 1});
    CHECK(read("PLY\n" + text_of_bytes(ply_of(letter(), PlyKind::text)).substr(4)).info.format == "PLY");
    const std::string stl = text_of_bytes(stl_text_of(letter())), zeros(40, '\0');
    for (const std::string& damaged :
         {stl + '\0', stl + zeros, each(stl, "\nfacet", std::string("\n\0facet", 7)), "solid \x07name\n" + stl}) {
        const LoadedScene made = read(damaged);
        CHECK(made.info.format == "STL");
        check_same_surface(made, read(stl));
    }
    for (const char* before : {"\n", "  \n\n ", "# by hand\n", "\xEF\xBB\xBF\r\n"})
        CHECK(read(before + text_of_bytes(ply_of(letter(), PlyKind::text))).info.format == "PLY");
    for (const char* none : {"hello world\nthis is prose\n", "v is a letter\nf too\n", "{", "<html>v 0 0 0</html>"})
        CHECK_FALSE(load_any(to_bytes(none), LoadOptions{}));
}

TEST_CASE("models: a file that has nothing but faults is refused with the first one", "[io]") {
    for (const char* text :
         {"v a b c\nv d e f\nf 1 2 3\n", "solid a\nfacet normal 0 0 1\nouter loop\nvertex x y z\nvertex 1 0 0\nvertex 0 1 0\n"}) {
        const auto loaded = load_any(to_bytes(text), LoadOptions{});
        REQUIRE_FALSE(loaded);
        CHECK(loaded.error().code == ErrorCode::bad_input);
        CHECK(loaded.error().message.find("expected a number") != std::string::npos);
    }
    CHECK(is_warned(read("solid a\nendsolid a\n"), "nothing to draw"));
}

TEST_CASE("OFF: words wherever lines end, other numbers of channels, and binary files are read", "[io][off]") {
    const LoadedScene expected = load_any_ok(obj_of(letter()));
    std::string body, counts;
    const Polyhedron shape = letter();
    for (const Vec3f& v : shape.points) body += text_of(v) + "\n";
    for (const auto& polygon : shape.polygons) {
        body += std::to_string(polygon.size()) + "\n";
        for (const unsigned i : polygon) body += std::to_string(i) + "\n";
    }
    counts = fmt::format("{} {} 0\n", shape.points.size(), shape.polygons.size());
    for (const std::string& text :
         {"OFF\n" + counts + body, each("OFF\n" + counts + body, "\n", " "), "off\n" + counts + body,
          "OFF\n" + each(counts, " ", "\n") + body, each("OFF " + counts + body, "\n", "\r\n"), "OFF\n" + each(counts, " 0", "") + body}) {
        const LoadedScene made = read(text);
        check_same_surface(made, expected);
        CHECK(made.warnings.empty());
    }
    const auto first_color = [](const std::string& text) { return read(text).scene.meshes.at(0).colors.at(0); };
    CHECK(first_color("COFF\n3 1 0\n0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n3 0 1 2\n") == Vec4f{1, 0, 0, 1});
    CHECK(first_color("OFF\n3 1 0\n0 0 0 0.0 1.0 0.0\n1 0 0 0 1 0\n0 1 0 0 1 0\n3 0 1 2\n") == Vec4f{0, 1, 0, 1});
    CHECK(read("COFF\n3 1 0\n0 0 0 0 0 0 255\n1 0 0 0 0 0 255\n0 1 0 0 0 0 255\n3 0 1 2\n").scene.meshes.at(0).colors.empty());
    CHECK(read("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 3 2 3 0\n").info.triangles_drawn == 2);  // two faces on a line
    CHECK(is_warned(read("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 1 zero\n3 0 1 2\n3 1 2 3\n"), "line 6: expected a number, found \"zero\""));
    CHECK(read("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n").scene.meshes.at(0).topology == Topology::points);
    const LoadedScene cut = read("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2");
    CHECK(cut.info.triangles_drawn == 1);
    CHECK(is_warned(cut, "it was cut off: 4 of 4 vertices and 1 of 2 faces are there"));

    Bytes binary = to_bytes("COFF BINARY\n");
    const auto put_u32 = [&](std::uint32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8) binary.push_back(static_cast<std::byte>(value >> shift & 255u));
    };
    const auto put_float = [&](float value) { put_u32(std::bit_cast<std::uint32_t>(value)); };
    put_u32(3), put_u32(1), put_u32(3);
    for (const Vec3f& v : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}})
        for (const float value : {v.x, v.y, v.z, 0.0f, 0.0f, 1.0f, 1.0f}) put_float(value);
    put_u32(3), put_u32(0), put_u32(1), put_u32(2), put_u32(0);
    const LoadedScene loaded = load_any_ok(binary);
    CHECK(loaded.scene.meshes.at(0).positions.at(1).x == 1.0f);
    CHECK(loaded.scene.meshes.at(0).colors.at(0) == Vec4f{0, 0, 1, 1});
    CHECK(load_any(binary));
    for (std::size_t size = 13; size < binary.size(); size += 5) {  // not 84, which is an empty STL file
        INFO(size);
        CHECK_FALSE(load_any(Bytes(binary.begin(), binary.begin() + static_cast<std::ptrdiff_t>(size))));
    }
}

TEST_CASE("PLY: comments in the body, other names and types, and values that are not used are read", "[io][ply]") {
    const std::string text = text_of_bytes(ply_of(letter(), PlyKind::text));
    const LoadedScene expected = read(text);
    CHECK(expected.warnings.empty());
    for (const auto& [from, to] : {std::pair<std::string, std::string>{"end_header\n", "end_header\ncomment vertices\nobj_info none\n"},
                                   {"end_header", "end header"},
                                   {"vertex_indices", "vertex_indexes"},
                                   {"vertex_indices", "corners"},
                                   {"element face", "element polygon"},
                                   {"element vertex", "element points"},
                                   {"1.5 7\n", "1.5 seven\n"},
                                   {"uchar ignored", "uint64 ignored"},
                                   {"uchar ignored", "string ignored"},
                                   {"property float x", "property FLOAT X"},
                                   {"\n", "\r"},
                                   {"\n", "\r\n"}}) {
        INFO(from << " -> " << to);
        const LoadedScene made = read(each(text, from, to));
        check_same_surface(made, expected);
        CHECK(made.warnings.empty());
    }
    for (const PlyKind kind : {PlyKind::little, PlyKind::big}) {
        const std::string binary = text_of_bytes(ply_of(letter(), kind));
        check_same_surface(load_any_ok(to_bytes(each(binary, "uchar ignored", "bool ignored"))), expected);
    }
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty int label\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const LoadedScene labels = read(header + "0 0 0 1\n1 0 0 2\n0 1 0 1\n3 0 1 2\n");
    const Mesh& mesh = labels.scene.meshes.at(0);
    REQUIRE(mesh.colors.size() == 3);
    CHECK(mesh.colors[0] == mesh.colors[2]);
    CHECK_FALSE(mesh.colors[0] == mesh.colors[1]);
    CHECK(is_warned(labels, "by its labels"));
    const std::string colored = each(header, "int label", "uchar red\nproperty uchar green\nproperty uchar blue");
    CHECK(read(colored + "0 0 0 0 0 0\n1 0 0 0 0 0\n0 1 0 0 0 0\n3 0 1 2\n").scene.meshes.at(0).colors.empty());
    CHECK(read(colored + "0 0 0 0 0 0\n1 0 0 0 0 0\n0 1 0 0 0 1\n3 0 1 2\n").scene.meshes.at(0).colors.size() == 3);
    const std::string faces = each(each(header, "property int label\n", ""), "vertex_indices\n",
                                   "vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n");
    CHECK(read(faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0 0 0\n").scene.meshes.at(0).colors.empty());
    CHECK(read(faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0 0 255\n").scene.meshes.at(0).colors.at(0) == Vec4f{0, 0, 1, 1});
}

TEST_CASE("PLY: flat clouds lie, in float32 too, and reliefs stand", "[io][ply]") {
    const auto cloud = [](const std::string& type, double height) {
        std::string text =
            fmt::format("ply\nformat ascii 1.0\nelement vertex 400\nproperty {0} x\nproperty {0} y\nproperty {0} z\nend_header\n", type);
        for (int i = 0; i < 400; ++i) text += fmt::format("{} {} {}\n", i % 20, i / 20, i % 7 * height / 6);
        return read(text);
    };
    CHECK(is_warned(cloud("float", 2.0), "with z up"));
    CHECK(is_warned(cloud("double", 5.0), "with z up"));
    CHECK_FALSE(is_warned(cloud("float", 5.0), "with z up"));
    CHECK_FALSE(is_warned(cloud("double", 12.0), "with z up"));
}

TEST_CASE("OBJ: normals against the winding are turned", "[io][obj]") {
    const std::string plain = text_of_bytes(obj_of(letter()));
    const LoadedScene made = read(plain);
    const auto normals_of = [&](const std::string& text) {
        const Mesh mesh = read(text).scene.meshes.at(0);
        for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
            const Vec3f a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                        c = mesh.positions[mesh.indices[t + 2]];
            for (std::size_t k = 0; k < 3; ++k) CHECK(dot(cross(b - a, c - a), mesh.normals[mesh.indices[t + k]]) > 0);
        }
    };
    const std::string quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    normals_of(quad + "vn 0 0 -1\nf 1//1 2//1 3//1 4//1\n");
    normals_of(quad + "vn 0 0 -1\nvn 0 0.1 1\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n");
    normals_of(quad + "vn 0.2 0 -1\nvn 0 0.3 -1\nvn 0 0 -1\nf 1//1 2//2 3//3\n");
    // A corner whose smooth normal leans over the edge stays as it is: the others say which side is meant.
    const Mesh edge = read(quad + "vn 0 0 1\nvn 1 0 -0.1\nf 1//1 2//1 3//2\n").scene.meshes.at(0);
    CHECK(edge.normals[edge.indices[2]].z < 0);
}

TEST_CASE("OBJ: colours of ZBrush and those from 0 to 255 are read", "[io][obj]") {
    const Mesh codes = read("v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 0 0 64\nf 1 2 3\n").scene.meshes.at(0);
    CHECK(codes.colors.at(0) == Vec4f{1, 0, 0, 1});
    CHECK(std::abs(codes.colors.at(2).z - 0.0513f) < 1e-3f);  // code 64
    const Mesh shares = read("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n").scene.meshes.at(0);
    CHECK(shares.colors.at(1) == Vec4f{0, 1, 0, 1});
    for (const bool faces_first : {true, false}) {
        const std::string paint = "#MRGB ffff000000ff00ff\n#MRGB ff0000ff\n", face = "f 1 2 3\n";
        const Mesh painted = read(kCorners + (faces_first ? face + paint : paint + face)).scene.meshes.at(0);
        REQUIRE(painted.colors.size() == 3);
        CHECK(painted.colors[0] == Vec4f{1, 0, 0, 1});
        CHECK(painted.colors[2] == Vec4f{0, 0, 1, 1});
    }
    CHECK(read("v 0 0 0 0 0 0\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n").scene.meshes.at(0).colors.empty());
    // A vertex without a colour is white beside others; an object without any is grey.
    const LoadedScene mixed = read("o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no b\nv 0 0 1 1 0 0\nv 1 0 1 1 0 0\nv 0 1 1\nf 4 5 6\n");
    CHECK(mixed.scene.meshes.at(0).colors.empty());
    CHECK(mixed.scene.meshes.at(1).colors.at(2) == Vec4f{1, 1, 1, 1});
}

TEST_CASE("MTL: renamed files, tiles, quotes and names in another case are found", "[io][obj]") {
    const TemporaryFolder files;
    const std::string folder = files.path();
    const auto write = [&](const std::string& name, const std::string& text) { std::ofstream(folder + "/" + name) << text; };
    write("part.mtl", "newmtl Red #25\nKd 255 0 0\nnewmtl Blue\nKd 0 0 1\n");
    write("two words.mtl", "newmtl \"green\"\nKd 0 1 0\n");
    const auto color_of = [&](const std::string& text) -> std::pair<Vec4f, std::vector<std::string>> {
        write("part.obj", text + kCorners + "f 1 2 3\n");
        const auto loaded = load_model(folder + "/part.obj");
        REQUIRE(loaded);
        return {loaded->scene.materials.at(0).base_color, loaded->warnings};
    };
    const auto [own, own_warnings] = color_of("usemtl Blue\n");
    CHECK(own == Vec4f{0, 0, 1, 1});
    REQUIRE(own_warnings.size() == 1);
    CHECK(own_warnings[0] == "materials are those of \"part.mtl\", which has the model's name");
    const auto [renamed, renamed_warnings] = color_of("mtllib untitled.mtl\nusemtl Blue\n");
    CHECK(renamed == Vec4f{0, 0, 1, 1});
    CHECK(color_of("mtllib part.mtl\nusemtl Red #25\n").first == Vec4f{1, 0, 0, 1});
    CHECK(color_of("mtllib part.mtl\nusemtl blue\n").first == Vec4f{0, 0, 1, 1});
    CHECK(color_of("mtllib \"two words.mtl\"\nusemtl green\n").first == Vec4f{0, 1, 0, 1});
    CHECK(color_of("mtllib two words.mtl\nusemtl \"GREEN\"\n").first == Vec4f{0, 1, 0, 1});
    CHECK(color_of("mtllib part.mtl\nusemtl other\n").first == Vec4f{0.5f, 0.5f, 0.5f, 1});
    write("part.mtl", "newmtl Blue\nKd 0 0 1\nnewmtl blue\nKd 0 1 0\n");  // two alike: neither is meant
    CHECK(color_of("mtllib part.mtl\nusemtl BLUE\n").first == Vec4f{0.5f, 0.5f, 0.5f, 1});

    write("part.mtl", "newmtl Red\nKd 1 0 0\n");
    CHECK(color_of("mtllib part.mtl\nmtllib part.mtl\nusemtl RED\n").first == Vec4f{1, 0, 0, 1});  // the same one twice
    CHECK(color_of("mtllib \\\npart.mtl \\\n\"two words.mtl\"\nusemtl Red\n").first == Vec4f{1, 0, 0, 1});
    CHECK(color_of("newmtl own\nmtllib part.mtl\nKd 0 1 0\nusemtl own\n").first == Vec4f{0, 1, 0, 1});
    // The library may come behind the faces, and these before their vertices: then each has the material that stood before it.
    write("part.obj", "f 1 2 3\nusemtl Red\nf 3 2 1\nusemtl Red\n" + kCorners + "mtllib part.mtl\n");
    const auto behind = load_model(folder + "/part.obj");
    REQUIRE(behind);
    REQUIRE(behind->scene.meshes.size() == 2);
    const auto color = [&](std::size_t mesh) {
        return behind->scene.materials.at(static_cast<std::size_t>(behind->scene.meshes[mesh].material)).base_color;
    };
    CHECK_FALSE(color(0) == Vec4f{1, 0, 0, 1});
    CHECK(color(1) == Vec4f{1, 0, 0, 1});
    write("part.mtl", "newmtl Red\nmap_Kd a.png\nbump b.png\n");
    write("part.obj", "newmtl own\nnorm c.png\nusemtl Red\n" + kCorners + "f 1 2 3\n");
    const auto named = io::files_named_by(folder + "/part.obj", {});
    REQUIRE(named);
    const auto names = [](const std::vector<std::string>& list, const char* name) {
        return std::any_of(list.begin(), list.end(), [&](const std::string& path) { return path.ends_with(name); });
    };
    for (const char* name : {"part.mtl", "a.png", "b.png", "c.png"}) CHECK(names(*named, name));
    // What is not drawn is said in one warning, and its pictures are the file's, too: they are not there.
    write("part.mtl",
          "newmtl Red\nmap_Ka a.png\nmap_Ns -clamp on b.png\nPr 0.5\nmap_Ks c.png\nrefl -type sphere d.png\nnewmtl x\nmap_Kd e.png\n");
    write("part.obj", "mtllib part.mtl\nusemtl Red\n" + kCorners + "f 1 2 3\n");
    const auto unused = load_model(folder + "/part.obj");
    REQUIRE(unused);
    REQUIRE(unused->warnings.size() == 1);
    CHECK(unused->warnings[0] == "material \"Red\": not drawn: map_Ns, refl, map_Ka, map_Ks");
    for (const char* name : {"part.mtl", "a.png", "b.png", "c.png", "d.png", "e.png"}) CHECK(names(unused->info.files, name));
    write("part.mtl", "newmtl Red\nmap_Ka a.png\nmap_Kd a.png\n");
    REQUIRE(write_image(folder + "/a.png", {1, 1, {0, 255, 0, 255}, {}}));
    const auto both = load_model(folder + "/part.obj");
    REQUIRE(both);
    for (const std::string& warning : both->warnings) CHECK(warning.find("not drawn") == std::string::npos);

    Image texel{1, 1, {0, 255, 0, 255}, {}};
    REQUIRE(write_image(folder + "/wood.1001.png", texel));
    REQUIRE(write_image(folder + "/two words.png", texel));
    for (const char* name : {"wood.<UDIM>.png", "\"two words.png\"", "two words.png"}) {
        INFO(name);
        write("part.mtl", std::string("newmtl m\nmap_Kd ") + name + "\n");
        write("part.obj", "mtllib part.mtl\nusemtl m\nvt 0 0\n" + kCorners + "f 1/1 2/1 3/1\n");
        const auto loaded = load_model(folder + "/part.obj");
        REQUIRE(loaded);
        CHECK(loaded->scene.textures.size() == 1);
        CHECK(loaded->warnings.size() == (std::string(name).find("UDIM") != std::string::npos ? 1 : 0));
    }
}
