// STL, PLY, OBJ and 3MF: the same object in each format gives the same picture, and each format's own rules.
#include "tests/io/model_maker.hpp"
#include "tests/io/png_maker.hpp"
#include "tests/support/skip.hpp"

#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

using namespace halflit;
using namespace halflit::test;

namespace {

constexpr int kSize = 96;

Material red() {
    Material m;
    m.base_color = {0.6f, 0.2f, 0.1f, 1};
    m.metallic = 0;
    m.roughness = 0.4f;
    return m;
}

std::vector<std::uint8_t> draw(LoadedScene loaded) {
    loaded.scene.materials = {red()};
    for (Mesh& mesh : loaded.scene.meshes) mesh.material = 0;
    const AutoSetup setup = auto_setup(loaded.scene, kSize, kSize);
    std::vector<std::uint8_t> rgba(std::size_t{kSize} * kSize * 4);
    REQUIRE(render(loaded.scene, setup.camera, setup.settings, {kSize, kSize, rgba.data()}));
    return rgba;
}

int most_different(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    int most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
    return most;
}

std::string error_of(const Bytes& file, ErrorCode code = ErrorCode::bad_input, const LoadOptions& options = {}) {
    const auto loaded = load_any(file, options);
    if (loaded) FAIL("was loaded");
    CHECK(loaded.error().code == code);
    return loaded.error().message;
}

/// Triangles of a sphere of radius 1, with or without the two polar caps' degenerate ones.
Polyhedron sphere(unsigned rings) {
    Polyhedron p;
    constexpr double pi = 3.14159265358979;
    for (unsigned i = 0; i <= rings; ++i)
        for (unsigned j = 0; j < 2 * rings; ++j) {
            const double a = pi * i / rings, b = pi * j / rings;
            const double s = i == 0 || i == rings ? 0.0 : std::sin(a);
            p.points.push_back({static_cast<float>(s * std::cos(b)), static_cast<float>(s * std::sin(b)), static_cast<float>(std::cos(a))});
        }
    for (unsigned i = 0; i < rings; ++i)
        for (unsigned j = 0; j < 2 * rings; ++j) {
            const unsigned k = (j + 1) % (2 * rings), a = i * 2 * rings, b = a + 2 * rings;
            p.triangles.push_back({a + j, b + j, b + k});
            p.triangles.push_back({a + j, b + k, a + k});
        }
    return p;
}

double angle_deg(Vec3f a, Vec3f b) {
    const double dot = double{a.x} * b.x + double{a.y} * b.y + double{a.z} * b.z;
    const double sizes = std::sqrt((double{a.x} * a.x + double{a.y} * a.y + double{a.z} * a.z) *
                                   (double{b.x} * b.x + double{b.y} * b.y + double{b.z} * b.z));
    return std::acos(std::min(1.0, dot / sizes)) * 180 / 3.14159265358979;
}

}  // namespace

TEST_CASE("models: one object in each format gives the picture of its glTF", "[io]") {
    const Polyhedron object = letter();
    const auto expected = draw(load_ok(gltf_of(object)));
    CHECK(std::adjacent_find(expected.begin(), expected.end(), std::not_equal_to<>()) != expected.end());
    std::vector<std::pair<std::string, Bytes>> files = {{"STL text", stl_text_of(object)},
                                                        {"STL binary", stl_binary_of(object, "a title")},
                                                        {"STL binary that begins with solid", stl_binary_of(object, "solid title")},
                                                        {"PLY text", ply_of(object, PlyKind::text)},
                                                        {"PLY little endian", ply_of(object, PlyKind::little)},
                                                        {"PLY big endian", ply_of(object, PlyKind::big)},
                                                        {"OBJ", obj_of(object)}};
    if (has_three_mf()) {
        const std::string items = "<item objectid=\"1\"/>";
        const auto of_unit = [&](const char* unit, float scale) {
            return three_mf(three_mf_text(unit, "<object id=\"1\">" + three_mf_mesh(object, scale) + "</object>", items));
        };
        files.emplace_back("3MF", of_unit("meter", 1.0f));
        files.emplace_back("3MF in millimetres", of_unit("millimeter", 1000.0f));
    }
    for (const auto& [name, file] : files) {
        INFO(name);
        const LoadedScene loaded = load_any_ok(file);
        CHECK(loaded.warnings.empty());
        CHECK(name.starts_with(loaded.info.format));
        CHECK(loaded.info.triangles_drawn == object.triangles.size());
        CHECK(most_different(draw(loaded), expected) <= 1);
    }
}

