// Models far from the origin, as surveys in UTM coordinates have them: each format draws what it draws at the origin.
#include "tests/io/model_maker.hpp"

#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

using namespace halflit;
using namespace halflit::test;

namespace {

constexpr Vec3d kFar{4e6, 5e6, 1e5};

/// Draws README's example in a small picture.
std::vector<std::uint8_t> draw(const LoadedScene& loaded) {
    PictureRequest request;
    request.size = {96, 72};
    const auto picture = choose_picture(loaded.scene, request);
    REQUIRE(picture);
    Image image = Image::make(picture->size);
    REQUIRE(render(loaded.scene, picture->light, picture->camera, picture->settings, image.target()));
    return std::move(image.rgba8);
}

/// Shares of the pixels that differ by more than two codes.
double share_apart(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    std::size_t apart = 0;
    for (std::size_t i = 0; i < a.size(); i += 4)
        for (std::size_t c = 0; c < 4; ++c)
            if (std::abs(int{a[i + c]} - int{b[i + c]}) > 2) {
                ++apart;
                break;
            }
    return static_cast<double>(apart) / (static_cast<double>(a.size()) / 4);
}

std::string point_text(Vec3f p, Vec3d origin) {
    char text[100];
    std::snprintf(text, sizeof text, "%.4f %.4f %.4f", p.x + origin.x, p.y + origin.y, p.z + origin.z);
    return text;
}

std::string obj_at(const Polyhedron& p, Vec3d origin) {
    std::string text;
    for (const Vec3f& v : p.points) text += "v " + point_text(v, origin) + "\n";
    for (const auto& polygon : p.polygons) {
        text += "f";
        for (const unsigned i : polygon) text += " " + std::to_string(i + 1);
        text += "\n";
    }
    return text;
}

std::string stl_at(const Polyhedron& p, Vec3d origin) {
    std::string text = "solid far\n";
    for (const auto& triangle : p.triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const unsigned i : triangle) text += "vertex " + point_text(z_up(p.points[i]), origin) + "\n";
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid\n";
}

Bytes ply_at(const Polyhedron& p, Vec3d origin, bool binary) {
    std::string header = std::string("ply\nformat ") + (binary ? "binary_little_endian" : "ascii") + " 1.0\nelement vertex " +
                         std::to_string(p.points.size());
    for (const char* const axis : {"x", "y", "z"}) header += std::string("\nproperty ") + (binary ? "double " : "float ") + axis;
    header += "\nelement face " + std::to_string(p.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    Bytes file = to_bytes(header);
    for (const Vec3f& v : p.points) {
        if (binary)
            append<double>(file, {v.x + origin.x, v.y + origin.y, v.z + origin.z});
        else
            append_bytes(file, point_text(v, origin) + "\n");
    }
    for (const auto& [a, b, c] : p.triangles) {
        if (binary) {
            append<std::uint8_t>(file, {3});
            append<std::uint32_t>(file, {a, b, c});
        } else {
            append_bytes(file, "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n");
        }
    }
    return file;
}

Bytes three_mf_at(const Polyhedron& p, Vec3d origin) {
    std::string mesh = "<mesh><vertices>";
    for (const Vec3f& point : p.points) {
        const Vec3f v = z_up(point);
        char text[140];
        std::snprintf(text, sizeof text, "<vertex x=\"%.4f\" y=\"%.4f\" z=\"%.4f\"/>", v.x + origin.x, v.y + origin.y, v.z + origin.z);
        mesh += text;
    }
    mesh += "</vertices><triangles>";
    for (const auto& [a, b, c] : p.triangles)
        mesh += "<triangle v1=\"" + std::to_string(a) + "\" v2=\"" + std::to_string(b) + "\" v3=\"" + std::to_string(c) + "\"/>";
    return three_mf(three_mf_text("meter", "<object id=\"1\">" + mesh + "</triangles></mesh></object>", "<item objectid=\"1\"/>"));
}

Bytes gltf_at(Vec3d origin) {
    Bytes bin;
    for (const Vec3f& v : letter().points) append<float>(bin, {v.x, v.y, v.z});
    const std::size_t points = bin.size();
    for (const auto& [a, b, c] : letter().triangles) append<std::uint32_t>(bin, {a, b, c});
    char text[900];
    std::snprintf(
        text, sizeof text,
        R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0,"translation":[%.1f,%.1f,%.1f]}],"meshes":[{"primitives":[{"attributes":)"
        R"({"POSITION":0},"indices":1}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":12,"type":"VEC3","min":[0,0,0],)"
        R"("max":[3,4,1.5]},{"bufferView":1,"componentType":5125,"count":%zu,"type":"SCALAR"}],"bufferViews":[{"buffer":0,)"
        R"("byteLength":%zu},{"buffer":0,"byteOffset":%zu,"byteLength":%zu}],"buffers":[{"byteLength":%zu}]})",
        origin.x, origin.y, origin.z, (bin.size() - points) / 4, points, points, bin.size() - points, bin.size());
    return glb(text, bin);
}

}  // namespace

TEST_CASE("surveys: models far from the origin are drawn as at the origin", "[io]") {
    struct Case {
        const char* name;
        Bytes near, far;
    };
    const Polyhedron p = letter();
    std::vector<Case> cases{{"glTF", gltf_at({}), gltf_at(kFar)},
                            {"OBJ", to_bytes(obj_at(p, {})), to_bytes(obj_at(p, kFar))},
                            {"STL text", to_bytes(stl_at(p, {})), to_bytes(stl_at(p, kFar))},
                            {"PLY text", ply_at(p, {}, false), ply_at(p, kFar, false)},
                            {"PLY binary", ply_at(p, {}, true), ply_at(p, kFar, true)}};
    if (has_three_mf()) cases.push_back({"3MF", three_mf_at(p, {}), three_mf_at(p, kFar)});
    for (const Case& c : cases) {
        INFO(c.name);
        const LoadedScene near = load_any_ok(c.near), far = load_any_ok(c.far);
        CHECK(near.placement.origin == Vec3d{});
        const auto at_origin = draw(near), away = draw(far);
        CHECK(share_apart(at_origin, std::vector<std::uint8_t>(at_origin.size())) > 0.5);
        // Edges that pass by a sample, and another place in the lattice of sky and contact shadows: 0.010.
        CHECK(share_apart(at_origin, away) < 0.015);
        // Points of the file are where the placement says.
        const Vec3d corner = far.placement.into(kFar);
        const Bounds bounds = scene_bounds(far.scene);
        const Vec3d low{bounds.min.x, bounds.min.y, bounds.min.z};
        CHECK(length(corner - low) < (far.placement.up == UpAxis::z ? 4.5 : 2e-3));
        const Vec3d back = far.placement.out(corner);
        CHECK(length(back - kFar) < 1e-6);
        REQUIRE(far.warnings.size() == 1);
        CHECK(far.warnings[0].find("it is drawn at the origin") != std::string::npos);
        // Posed by its nodes as they are, nothing moves.
        Scene posed = far.scene;
        const auto changes = pose(far.nodes, posed, far.placement);
        REQUIRE(changes);
        CHECK(changes->changed_instances.empty());
    }
}

TEST_CASE("surveys: what float32 positions are moved by is a float32 number", "[io]") {
    // The middle, 1e6 + .53125, is half-way between two of them.
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "1000000 0 0\n1000001.0625 0 0\n1000000 1 0\n3 0 1 2\n";
    const LoadedScene loaded = load_any_ok(to_bytes(text));
    const Instance& instance = loaded.scene.instances[0];
    const Vec3f first = loaded.scene.meshes[0].positions[0];
    const double drawn_at = double{first.x} + double{instance.world_from_object.c[3].x};
    CHECK(loaded.placement.origin.x > 9e5);
    CHECK(drawn_at == 1e6 - loaded.placement.origin.x);
}

TEST_CASE("surveys: without recentring the file's own numbers are kept, rounded", "[io]") {
    LoadOptions as_stored;
    as_stored.recentre = false;
    const LoadedScene loaded = load_any_ok(to_bytes(obj_at(letter(), kFar)), as_stored);
    CHECK(loaded.placement == Placement{});
    CHECK(loaded.scene.meshes[0].positions[0].x >= 4e6f);
    CHECK(loaded.warnings.empty());
}

TEST_CASE("surveys: points and lines far away keep their shape, and a stray vertex that nothing uses does not count", "[io]") {
    const auto size_of = [](const LoadedScene& loaded) {
        const Bounds bounds = scene_bounds(loaded.scene);
        return Vec3d{bounds.max.x, bounds.max.y, bounds.max.z} - Vec3d{bounds.min.x, bounds.min.y, bounds.min.z};
    };
    const LoadedScene lines =
        load_any_ok(to_bytes("v 4000000.25 5000000 100\nv 4000000.5 5000000 100\nv 4000000.5 5000000.125 100\n"
                             "v 0 0 0\nl 1 2 3\n"));
    CHECK(length(size_of(lines) - Vec3d{0.25, 0.125, 0}) < 1e-6);
    const LoadedScene cloud =
        load_any_ok(to_bytes("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                             "property float z\nend_header\n4000000.25 5000000 7\n4000000.5 5000000.125 7\n"));
    CHECK(length(size_of(cloud) - Vec3d{0.25, 0, 0.125}) < 1e-6);  // as on a map: z is up
    const LoadedScene stray =
        load_any_ok(to_bytes("v 0 0 0\nv 4000000.25 5000000 100\nv 4000000.5 5000000 100\n"
                             "v 4000000.5 5000000.125 100\nf 2 3 4\n"));
    CHECK(length(size_of(stray) - Vec3d{0.25, 0.125, 0}) < 1e-6);
}

TEST_CASE("surveys: coordinates beyond float32 are left out, and do not keep others from being placed", "[io]") {
    const std::string good = "4000000.25 5000000 7\n4000000.5 5000000.125 7\n4000000.25 5000000.125 7\n", beyond = "1e200 0 0\n";
    std::string obj;
    for (std::size_t begin = 0; begin < good.size(); begin = good.find('\n', begin) + 1)
        obj += "v " + good.substr(begin, good.find('\n', begin) + 1 - begin);
    obj += "v " + beyond;
    const std::string files[] = {
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
        "end_header\n" +
            good + beyond,
        obj + "f 1 2 3\nf 1 2 4\n", obj + "l 1 2 3\nl 1 4\n"};
    for (const std::string& file : files) {
        INFO(file);
        const LoadedScene loaded = load_any_ok(to_bytes(file));
        const Bounds bounds = scene_bounds(loaded.scene);
        CHECK(bounds.max.x - bounds.min.x == 0.25f);
        CHECK(loaded.placement.origin.x > 4e6);
        CHECK(std::any_of(loaded.warnings.begin(), loaded.warnings.end(),
                          [](const std::string& w) { return w.find("not finite are left out") != w.npos; }));
    }
}
