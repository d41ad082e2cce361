// Projects of slicers in 3MF files: filaments, painted facets, volumes that are not printed, plates, layers of colours, and pictures.
#include "tests/io/model_maker.hpp"
#include "tests/io/png_maker.hpp"
#include "tests/support/skip.hpp"

#include "apps/io/files/optional_libraries.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

using namespace halflit;
using namespace halflit::test;

namespace {

using Files = std::vector<std::pair<std::string, Bytes>>;

/// A cube of the side 10 from (x, y, 0) on, whose first triangles have further members.
std::string cube(double x, double y, const std::vector<std::string>& members = {}) {
    std::string out = "<mesh><vertices>";
    for (int i = 0; i < 8; ++i)
        out += fmt::format(R"(<vertex x="{}" y="{}" z="{}"/>)", x + 10 * (i & 1), y + 10 * (i >> 1 & 1), 10 * (i >> 2 & 1));
    out += "</vertices><triangles>";
    constexpr int kFaces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    for (std::size_t t = 0; t < 12; ++t)
        out += fmt::format(R"(<triangle v1="{}" v2="{}" v3="{}" {}/>)", kFaces[t][0], kFaces[t][1], kFaces[t][2],
                           t < members.size() ? members[t] : "");
    return out + "</triangles></mesh>";
}

std::string object(int id, const std::string& content, const std::string& members = "") {
    return fmt::format(R"(<object id="{}" type="model" {}>{}</object>)", id, members, content);
}

Bytes project(const std::string& objects, const std::string& items, const Files& more = {}) {
    Files files{{"[Content_Types].xml", to_bytes("<Types/>")},
                {"3D/3dmodel.model", to_bytes(replaced(three_mf_text("millimeter", objects, items), "<model ",
                                                       "<model xmlns:slic3rpe=\"http://schemas.slic3r.org/3mf/2017/06\" "))}};
    files.insert(files.end(), more.begin(), more.end());
    return zip_of(files, true);
}

/// Triangles of each colour, in 8-bit codes of linear light.
std::map<std::array<int, 3>, std::size_t> colors_of(const LoadedScene& loaded) {
    std::map<std::array<int, 3>, std::size_t> out;
    for (const Instance& instance : loaded.scene.instances) {
        const Mesh& mesh = loaded.scene.meshes.at(static_cast<std::size_t>(instance.mesh));
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const Vec4f c = mesh.colors.empty() ? Vec4f{} : mesh.colors.at(mesh.indices[i]);
            const auto code = [](float x) { return static_cast<int>(std::lround(255 * x)); };
            ++out[{code(c.x), code(c.y), code(c.z)}];
        }
    }
    return out;
}

constexpr std::array<int, 3> kNone{0, 0, 0}, kRed{255, 0, 0}, kGreen{0, 255, 0}, kBlue{0, 0, 255};
const Bytes kFilamentColors =
    to_bytes(R"({"a":["#000000"],"filament_colour":["#FF0000","#00FF00","#0000FFFF"],"b":{"filament_colour":["#111111"]}})");

}  // namespace

TEST_CASE("slicers: parts have their filaments, and helpers are left out", "[io][3mf]") {
    if (!has_three_mf()) HALFLIT_SKIP("built without expat");
    const std::string components =
        R"(<components><component objectid="1"/><component objectid="2"/><component objectid="3"/></components>)";
    const Bytes settings = to_bytes(R"(<config><object id="9"><metadata key="extruder" value="3"/>
        <part id="1" subtype="normal_part"><metadata key="extruder" value="2"/></part>
        <part id="2" subtype="normal_part"><metadata key="extruder" value="0"/></part>
        <part id="3" subtype="modifier_part"/></object></config>)");
    const LoadedScene loaded =
        load_any_ok(project(object(1, cube(0, 0)) + object(2, cube(20, 0)) + object(3, cube(-5, -5)) + object(9, components),
                            R"(<item objectid="9"/><item objectid="1" printable="0"/>)",
                            {{"Metadata/model_settings.config", settings}, {"Metadata/project_settings.config", kFilamentColors}}));
    CHECK(colors_of(loaded) == std::map<std::array<int, 3>, std::size_t>{{kGreen, 12}, {kBlue, 12}});
    CHECK(is_warned(loaded, "1 modifiers, negative volumes and supports"));
    CHECK(is_warned(loaded, "not to be printed"));
}