TEST_CASE("models: load_model reads glTF as load_gltf does", "[io]") {
    const Bytes file = gltf_of(letter());
    CHECK(load_any_ok(file).scene.meshes.at(0).positions == load_ok(file).scene.meshes.at(0).positions);
    CHECK(load_any_ok(file).info.format == "GLB");
    CHECK(find_model_format(to_bytes("  {\"asset\":{}}")) == ModelFormat::gltf);
}

TEST_CASE("models: what is no model is refused by name", "[io]") {
    CHECK(error_of(to_bytes("hello, world\n")).find("is no model: expected glTF, GLB, STL, PLY, OBJ or 3MF") != std::string::npos);
    std::string picture = "\x89PNG\r\n";
    for (int i = 0; i < 400; ++i) picture += static_cast<char>(i * 37 % 251);
    CHECK(error_of(to_bytes(picture)).find("is no model") != std::string::npos);
    CHECK(error_of({}).find("no bytes at all") != std::string::npos);
}

TEST_CASE("models: the up axis is turned unless the host turns it", "[io]") {
    LoadOptions as_stored;
    as_stored.turn_upright = false;
    const Bytes file = stl_binary_of(letter(), "");
    const Bounds upright = scene_bounds(load_any_ok(file).scene), stored = scene_bounds(load_any_ok(file, as_stored).scene);
    CHECK(upright.max == Vec3f{3, 4, 1.5f});
    CHECK(stored.max == Vec3f{3, 0, 4});
    CHECK(stored.min == Vec3f{0, -1.5f, 0});
}

TEST_CASE("models: a sphere without normals is smooth, and flat with a crease of 0", "[io]") {
    const Polyhedron ball = sphere(24);
    const LoadedScene smooth = load_any_ok(stl_binary_of(ball, ""));
    const Mesh& mesh = smooth.scene.meshes.at(0);
    CHECK(mesh.positions.size() == 2 + 23 * 48);  // one vertex at each place
    double worst = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) worst = std::max(worst, angle_deg(mesh.positions[i], mesh.normals[i]));
    CHECK(worst < 0.6);  // 0.48 degrees on the rings beside the poles, where triangles and halves of quads meet
    LoadOptions sharp;
    sharp.crease_deg = 0;
    CHECK(load_any_ok(stl_binary_of(ball, ""), sharp).scene.meshes.at(0).positions.size() > 4 * mesh.positions.size());
}

TEST_CASE("models: edges above the crease angle are sharp", "[io]") {
    LoadOptions options;
    for (const float crease : {0.0f, 30.0f, 89.0f, 91.0f, 180.0f}) {
        INFO(crease);
        options.crease_deg = crease;
        const Mesh mesh = load_any_ok(stl_binary_of(letter(), ""), options).scene.meshes.at(0);
        CHECK(mesh.positions.size() == (crease > 90 ? 12u : 36u));  // of 12 places, 3 faces at each
    }
}

TEST_CASE("models: smoothing groups of OBJ come before the crease angle", "[io]") {
    const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 -1\nv 1 1 -1\n", faces = "f 1 2 3 4\nf 2 5 6 3\n";
    CHECK(load_any_ok(to_bytes(points + faces)).scene.meshes.at(0).positions.size() == 8);
    CHECK(load_any_ok(to_bytes(points + "s 3\n" + faces)).scene.meshes.at(0).positions.size() == 6);
    LoadOptions smooth;
    smooth.crease_deg = 180;
    CHECK(load_any_ok(to_bytes(points + faces), smooth).scene.meshes.at(0).positions.size() == 6);
    CHECK(load_any_ok(to_bytes(points + "s off\n" + faces), smooth).scene.meshes.at(0).positions.size() == 8);
}

