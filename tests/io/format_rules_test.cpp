// STL, PLY, OBJ and 3MF: each format's own rules.
#include "halflit/measures.hpp"
#include "tests/io/model_maker.hpp"
#include "tests/io/png_maker.hpp"
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/system.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>

using namespace halflit;
using namespace halflit::test;

TEST_CASE("STL: colours of VisCAM and Magics are read from the attribute", "[io]") {
    const Polyhedron object = letter();
    const std::uint16_t red_low = 31, red_high = 31 << 10;
    const auto first_color = [&](const std::string& title, std::uint16_t attribute) {
        const LoadedScene loaded =
            load_any_ok(stl_binary_of(object, title, std::vector<std::uint16_t>(object.triangles.size(), attribute)));
        const Mesh& mesh = loaded.scene.meshes.at(0);
        return mesh.colors.empty() ? Vec4f{-1, -1, -1, -1} : mesh.colors[0];
    };
    CHECK(first_color("x", static_cast<std::uint16_t>(red_high | 0x8000)) == Vec4f{1, 0, 0, 1});
    CHECK(first_color("x", red_high) == Vec4f{-1, -1, -1, -1});  // without bit 15 it is none
    std::string title = "COLOR=";
    title += {'\0', '\xff', '\0', '\xff'};
    CHECK(first_color(title, red_low) == Vec4f{1, 0, 0, 1});
    CHECK(first_color(title, 0x8000) == Vec4f{0, 1, 0, 1});  // the whole object's
}

TEST_CASE("STL: a file that was cut off is refused, with the lengths", "[io]") {
    Bytes file = stl_binary_of(letter(), "solid title");
    file.pop_back();
    CHECK(refusal_of(file).find("20 triangles take 1084 bytes, found 1083: it was cut off") != std::string::npos);
    Bytes longer = stl_binary_of(letter(), "a title");
    append_u32(longer, 0);
    CHECK(load_any_ok(longer).warnings.at(0) == "4 bytes after the last triangle are ignored");
    Bytes text = stl_text_of(letter());
    text.resize(text.size() / 2);
    CHECK(refusal_of(text).find("line ") != std::string::npos);
    text = stl_text_of(letter());
    text.resize(text.size() - std::string("endsolid letter\n").size());
    CHECK(load_any_ok(text).warnings.size() == 1);
}

TEST_CASE("PLY: colours, normals and texture coordinates of vertices are read", "[io]") {
    const std::string file =
        "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\nproperty float nx\r\n"
        "property float ny\r\nproperty float nz\r\nproperty float s\r\nproperty float t\r\nproperty uchar red\r\nproperty uchar green\r\n"
        "property uchar blue\r\nelement face 1\r\nproperty list uchar int vertex_index\r\nend_header\r\n"
        "0 0 0 0 0 1 0 0 255 0 0\r\n1 0 0 0 1 0 1 0.25 0 255 0\r\n0 1 0 1 0 0 0 1 0 0 0\r\n3 0 1 2\r\n";
    const Mesh mesh = load_any_ok(to_bytes(file)).scene.meshes.at(0);
    CHECK(mesh.normals == std::vector<Vec3f>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}});
    CHECK(mesh.uv0 == std::vector<Vec2f>{{0, 1}, {1, 0.75f}, {0, 0}});
    CHECK(mesh.colors == std::vector<Vec4f>{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 0, 1}});
}

TEST_CASE("PLY: triangle strips turn every second triangle", "[io]") {
    const std::string file =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 4 -1 2 0 1\n";
    const Mesh mesh = load_any_ok(to_bytes(file)).scene.meshes.at(0);
    REQUIRE(mesh.indices.size() == 12);
    for (const Vec3f& normal : mesh.normals) CHECK(normal == Vec3f{0, 0, 1});
}