TEST_CASE("slicers: runs of triangles are volumes, and supports of 3MF itself are none", "[io][3mf]") {
    if (!has_three_mf()) HALFLIT_SKIP("built without expat");
    const Bytes settings =
        to_bytes(R"(<config><object id="1"><volume firstid="0" lastid="3"><metadata type="volume" key="extruder" value="2"/></volume>
        <volume firstid="4" lastid="9"><metadata type="volume" key="modifier" value="1"/></volume>
        <volume firstid="10" lastid="11"><metadata type="volume" key="volume_type" value="NegativeVolume"/></volume></object></config>)");
    const Bytes colors = to_bytes("; a = b\n; extruder_colour = \"\";#00FF00\n; filament_colour = #0000FF;#FF0000\n");
    const LoadedScene loaded = load_any_ok(project(object(1, cube(0, 0)) + replaced(object(2, cube(20, 0)), "\"model\"", "\"support\""),
                                                   R"(<item objectid="1"/><item objectid="2"/>)",
                                                   {{"Metadata/Slic3r_PE_model.config", settings}, {"Metadata/Slic3r_PE.config", colors}}));
    CHECK(colors_of(loaded) == std::map<std::array<int, 3>, std::size_t>{{kGreen, 4}});
}

TEST_CASE("slicers: paint divides facets, and their area stays", "[io][3mf]") {
    if (!has_three_mf()) HALFLIT_SKIP("built without expat");
    // The last digits: 4 and 8 are filaments 1 and 2, 0C is the third, 3 divides all sides, 1 and 2 one and two of them.
    const std::pair<const char*, std::map<std::array<int, 3>, std::size_t>> cases[] = {
        {"4", {{kRed, 1}}},
        {"8", {{kGreen, 1}}},
        {"0C", {{kBlue, 1}}},
        {"84C03", {{kRed, 1}, {kGreen, 1}, {kBlue, 0}}},
        {"84443", {{kRed, 3}, {kGreen, 1}}},
        {"481", {{kRed, 1}, {kGreen, 1}}},
        {"4482", {{kRed, 2}, {kGreen, 1}}},
        {"44483443", {{kRed, 6}, {kGreen, 1}}},
    };
    for (const char* name : {"paint_color", "slic3rpe:mmu_segmentation"})
        for (const auto& [paint, wanted] : cases) {
            INFO(name << " " << paint);
            const LoadedScene loaded =
                load_any_ok(project(object(1, cube(0, 0, {fmt::format("{}=\"{}\"", name, paint)})), R"(<item objectid="1"/>)",
                                    {{"Metadata/project_settings.config", kFilamentColors}}));
            auto found = colors_of(loaded);
            found[kRed] -= 11;  // those without paint: the first filament
            if (std::string(paint) != "84C03")
                for (const auto& [color, count] : wanted) CHECK(found[color] == count);
            double area = 0;
            for (const Mesh& mesh : loaded.scene.meshes)
                for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
                    const auto at = [&](std::size_t c) { return mesh.positions[mesh.indices[i + c]]; };
                    const Vec3f n = cross(at(1) - at(0), at(2) - at(0));
                    area += 0.5 * std::sqrt(static_cast<double>(dot(n, n)));
                }
            CHECK(std::fabs(area - 600) < 1e-3);
        }
    // A tree that never ends is cut off.
    CHECK(load_any(project(object(1, cube(0, 0, {"paint_color=\"" + std::string(5000, '3') + "\""})), R"(<item objectid="1"/>)"), {}));
}