TEST_CASE("models: concave polygons are cut into triangles of the same area", "[io]") {
    // A comb of 200 teeth, with corners on its long edge: signed area by the shoelace formula.
    std::vector<Vec2f> outline;
    for (int i = 0; i < 200; ++i) {
        const auto x = static_cast<float>(i);
        outline.insert(outline.end(), {{x, 1.0f + static_cast<float>(i % 7)}, {x + 0.5f, 0.5f}});
    }
    outline.push_back({200, 3});
    for (int i = 200; i >= 0; i -= 50) outline.push_back({static_cast<float>(i), 0});
    double area = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vec2f a = outline[i], b = outline[(i + 1) % outline.size()];
        area += 0.5 * (double{a.x} * b.y - double{b.x} * a.y);
    }
    std::string text, face = "f";
    for (std::size_t i = 0; i < outline.size(); ++i) {
        text += "v " + text_of(Vec3f{outline[i].x, 2, outline[i].y}) + "\n";
        face.append(" ").append(std::to_string(i + 1));
    }
    const Mesh mesh = load_any_ok(to_bytes(text + face + "\n")).scene.meshes.at(0);
    CHECK(mesh.indices.size() / 3 == outline.size() - 2);
    double sum = 0;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const Vec3f a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]], c = mesh.positions[mesh.indices[t + 2]];
        const double part = 0.5 * ((double{b.x} - a.x) * (double{c.z} - a.z) - (double{b.z} - a.z) * (double{c.x} - a.x));
        CHECK(part * area > 0);  // all turn as the polygon does
        sum += part;
    }
    CHECK(std::abs(sum - area) < 1e-9);
}

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
    CHECK(error_of(file).find("20 triangles take 1084 bytes, found 1083: it was cut off") != std::string::npos);
    Bytes longer = stl_binary_of(letter(), "a title");
    append_u32(longer, 0);
    CHECK(load_any_ok(longer).warnings.at(0) == "4 bytes after the last triangle are ignored");
    Bytes text = stl_text_of(letter());
    text.resize(text.size() / 2);
    CHECK(error_of(text).find("line ") != std::string::npos);
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

TEST_CASE("PLY: a point cloud is refused by name", "[io]") {
    const std::string file =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n";
    CHECK(error_of(to_bytes(file)).find("it is a point cloud") != std::string::npos);
    CHECK(error_of(to_bytes("v 0 0 0\nv 1 0 0\np 1 2\n")).find("it has vertices but no faces") != std::string::npos);
}

TEST_CASE("models: numbers do not depend on the locale, and wrong ones are refused with their line", "[io]") {
    const Mesh mesh = load_any_ok(to_bytes("v +1.5e0 .25 -2.\nv 1e-60 1 0\nv 0 3 0\nf 1 2 3\n")).scene.meshes.at(0);
    CHECK(mesh.positions.at(0) == Vec3f{1.5f, 0.25f, -2.0f});
    CHECK(mesh.positions.at(1) == Vec3f{0, 1, 0});
    CHECK(error_of(to_bytes("v 0 0 0\nv 1,5 0 0\n")).find("line 2: expected a number, found \"1,5\"") != std::string::npos);
}

TEST_CASE("models: indices out of range are refused, or their faces left out when lenient", "[io]") {
    const Bytes obj = to_bytes("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n");
    CHECK(error_of(obj).find("line 5: the index 4 is out of range") != std::string::npos);
    Bytes ply = ply_of(letter(), PlyKind::text);
    std::string text(reinterpret_cast<const char*>(ply.data()), ply.size());
    ply = to_bytes(replaced(text, "6 6 7 8", "6 6 77 8"));
    CHECK(error_of(ply).find("a face has the vertex 77, but there are 12") != std::string::npos);
    LoadOptions lenient;
    lenient.lenient = true;
    CHECK(load_any_ok(obj, lenient).info.triangles_drawn == 1);
    CHECK(load_any_ok(ply, lenient).info.triangles_drawn == letter().triangles.size() - 4);
}