TEST_CASE("PLY: vertices without faces are points, lit if they have normals", "[io]") {
    const std::string colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const std::string normals = "property float nx\nproperty float ny\nproperty float nz\n";
    const std::string start = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
    const LoadedScene colored = load_any_ok(to_bytes(start + colors + "end_header\n0 0 0 255 0 0\n1 2 3 0 255 0\n"));
    const Mesh& mesh = colored.scene.meshes.at(0);
    CHECK(mesh.topology == Topology::points);
    CHECK(mesh.indices == std::vector<std::uint32_t>{0, 1});
    CHECK(mesh.colors.at(1) == Vec4f{0, 1, 0, 1});
    CHECK(colored.scene.materials.at(static_cast<std::size_t>(mesh.material)).unlit);
    const LoadedScene lit = load_any_ok(to_bytes(start + normals + "end_header\n0 0 0 0 0 1\n1 2 3 0 1 0\n"));
    CHECK(!lit.scene.materials.at(static_cast<std::size_t>(lit.scene.meshes.at(0).material)).unlit);
    CHECK(refusal_of(to_bytes("v 0 0 0\nv 1 0 0\n")).find("it has vertices but no faces") != std::string::npos);
}

TEST_CASE("OBJ: materials of an MTL file become halflit's", "[io]") {
    const TemporaryFolder files;
    const std::string name = files.path();
    PngSpec spec;
    spec.width = spec.height = 2, spec.color_type = 2;
    const auto write_picture = [&](const char* file, auto sample) {
        const Bytes png = make_png(spec, sample);
        std::ofstream(name + file, std::ios::binary)
            .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
    };
    write_picture("/wood.png", [](std::uint32_t x, std::uint32_t y, int c) { return 40 * x + 90 * y + static_cast<std::uint32_t>(c); });
    write_picture("/heights.png", [](std::uint32_t x, std::uint32_t, int) { return 200 * x; });
    write_picture("/bumps.png", [](std::uint32_t, std::uint32_t, int c) { return c == 2 ? 255u : 128u; });
    std::ofstream(name + "/two words.mtl") << "newmtl shiny\nKd 0.5 0.25 0.125\nKs 0.5 0.5 0.5\nNs 30\n"
                                              "newmtl metal\nKd 1 1 1\nPr 0.25\nPm 1\nNs 1000\n"
                                              "newmtl glass\nKd 0 0 1\nd 0.25\nKe 1 2 3\nKs 0 0 0\n"
                                              "newmtl secret\nmap_Kd ../secret.png\n"
                                              "newmtl picture\nKd 0 0 0\nmap_Kd -s 2 3 1 -o 0.5 0.25 wood.png\nbump -bm 2 bumps.png\n"
                                              "newmtl heights\nmap_Bump heights.png\n";
    const std::string points = "mtllib two words.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\n";
    const auto load_with = [&](const std::string& rest) { return load_any(to_bytes(points + rest), strictly(), name); };
    const auto loaded = load_with("usemtl shiny\nf 1/1 2/1 3/1\nusemtl metal\nf 1 2 3\nusemtl glass\nf 1 2 3\nusemtl none\nf 1 2 3\n");
    const auto refused = load_with("usemtl secret\nf 1 2 3\n");
    const auto textured = load_with("usemtl picture\nf 1/1 2/1 3/1\nusemtl heights\nf 1/1 2/1 3/1\n");
    REQUIRE(loaded);
    const auto& materials = loaded->scene.materials;
    REQUIRE(materials.size() == 4);
    CHECK(materials[0].base_color == Vec4f{0.5f, 0.25f, 0.125f, 1});
    CHECK(materials[0].roughness == 0.5f);  // (2 / 32)^(1/4)
    CHECK_FALSE(materials[0].has_specular_color());
    CHECK(materials[1].roughness == 0.25f);
    CHECK(materials[1].metallic == 1.0f);
    CHECK(materials[2].alpha_mode == AlphaMode::blend);
    CHECK(materials[2].base_color.w == 0.25f);
    CHECK(materials[2].emissive == Vec3f{1, 2, 3});
    CHECK(materials[2].specular == 0.0f);
    CHECK(loaded->scene.meshes.at(0).uv0.at(0) == Vec2f{0, 0.75f});
    REQUIRE(loaded->warnings.size() == 1);
    CHECK(loaded->warnings[0] == "usemtl none: no material of this name was read; drawn in grey");
    REQUIRE(textured);
    const Material& picture = textured->scene.materials.at(0);
    CHECK(picture.base_color == Vec4f{1, 1, 1, 1});
    CHECK(picture.textures[TextureSlot::base_color].row_u == Vec3f{2, 0, 0.5f});
    CHECK(picture.textures[TextureSlot::base_color].row_v == Vec3f{0, 3, -2.25f});  // 1 - (3 (1 - v) + 0.25)
    CHECK(picture.textures[TextureSlot::normal].used());
    CHECK(picture.normal_scale == 2.0f);
    CHECK_FALSE(textured->scene.materials.at(1).textures[TextureSlot::normal].used());
    REQUIRE(textured->warnings.size() == 1);
    CHECK(textured->warnings[0].find("holds heights, expected a normal map") != std::string::npos);
    CHECK_FALSE(refused);  // outside of the model's folder
    const auto alone = load_any(to_bytes(points + "f 1 2 3\n"));
    REQUIRE(alone);  // a material file that is missing is warned of
    CHECK(alone->warnings.size() == 1);
}