TEST_CASE("slicers: one plate is drawn, by the project or by its place", "[io][3mf]") {
    if (!has_three_mf()) HALFLIT_SKIP("built without expat");
    const std::string objects = object(1, cube(0, 0)) + object(2, cube(0, 0));
    const std::string items =
        R"(<item objectid="1" transform="1 0 0 0 1 0 0 0 1 100 100 0"/><item objectid="2" transform="1 0 0 0 1 0 0 0 1 407 100 0"/>)";
    const Bytes settings =
        to_bytes(R"(<config><plate><metadata key="plater_id" value="1"/><model_instance><metadata key="object_id" value="2"/>
        <metadata key="instance_id" value="0"/></model_instance></plate><plate><metadata key="plater_id" value="2"/><model_instance>
        <metadata key="object_id" value="1"/><metadata key="instance_id" value="0"/></model_instance></plate></config>)");
    const auto drawn = [](const Bytes& file, int plate) {
        LoadOptions options;
        options.plate = plate;
        options.recentre = false;
        const LoadedScene loaded = load_any_ok(file, options);
        std::set<int> places;
        for (const Instance& instance : loaded.scene.instances)
            places.insert(static_cast<int>(std::lround(instance.world_from_object.c[3].x)));
        return places;
    };
    const Bytes by_project = project(objects, items, {{"Metadata/model_settings.config", settings}}), by_place = project(objects, items);
    CHECK(drawn(by_project, 1) == std::set<int>{407});
    CHECK(drawn(by_project, 2) == std::set<int>{100});
    CHECK(drawn(by_project, 0) == std::set<int>{100, 407});
    CHECK(drawn(by_place, 1) == std::set<int>{100});
    CHECK(drawn(by_place, 2) == std::set<int>{407});
    // Bodies that cross the space between plates lie on one.
    const Bytes one = project(objects, replaced(items, "1 407 100", "1 250 100"));
    CHECK(drawn(one, 1) == std::set<int>{100, 250});
}

TEST_CASE("3MF: layers and mixtures of colours, a lost texture, and a picture in place of a mesh", "[io][3mf]") {
    if (!has_three_mf()) HALFLIT_SKIP("built without expat");
    const std::string groups =
        R"(<basematerials id="5"><base name="a" displaycolor="#FF0000"/><base name="b" displaycolor="#0000FF"/></basematerials>
        <m:colorgroup id="6"><m:color color="#00FF00"/><m:color color="#00FF0080"/></m:colorgroup>
        <m:multiproperties id="7" pids="5 6"><m:multi pindices="0 0"/><m:multi pindices="1 1"/></m:multiproperties>
        <m:compositematerials id="8" matid="5" matindices="0 1"><m:composite values="1 3"/></m:compositematerials>)";
    const LoadedScene loaded = load_any_ok(project(
        groups + object(1, cube(0, 0, {R"(pid="7" p1="0")", R"(pid="7" p1="1")", R"(pid="8" p1="0")"})), R"(<item objectid="1"/>)"));
    auto found = colors_of(loaded);
    CHECK(found[kGreen] == 1);
    CHECK(found[{0, 128, 127}] == 1);
    CHECK(found[{64, 0, 191}] == 1);
    CHECK(found[kNone] == 9);
    const LoadedScene lost =
        load_any_ok(project(R"(<m:texture2d id="4" path="/gone.png" contenttype="image/png"/><m:texture2dgroup id="5" texid="4">
        <m:tex2coord u="0" v="0"/></m:texture2dgroup>)" +
                                object(1, cube(0, 0), R"(pid="5" pindex="0")"),
                            R"(<item objectid="1"/>)"));
    CHECK(is_warned(lost, "\"/gone.png\" is not in the ZIP file; drawn in grey"));
    PngSpec spec;
    spec.width = 4, spec.height = 2, spec.color_type = 2;
    const Bytes picture = make_png(spec, [](std::uint32_t x, std::uint32_t, int) { return 60 * x; });
    const LoadedScene card = load_any_ok(project("", "", {{"Metadata/plate_1.png", picture}}));
    CHECK(is_warned(card, "its picture \"Metadata/plate_1.png\" is drawn"));
    REQUIRE(card.scene.cameras.size() == 1);
    CHECK(card.scene.cameras[0].half_width == 2 * card.scene.cameras[0].half_height);
    CHECK(card.scene.materials.at(static_cast<std::size_t>(card.scene.meshes.at(0).material)).unlit);
    // The same in G-code, where the largest picture counts.
    const auto block = [](const char* title, const std::string& base64) {
        return fmt::format("; {} {}\n; {}\n; {}\n; thumbnail end\n", title, base64.size(), base64.substr(0, 40), base64.substr(40));
    };
    const std::string packed = base64(picture), code = "; generated by a slicer\n";
    const LoadedScene drawn = load_any_ok(
        to_bytes(code + block("thumbnail_JPG begin 1x1", std::string(48, 'A')) + block("thumbnail begin 4x2", packed) + "G1 X0\n"));
    CHECK(is_warned(drawn, "its picture \"thumbnail 4x2\" is drawn"));
    CHECK(drawn.scene.cameras.at(0).half_width == 2 * drawn.scene.cameras.at(0).half_height);
    CHECK(refusal_of(to_bytes(code + block("thumbnail begin 4x2", std::string(48, 'A')))).find("is G-code") != std::string::npos);
}