TEST_CASE("OBJ: materials of an MTL file become halflit's", "[io]") {
    std::string name = (std::filesystem::temp_directory_path() / "halflit-test-XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
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
    const auto load_with = [&](const std::string& rest) { return load_any(to_bytes(points + rest), {}, name); };
    const auto loaded = load_with("usemtl shiny\nf 1/1 2/1 3/1\nusemtl metal\nf 1 2 3\nusemtl glass\nf 1 2 3\nusemtl none\nf 1 2 3\n");
    const auto refused = load_with("usemtl secret\nf 1 2 3\n");
    const auto textured = load_with("usemtl picture\nf 1/1 2/1 3/1\nusemtl heights\nf 1/1 2/1 3/1\n");
    std::filesystem::remove_all(name);
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
    CHECK(picture.base_color_texture.row_u == Vec3f{2, 0, 0.5f});
    CHECK(picture.base_color_texture.row_v == Vec3f{0, 3, -2.25f});  // 1 - (3 (1 - v) + 0.25)
    CHECK(picture.normal_texture.used());
    CHECK(picture.normal_scale == 2.0f);
    CHECK_FALSE(textured->scene.materials.at(1).normal_texture.used());
    REQUIRE(textured->warnings.size() == 1);
    CHECK(textured->warnings[0].find("holds heights, expected a normal map") != std::string::npos);
    CHECK_FALSE(refused);  // outside of the model's folder
    const auto alone = load_any(to_bytes(points + "f 1 2 3\n"));
    REQUIRE(alone);  // a material file that is missing is warned of
    CHECK(alone->warnings.size() == 1);
}

TEST_CASE("3MF: components, transforms, units and colours are read", "[io]") {
    if (!has_three_mf()) HALFLIT_SKIP("built without libzip or expat");
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
    const Bounds bounds = scene_bounds(loaded.scene);
    // 2 (p + (10, 20, 30)) inches of z-up points in [0, 3] x [-1.5, 0] x [0, 4], turned
    CHECK(std::abs(bounds.max.x - 26 * 0.0254f) < 1e-5f);
    CHECK(std::abs(bounds.max.y - 68 * 0.0254f) < 1e-5f);
    CHECK(std::abs(bounds.min.z - -40 * 0.0254f) < 1e-5f);
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
    if (!has_three_mf()) HALFLIT_SKIP("built without libzip or expat");
    // Blanks: 128 MB in 130 kB.
    Bytes blanks = to_bytes(three_mf_text("meter", "", ""));
    blanks.resize(std::size_t{128} << 20, std::byte{' '});
    CHECK(error_of(zip_of({{"3D/3dmodel.model", blanks}}, true), ErrorCode::limit).find("its unpacked parts") != std::string::npos);
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
    CHECK(error_of(three_mf("<!DOCTYPE a [<!ENTITY b \"c\">]>" + three_mf_text("meter", "", ""))).find("line 1") != std::string::npos);
    const std::string own = "<object id=\"1\"><components><component objectid=\"1\"/></components></object>";
    CHECK(error_of(three_mf(three_mf_text("meter", own, "<item objectid=\"1\"/>"))).find("component of itself") != std::string::npos);
}

TEST_CASE("models: limits hold for each format", "[io]") {
    LoadOptions small;
    small.limits.max_geometry_bytes = 2000;
    const Polyhedron object = letter();
    std::vector<Bytes> files = {stl_text_of(object), stl_binary_of(object, ""), ply_of(object, PlyKind::little), obj_of(object)};
    if (has_three_mf())
        files.push_back(
            three_mf(three_mf_text("meter", "<object id=\"1\">" + three_mf_mesh(object) + "</object>", "<item objectid=\"1\"/>")));
    for (const Bytes& file : files) {
        CHECK(error_of(file, ErrorCode::limit, small).find("the geometry") != std::string::npos);
        LoadOptions shorter;
        shorter.limits.max_file_bytes = 100;
        CHECK(error_of(file, ErrorCode::limit, shorter).find("bytes, the limit is 100") != std::string::npos);
    }
}