TEST_CASE("OBJ: comments end a statement, and a backslash in them joins no line", "[io]") {
    const auto loaded =
        load_any_ok(to_bytes("v 0 0 0 # a b c\nv 1 0 0\n# C:\\art\\\nv 0 1 0 # C:\\art\\\nvt 0 0 # t\nv "
                             "-0.00000000000000000000000000000000000000000000000000000001 2 1e-60\n"
                             "f 1/1 2/1 3/1 # x\nf 1 2 \\\n4\n"));
    REQUIRE(loaded.scene.meshes.size() == 1);
    CHECK(loaded.scene.meshes[0].indices.size() == 6);
    CHECK(loaded.warnings.empty());
}

TEST_CASE("PLY: faces may come before their vertices", "[io]") {
    const auto loaded = load_any_ok(
        to_bytes("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement edge 1\nproperty int vertex1\n"
                 "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n0\n0 0 0\n1 0 0\n0 1 0\n"));
    REQUIRE(loaded.scene.meshes.size() == 1);
    CHECK(loaded.scene.meshes[0].positions == std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    REQUIRE(loaded.warnings.size() == 1);
    CHECK(loaded.warnings[0] == "1 elements \"edge\" are not drawn");
}

TEST_CASE("OBJ: lines and points are drawn without light", "[io]") {
    const auto loaded =
        load_any_ok(to_bytes("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1e999 0 0\nvt 0 0\nf 1 2 3\nl 1 2 3\nl 3/1 1/1\nl 1 4\no cloud\np 3 2\n"));
    const Scene& scene = loaded.scene;
    REQUIRE(scene.meshes.size() == 3);
    REQUIRE(scene.instances.size() == 3);
    const auto mesh_of = [&](Topology topology) {
        for (const Mesh& mesh : scene.meshes)
            if (mesh.topology == topology) return mesh;
        return Mesh{};
    };
    const Mesh lines = mesh_of(Topology::lines), points = mesh_of(Topology::points);
    CHECK(lines.positions == std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(lines.indices == std::vector<std::uint32_t>{0, 1, 1, 2, 2, 0});
    CHECK(points.positions == std::vector<Vec3f>{{0, 1, 0}, {1, 0, 0}});
    CHECK(points.indices == std::vector<std::uint32_t>{0, 1});
    CHECK(scene.materials.at(static_cast<std::size_t>(lines.material)).unlit);
    CHECK_FALSE(scene.materials.at(static_cast<std::size_t>(mesh_of(Topology::triangles).material)).unlit);
    REQUIRE(loaded.warnings.size() == 1);
    CHECK(loaded.warnings[0].find("1 lines or points with coordinates that are not finite") != std::string::npos);
    CHECK(load_any(to_bytes("v 0 0 0\nv 1 0 0\nl 1 2\n")));
    CHECK(refusal_of(to_bytes("v 0 0 0\nv 1 0 0\nl 1\n")).find("at least 2") != std::string::npos);
}

TEST_CASE("3MF: an extension that a file requires is known, or the file refused by its name", "[io]") {
    if (!has_three_mf()) HALFLIT_SKIP("built without expat");
    const auto requiring = [](const std::string& attributes) {
        std::string text = three_mf_text("meter", "<object id=\"1\">" + three_mf_mesh(letter()) + "</object>", "<item objectid=\"1\"/>");
        const std::size_t at = text.find("unit=");
        REQUIRE(at != std::string::npos);
        return three_mf(text.insert(at, attributes + " "));
    };
    const std::string slice = "xmlns:s=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\"",
                      lattice = "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\"",
                      production = "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"";
    CHECK(load_any(requiring(production + " requiredextensions=\"p\"")));
    CHECK(load_any(requiring(slice)));  // there, but not required
    CHECK(load_any(requiring(lattice + " requiredextensions=\"b\"")));
    CHECK(refusal_of(requiring(slice + " " + production + " requiredextensions=\"p s\"")).find("slice/2015/07\" is not supported") !=
          std::string::npos);
    CHECK(refusal_of(requiring("requiredextensions=\"x\"")).find("\"x\" is not supported") != std::string::npos);
    const LoadOptions tolerant;
    CHECK(load_any(requiring(slice + " requiredextensions=\"s\""), tolerant));
}

TEST_CASE("3MF: a fault beside the triangles leaves them, with one warning, and the strict rules refuse it", "[io][3mf]") {
    if (!has_three_mf()) HALFLIT_SKIP("built without expat");
    const std::string object = "<object id=\"1\" name=\"ring\">" + three_mf_mesh(letter()) + "</object>", item = "<item objectid=\"1\"/>",
                      text = three_mf_text("millimeter", object, item);
    const auto with = [&](const std::string& from, const std::string& to) { return replaced(text, from, to); };
    const std::pair<std::string, const char*> cases[] = {
        {with("<build>", "<ms:pb a=\"1\"/><build>"), "the prefix \"ms\" is not declared"},
        {with("ring", "A & B"), "1 characters that XML does not allow"},
        {with("ring", "&nbsp;&#0;&#xD800;"), "3 characters"},
        {with("ring", "Geh\xe4use"), "1 characters"},
        {with("ring", "a\x01\x1f"), "2 characters"},
        {with("<build>", "<metadata>1 < 2</metadata><build>"), "1 characters"},
        {with("<model", "<!DOCTYPE model><model"), "document type declaration"},
        {with("<build>", "<!-- a -- b ---><build>"), "2 characters"},
        {text + "<junk", "junk after document element"},
        {with(item, item + "<item objectid=\"14\"/>"), "no object with the id 14; the item is left out"},
        {with(item, item + "<item objectid=\"1\" transform=\"1 0\"/>"), "expected 12 numbers"},
        {with("</build></model>", ""), "what stands before it is read"},
        {with("millimeter", "parsec"), "unit: \"parsec\" is none that 3MF has"},
        {with("core/2015/02", "core/2013/01"), "the namespace is"},
        {with("xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"", ""), "the namespace is \"\""},
        {with("</resources>", object + "</resources>"), "two objects with the id 1; the first counts"},
        {replaced(with("</resources>",
                       "<object id=\"2\"><components><component objectid=\"1\"/><component objectid=\"9\"/>"
                       "<component objectid=\"2\"/></components></object></resources>"),
                  item, "<item objectid=\"2\"/>"),
         "component is left out"},
    };
    const LoadOptions tolerant;
    for (const auto& [model, part] : cases) {
        INFO(part);
        const auto loaded = load_any(three_mf(model), tolerant);
        REQUIRE(loaded);
        CHECK(loaded->info.triangles_drawn >= letter().triangles.size());
        CHECK(std::count_if(loaded->warnings.begin(), loaded->warnings.end(),
                            [&, found = part](const std::string& warning) { return warning.find(found) != std::string::npos; }) >= 1);
        CHECK_FALSE(load_any(three_mf(model)));
    }
    const LoadedScene none = load_any_ok(three_mf(with(item, "<item objectid=\"1\" printable=\"0\"/>")));
    CHECK(none.warnings == std::vector<std::string>{"1 items that are not to be printed are left out", "the model has nothing to draw"});
    // A part that cannot be read fails at each use alike, a texture that is missing costs its colours alone.
    const std::string gone = "<item p:path=\"/gone.model\" objectid=\"1\"/>";
    const auto parts = load_any(three_mf(replaced(with(item, gone + gone + item), "<model",
                                                  "<model xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"")),
                                tolerant);
    REQUIRE(parts);
    CHECK(parts->warnings == std::vector<std::string>{"gone.model: is not in the ZIP file; the item is left out"});
    const std::string group = "<m:texture2dgroup id=\"7\" texid=\"9\"><m:tex2coord u=\"0\" v=\"0\"/></m:texture2dgroup>";
    const auto untextured = load_any(three_mf(three_mf_text("meter",
                                                            group + "<object id=\"1\" pid=\"7\" pindex=\"0\">" +
                                                                three_mf_mesh(letter(), 1.0f, {"pid=\"7\" p1=\"0\""}) + "</object>",
                                                            item)),
                                     tolerant);
    REQUIRE(untextured);
    CHECK(untextured->info.triangles_drawn == letter().triangles.size());
    CHECK(untextured->warnings == std::vector<std::string>{"3D/3dmodel.model: texture2d 9: is not there; drawn in grey"});
    // A thumbnail of another format may come first, and of a file without a mesh, the next one is drawn for one that is damaged.
    const Bytes types = to_bytes("<Types/>");
    CHECK(load_any(zip_of({{"Metadata/a.webp", types}, {"[Content_Types].xml", types}, {"3D/3dmodel.model", to_bytes(text)}}, false)));
    const Bytes picture = plain_png(2, 2, 9, 9, 9);
    Bytes sliced = zip_of({{"Metadata/plate_1.png", picture},
                           {"Metadata/thumbnail.png", picture},
                           {"3D/3dmodel.model", to_bytes(three_mf_text("meter", "", ""))}},
                          false);
    sliced[30 + 20] = std::byte{'A'};
    CHECK(load_any_ok(sliced).warnings.back() == "the file has no mesh; its picture \"Metadata/thumbnail.png\" is drawn");
    CHECK(load_any(three_mf(replaced(text, "version=\"1.0\"", "version=\"1.0\" encoding=")), tolerant));
    const LoadedScene all = load_any_ok(three_mf(with(item, "")));  // a build may be empty
    CHECK(all.info.triangles_drawn == letter().triangles.size());
    CHECK(all.warnings == std::vector<std::string>{"3D/3dmodel.model: the build has no items that are there; all objects are drawn"});
    const char* const sound = "<metadata><![CDATA[a & <b]]></metadata><!-- & < --><?p & < ?><build>";
    CHECK(load_any_ok(three_mf(with("<build>", sound))).warnings.empty());
    CHECK(load_any_ok(three_mf("\xEF\xBB\xBF \n" + replaced(text, "version=\"1.0\"", "encoding=\"utf-16\" a"))).warnings.empty());
    // A vertex without a number is a place of its own: those behind it keep theirs.
    const auto loaded = load_any(three_mf(replaced(text, "<vertex x=\"", "<vertex x=\"?")), tolerant);
    REQUIRE(loaded);
    const auto& triangles = letter().triangles;
    const auto is_off = [](const auto& t) { return t[0] == 0 || t[1] == 0 || t[2] == 0; };
    CHECK(loaded->info.triangles_drawn ==
          triangles.size() - static_cast<std::size_t>(std::count_if(triangles.begin(), triangles.end(), is_off)));
    // Names of parts as packers write them.
    const Bytes model = to_bytes(text);
    const auto relations = [](const std::string& target) {
        return to_bytes("<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship Target=\"" +
                        target + "\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>");
    };
    const std::vector<std::pair<std::string, Bytes>> packages[] = {
        {{"3D\\3dmodel.model", model}},
        {{"/3d/3DModel.Model", model}},
        {{"other/part.model", model}},
        {{"_rels/.rels", relations("\\3D\\a b.model")}, {"3D/a b.model", model}},
        {{"_rels/.rels", relations("./3D/a%20b.model")}, {"3D/a b.model", model}},
        {{"_rels/.rels", relations("gone.model")}, {"3D/3dmodel.model", model}},
        {{"_rels/.rels", to_bytes("<Rel")}, {"3D/3dmodel.model", model}},
    };
    for (const auto& files : packages) CHECK(load_any(zip_of(files, true), tolerant));
    CHECK(refusal_of(zip_of({{"a/ring.stl", {}}, {"b.OBJ", {}}}, true)).find("is a ZIP file that holds a/ring.stl, b.OBJ; unpack it") !=
          std::string::npos);
}

TEST_CASE("3MF: beams are capsules of their radii, closed and of the right size", "[io][3mf]") {
    if (!has_three_mf()) HALFLIT_SKIP("built without expat");
    const auto measured = [](const std::string& members, const std::string& beam, const std::string& more = "") {
        const std::string text =
            R"(<?xml version="1.0"?><model unit="meter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" )"
            R"(xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02" )"
            R"(xmlns:bb="http://schemas.microsoft.com/3dmanufacturing/beamlattice/balls/2020/07"><resources>)"
            R"(<object id="1"><mesh><vertices>)"
            R"(<vertex x="0" y="0" z="0"/><vertex x="10" y="0" z="0"/><vertex x="0" y="20" z="0"/></vertices>)"
            R"(<b:beamlattice minlength="0.1" )" +
            members + "><b:beams>" + beam + "</b:beams>" + more +
            R"(</b:beamlattice></mesh></object></resources><build><item objectid="1"/></build></model>)";
        const LoadedScene loaded = load_any_ok(three_mf(text));
        const auto m = measure_geometry(loaded.scene);
        REQUIRE(m);
        CHECK(m->watertight);
        return *m;
    };
    constexpr double kPi = 3.14159265358979;
    // Sixteen sides have 2.6 % less area across than the circle; a ball of them loses twice that.
    const std::string beam = R"(<b:beam v1="0" v2="1"/>)";
    const Measures flat = measured(R"(radius="2" cap="butt")", beam);
    CHECK(flat.volume == Approx(kPi * 4 * 10).epsilon(0.03));
    CHECK(flat.size().x == Approx(10));
    const Measures round = measured(R"(radius="2")", beam);
    CHECK(round.volume == Approx(kPi * 4 * 10 + kPi * 4.0 / 3.0 * 8).epsilon(0.05));
    CHECK(round.size().x == Approx(14));
    CHECK(measured(R"(radius="1" cap="hemisphere")", beam).size().x == Approx(12));
    const Measures cone = measured(R"(radius="9")", R"(<b:beam v1="0" v2="1" r1="3" r2="1" cap1="butt" cap2="sphere"/>)");
    CHECK(cone.volume == Approx(kPi * 10 / 3 * (9 + 3 + 1) + kPi * 2 / 3).epsilon(0.03));
    CHECK(cone.size().x == Approx(11));
    // Balls, and beams shorter than the least length.
    const Measures ball = measured(R"(radius="1" bb:ballmode="mixed" bb:ballradius="3")", R"(<b:beam v1="0" v2="0"/>)",
                                   R"(<bb:balls><bb:ball vindex="2"/></bb:balls>)");
    CHECK(ball.size().y == Approx(6));
    CHECK(ball.volume == Approx(kPi * 4.0 / 3.0 * 27).epsilon(0.08));
    CHECK(measured(R"(radius="1" bb:ballmode="all" bb:ballradius="3")", beam).size().x == Approx(16));
}

TEST_CASE("3MF: components, transforms, units and colours are read", "[io]") {
    if (!has_three_mf()) HALFLIT_SKIP("built without expat");
    const std::string resources =
        "<basematerials id=\"5\"><base name=\"a\" displaycolor=\"#FF0000\"/></basematerials>"
        "<m:colorgroup id=\"6\"><m:color color=\"#00FF00\"/><m:color color=\"#0000FF80\"/></m:colorgroup>"
        "<object id=\"1\" pid=\"5\" pindex=\"0\">" +
        three_mf_mesh(letter(), 1.0f, {"pid=\"6\" p1=\"0\"", "pid=\"6\" p1=\"1\""}) +
        "</object><object id=\"2\"><components><component objectid=\"1\"/>"
        "<component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 10 20 30\"/></components></object>";
    const LoadedScene loaded =
        load_any_ok(three_mf(three_mf_text("inch", resources, "<item objectid=\"2\" transform=\"2 0 0 0 2 0 0 0 2 0 0 0\"/>")));
    CHECK(loaded.warnings.empty());
    CHECK(loaded.info.triangles_drawn == 2 * letter().triangles.size());
    CHECK(loaded.info.unit_m == 0.0254);
    const Bounds bounds = scene_bounds(loaded.scene);
    // 2 (p + (10, 20, 30)) inches of z-up points in [0, 3] x [-1.5, 0] x [0, 4], turned
    CHECK(std::abs(bounds.max.x - 26) < 1e-5f);
    CHECK(std::abs(bounds.max.y - 68) < 1e-5f);
    CHECK(std::abs(bounds.min.z - -40) < 1e-5f);
    REQUIRE(loaded.scene.meshes.size() == 2);  // opaque, and the triangle that is not
    const auto has = [](const Mesh& mesh, Vec4f color) {
        return std::find(mesh.colors.begin(), mesh.colors.end(), color) != mesh.colors.end();
    };
    CHECK(has(loaded.scene.meshes[0], {0, 1, 0, 1}));
    CHECK(has(loaded.scene.meshes[0], {1, 0, 0, 1}));
    CHECK(loaded.scene.meshes[1].indices.size() == 3);
    CHECK(loaded.scene.materials.at(static_cast<std::size_t>(loaded.scene.meshes[1].material)).alpha_mode == AlphaMode::blend);
}

TEST_CASE("3MF: bombs end at a limit", "[io]") {
    if (!has_three_mf()) HALFLIT_SKIP("built without expat");
    // Blanks: 128 MB in 130 kB.
    Bytes blanks = to_bytes(three_mf_text("meter", "", ""));
    blanks.resize(std::size_t{128} << 20, std::byte{' '});
    CHECK(refusal_of(zip_of({{"3D/3dmodel.model", blanks}}, true), ErrorCode::limit).find("its unpacked parts") != std::string::npos);
    // 2^60 copies of a mesh, and of nothing.
    for (const bool empty : {false, true}) {
        std::string objects = "<object id=\"1\">" + (empty ? std::string() : three_mf_mesh(letter())) + "</object>";
        for (int i = 2; i <= 60; ++i) {
            const std::string of = "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
            objects += "<object id=\"" + std::to_string(i) + "\"><components>" + of + of + "</components></object>";
        }
        const auto loaded = load_any(three_mf(three_mf_text("meter", objects, "<item objectid=\"60\"/>")));
        CHECK(loaded.has_value() == empty);
        if (!loaded) CHECK(loaded.error().code == ErrorCode::limit);
    }
    // Lists times the elements that use them: mixtures stop at their own end, layers are work.
    std::string list, mixtures, layers;
    for (int i = 0; i < 400'000; ++i) list += "0 ", mixtures += "<m:composite values=\"1\"/>", layers += "<m:multi pindices=\"0\"/>";
    const std::string base = "<basematerials id=\"2\"><base displaycolor=\"#FF0000\"/></basematerials>";
    const std::string triangle = "<object id=\"1\">" + three_mf_mesh(letter()) + "</object>";
    CHECK(load_any(three_mf(three_mf_text(
        "meter",
        base + "<m:compositematerials id=\"7\" matid=\"2\" matindices=\"" + list + "\">" + mixtures + "</m:compositematerials>" + triangle,
        "<item objectid=\"1\"/>"))));
    CHECK(refusal_of(
              three_mf(three_mf_text("meter", base + "<m:multiproperties id=\"7\" pids=\"" + list + "\">" + layers + "</m:multiproperties>",
                                     "<item objectid=\"1\"/>")),
              ErrorCode::limit)
              .find("max_work") != std::string::npos);
    std::string items;
    for (int i = 0; i < 300'000; ++i) items += "<item objectid=\"1\"/>";
    const std::string one = "<object id=\"1\">" + three_mf_mesh(letter()) + "</object>";
    CHECK_FALSE(load_any(three_mf(three_mf_text("meter", one, items))));
    CHECK(refusal_of(three_mf("<!DOCTYPE a [<!ENTITY b \"c\">]>" + three_mf_text("meter", "", ""))).find("line 1") != std::string::npos);
    const std::string own = "<object id=\"1\"><components><component objectid=\"1\"/></components></object>";
    CHECK(refusal_of(three_mf(three_mf_text("meter", own, "<item objectid=\"1\"/>"))).find("component of itself") != std::string::npos);
}