TEST_CASE("models: a model whose alpha is 0 everywhere is opaque", "[io][3mf]") {
    if (!has_three_mf()) HALFLIT_SKIP("built without expat");
    const auto with_alpha = [](const char* alpha) {
        return project(fmt::format(R"(<basematerials id="5"><base name="a" displaycolor="#FF0000{}"/></basematerials>)", alpha) +
                           object(1, cube(0, 0), R"(pid="5" pindex="0")"),
                       R"(<item objectid="1"/>)");
    };
    const LoadedScene clear = load_any_ok(with_alpha("00")), half = load_any_ok(with_alpha("80"));
    const auto material = [](const LoadedScene& loaded) {
        return loaded.scene.materials.at(static_cast<std::size_t>(loaded.scene.meshes.at(0).material));
    };
    CHECK(material(clear).alpha_mode == AlphaMode::opaque);
    CHECK(clear.scene.meshes.at(0).colors.at(0).w == 1.0f);
    CHECK(is_warned(clear, "drawn opaque"));
    CHECK(material(half).alpha_mode == AlphaMode::blend);
}

TEST_CASE("models: formats that are not read are named, with a way to one that is", "[io]") {
    const auto padded = [](std::string text) { return text.append(200 - std::min<std::size_t>(200, text.size()), ' '); };
    const std::pair<std::string, const char*> cases[] = {{"Kaydara FBX Binary  ", "is FBX"},
                                                         {"Version 9.5 JT DM 7.0", "JT"},
                                                         {"LASF", "LAS"},
                                                         {"ASTM-E57", "E57"},
                                                         {"<?xml version=\"1.0\"?><COLLADA>", "COLLADA"},
                                                         {"<!-- arm --><mujoco model=\"arm\">", "MuJoCo"},
                                                         {"<?xml version=\"1.0\"?><robot name=\"arm\"><mujoco/>", "URDF"},
                                                         {"BLENDER-v300", "Blender"},
                                                         {"#usda 1.0", "USD"},
                                                         {"PXR-USDC", "USD"}};
    for (const auto& [begins, name] : cases) {
        const std::string refusal = refusal_of(to_bytes(padded(begins)), ErrorCode::bad_input, {});
        INFO(refusal);
        CHECK(refusal.find(name) != std::string::npos);
        CHECK(refusal.find("which is not read; ") != std::string::npos);
    }
    CHECK(refusal_of(zip_of({{"model.usdc", to_bytes("PXR-USDC")}}, false), ErrorCode::bad_input, {}).find("is USDZ") != std::string::npos);
    // By the name where the content says nothing, or less.
    const auto refusal = [](const char* content, const char* name) {
        const auto loaded = load_model_bytes(to_bytes(content), name, "", {});
        return loaded ? std::string() : loaded.error().message;
    };
    CHECK(refusal("cube(1);", "a.scad").find("is OpenSCAD") != std::string::npos);
    CHECK(refusal("G1 X0", "a.GCODE").find("is G-code") != std::string::npos);
    CHECK(refusal("\x1F\x8B", "a.spz").find("is 3D Gaussians as SPZ") != std::string::npos);
    CHECK(refusal("\x1F\x8B", "a").find("is a gzip file") != std::string::npos);
    CHECK(refusal("ISO-10303-21;FILE_SCHEMA(('IFC4'))", "a").find("is IFC") != std::string::npos);
    CHECK(refusal("cube(1);", "a.obj").find("is no model") != std::string::npos);
    CHECK(refusal("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.dxf").empty());
}
