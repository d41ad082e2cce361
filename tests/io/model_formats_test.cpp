// STL, PLY, OBJ and 3MF: the same object in each format gives the same picture, and what all formats have in common.
#include "tests/io/model_maker.hpp"
#include "tests/io/png_maker.hpp"

#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"

#include "sh/trig.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <map>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

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
    REQUIRE(render(loaded.scene, setup.light, setup.camera, setup.settings, {kSize, kSize, rgba.data()}));
    return rgba;
}

int most_different(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    int most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
    return most;
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
        files.emplace_back("3MF in millimetres", of_unit("millimeter", 1.0f));
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
    CHECK(refusal_of(to_bytes("hello, world\n")).find("is no model: expected glTF, GLB, STL, PLY, OBJ, 3MF") != std::string::npos);
    std::string picture = "\x89PNG\r\n";
    for (int i = 0; i < 400; ++i) picture += static_cast<char>(i * 37 % 251);
    CHECK(refusal_of(to_bytes(picture)).find("it holds no shape") != std::string::npos);
    CHECK(refusal_of({}).find("the file is empty") != std::string::npos);
}

TEST_CASE("models: an animation that no such file has is refused, and none is not", "[io]") {
    const Bytes file = stl_binary_of(sphere(4), "a sphere");
    LoadOptions options;
    options.animation = "none";
    CHECK(load_any(file, options));
    options.animation = "walk";
    CHECK(refusal_of(file, ErrorCode::usage, options).find("animation") != std::string::npos);
    options.animation = "", options.time_s = std::numeric_limits<double>::infinity();
    CHECK(refusal_of(file, ErrorCode::usage, options).find("time_s") != std::string::npos);
}

TEST_CASE("models: z of STL files points up, unless the host says another axis", "[io]") {
    LoadOptions as_stored;
    as_stored.up = UpAxis::y;
    const Bytes file = stl_binary_of(letter(), "");
    const LoadedScene upright_scene = load_any_ok(file);
    const Bounds upright = scene_bounds(upright_scene.scene), stored = scene_bounds(load_any_ok(file, as_stored).scene);
    CHECK(upright_scene.placement.up == UpAxis::z);
    CHECK(upright_scene.placement.into({3, 0, 4}) == Vec3d{3, 4, 0});
    CHECK(upright_scene.placement.out({3, 4, 0}) == Vec3d{3, 0, 4});
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

TEST_CASE("models: all edges of a prism whose sides meet at the crease angle are smooth", "[io]") {
    for (const unsigned sides : {6u, 8u, 12u, 15u}) {
        for (const float size : {0.01f, 1.0f, 77.7f}) {
            Polyhedron prism;
            for (unsigned i = 0; i < sides; ++i) {
                const SinCos at = sin_cos((2.0 * kPi * i) / sides);
                for (const float y : {0.0f, 1.0f})
                    prism.points.push_back({static_cast<float>(size * at.cos), y * size, static_cast<float>(size * at.sin)});
            }
            for (unsigned i = 0; i < sides; ++i) {
                const unsigned a = 2 * i, b = 2 * ((i + 1) % sides);
                prism.triangles.push_back({a, a + 1, b + 1});
                prism.triangles.push_back({a, b + 1, b});
            }
            LoadOptions options;
            options.crease_deg = 360.0f / static_cast<float>(sides);
            CHECK(load_any_ok(stl_binary_of(prism, ""), options).scene.meshes.at(0).positions.size() == prism.points.size());
            options.crease_deg -= 1;
            CHECK(load_any_ok(stl_binary_of(prism, ""), options).scene.meshes.at(0).positions.size() == 2 * prism.points.size());
        }
    }
}

TEST_CASE("models: noise of a scan is smooth beyond the crease angle, and dense patterns keep their edges", "[io]") {
    const auto vertices_a_place = [](const Polyhedron& p, float crease_deg) {
        LoadOptions options;
        options.crease_deg = crease_deg;
        const Mesh mesh = load_any_ok(stl_binary_of(p, ""), options).scene.meshes.at(0);
        std::map<std::array<float, 3>, int> places;
        for (const Vec3f& at : mesh.positions) ++places[{at.x, at.y, at.z}];
        return static_cast<double>(mesh.positions.size()) / static_cast<double>(places.size());
    };
    const auto noisy = [](unsigned rings) {
        Polyhedron p = sphere(rings);
        std::uint32_t state = 1;
        for (std::size_t i = 2 * rings; i + 2 * rings < p.points.size(); ++i) {  // but the poles, whose points are one place
            state = state * 1664525u + 1013904223u;
            p.points[i] = p.points[i] * static_cast<float>(1 + 0.6 / rings * (state / 4294967296.0 - 0.5));
        }
        return p;
    };
    // Its edges bend by up to some 50 degrees, half of them by less than 15.
    CHECK(vertices_a_place(noisy(60), 30) < 1.1);   // 14,160 triangles
    CHECK(vertices_a_place(noisy(40), 30) > 1.15);  // 6,240: might be made by design
    // Pyramids, whose edges are all sharp.
    const auto knurl = [](unsigned columns, unsigned rows) {
        Polyhedron p;
        for (unsigned y = 0; y <= rows; ++y)
            for (unsigned x = 0; x <= columns; ++x) p.points.push_back({static_cast<float>(x), static_cast<float>(y), 0});
        for (unsigned y = 0; y < rows; ++y)
            for (unsigned x = 0; x < columns; ++x) {
                const auto top = static_cast<unsigned>(p.points.size());
                p.points.push_back({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0.35f});
                const unsigned a = y * (columns + 1) + x, b = a + 1, c = b + columns + 1, d = a + columns + 1;
                for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, d}, std::pair{d, a}})
                    p.triangles.push_back({from, to, top});
            }
        return p;
    };
    CHECK(vertices_a_place(knurl(60, 50), 30) == Approx(vertices_a_place(knurl(40, 30), 30)).epsilon(0.02));
    CHECK(vertices_a_place(knurl(60, 50), 30) > 5);
}

TEST_CASE("models: the faces of a twisted vase are smooth and its ridges sharp, however its strips bend", "[io]") {
    constexpr unsigned kSides = 12, kLayers = 60;
    for (const double twist_deg : {1.0, 2.0, 3.0}) {  // of a layer
        Polyhedron vase;
        for (unsigned layer = 0; layer <= kLayers; ++layer)
            for (unsigned side = 0; side < kSides; ++side) {
                const SinCos at = sin_cos((2.0 * kPi * side) / kSides + twist_deg * layer * (kPi / 180.0));
                vase.points.push_back({static_cast<float>(10 * at.cos), static_cast<float>(10 * at.sin), 0.5f * static_cast<float>(layer)});
            }
        for (unsigned layer = 0; layer < kLayers; ++layer)
            for (unsigned side = 0; side < kSides; ++side) {
                const unsigned a = layer * kSides + side, b = layer * kSides + (side + 1) % kSides;
                vase.triangles.push_back({a, b, b + kSides});
                vase.triangles.push_back({a, b + kSides, a + kSides});
            }
        const Vec3f* const p = vase.points.data();
        const auto normal = [&](unsigned a, unsigned b, unsigned c) { return normalize_or(cross(p[b] - p[a], p[c] - p[a]), {0, 0, 1}); };
        const float within = dot(normal(0, 1, 1 + kSides), normal(0, 1 + kSides, kSides));
        LoadOptions options;
        options.crease_deg = 20;  // below the ridges' 30 degrees
        const Mesh mesh = load_any_ok(stl_binary_of(vase, ""), options).scene.meshes.at(0);
        INFO("twist " << twist_deg << ", cosine of the bend within a face " << within);
        CHECK((within < 0.94f) == (twist_deg > 1));  // 20 degrees
        CHECK(mesh.positions.size() == 2 * vase.points.size());
        options.crease_deg = 15;
        const bool too_sharp = within < 0.866f;  // 30 degrees
        CHECK((load_any_ok(stl_binary_of(vase, ""), options).scene.meshes.at(0).positions.size() > 3 * vase.points.size()) == too_sharp);
    }
}

TEST_CASE("models: the pleats of a fan are sharp", "[io]") {
    constexpr unsigned kPleats = 60;
    Polyhedron fan;
    fan.points.push_back({0, 0, 0});
    for (unsigned i = 0; i < 2 * kPleats; ++i) {
        const SinCos at = sin_cos(kPi * i / kPleats);
        fan.points.push_back({static_cast<float>(10 * at.cos), static_cast<float>(10 * at.sin), i % 2 == 0 ? 0.1f : -0.1f});
    }
    for (unsigned i = 0; i < 2 * kPleats; ++i) fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % (2 * kPleats)});
    const Mesh mesh = load_any_ok(stl_binary_of(fan, "")).scene.meshes.at(0);
    CHECK(mesh.positions.size() == 3 * fan.triangles.size());
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

TEST_CASE("models: numbers do not depend on the locale, and wrong ones are refused with their line", "[io]") {
    const Mesh mesh = load_any_ok(to_bytes("v +1.5e0 .25 -2.\nv 1e-60 1 0\nv 0 3 0\nf 1 2 3\n")).scene.meshes.at(0);
    CHECK(mesh.positions.at(0) == Vec3f{1.5f, 0.25f, -2.0f});
    CHECK(mesh.positions.at(1) == Vec3f{0, 1, 0});
    CHECK(refusal_of(to_bytes("v 0 0 0\nv 1,5 0 0\n")).find("line 2: expected a number, found \"1,5\"") != std::string::npos);
}

TEST_CASE("models: indices out of range are refused by the strict rules, or their faces left out", "[io]") {
    const Bytes obj = to_bytes("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n");
    CHECK(refusal_of(obj).find("line 5: the index 4 is out of range") != std::string::npos);
    Bytes ply = ply_of(letter(), PlyKind::text);
    std::string text(reinterpret_cast<const char*>(ply.data()), ply.size());
    ply = to_bytes(replaced(text, "6 6 7 8", "6 6 77 8"));
    CHECK(refusal_of(ply).find("a face has the vertex 77, but there are 12") != std::string::npos);
    const LoadOptions tolerant;
    CHECK(load_any_ok(obj, tolerant).info.triangles_drawn == 1);
    CHECK(load_any_ok(ply, tolerant).info.triangles_drawn == letter().triangles.size() - 4);
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
        CHECK(refusal_of(file, ErrorCode::limit, small).find("the geometry") != std::string::npos);
        LoadOptions shorter;
        shorter.limits.max_file_bytes = 100;
        CHECK(refusal_of(file, ErrorCode::limit, shorter).find("bytes, the limit is 100") != std::string::npos);
    }
}

namespace {

/// Waves, flat steps and sharp ridges over a square of side x side cells.
Polyhedron waves_of(unsigned side) {
    Polyhedron waves;
    for (unsigned y = 0; y <= side; ++y)
        for (unsigned x = 0; x <= side; ++x) {
            const float height = (x / 16 % 2 == 0 ? 1.0f : 0.0f) + 0.01f * static_cast<float>(x * y % 37);
            waves.points.push_back({static_cast<float>(x), static_cast<float>(y), height});
        }
    for (unsigned y = 0; y < side; ++y)
        for (unsigned x = 0; x < side; ++x) {
            const unsigned at = y * (side + 1) + x, below = at + side + 1;
            waves.triangles.push_back({at, at + 1, below});
            waves.triangles.push_back({at + 1, below + 1, below});
        }
    return waves;
}

Mesh mesh_of(const Polyhedron& body, int threads = 1) {
    LoadOptions options = strictly();
    options.threads = threads;
    auto loaded = load_model_bytes(stl_binary_of(body, "body"), "body.stl", "", options);
    REQUIRE(loaded);
    REQUIRE(loaded->scene.meshes.size() == 1);
    return std::move(loaded->scene.meshes[0]);
}

}  // namespace

TEST_CASE("formats: the normals of a large model are the same from one thread and from several", "[io][model]") {
    const Polyhedron waves = waves_of(380);  // more places than two threads need
    const Mesh one = mesh_of(waves);
    CHECK(one.positions.size() > waves.points.size());  // the ridges are sharp
    for (const int threads : {2, 3}) {
        const Mesh several = mesh_of(waves, threads);
        CHECK(several.positions == one.positions);
        CHECK(several.normals == one.normals);
        CHECK(several.indices == one.indices);
    }
}

TEST_CASE("formats: copies of triangles, and their backs, leave a surface as smooth as it is", "[io][model]") {
    const Polyhedron waves = waves_of(40);
    const Mesh single = mesh_of(waves);
    for (const int copies : {2, 3, 5}) {
        Polyhedron copied = waves;
        for (int i = 1; i < copies; ++i)
            for (const auto& [a, b, c] : waves.triangles) copied.triangles.push_back({b, c, a});
        const Mesh mesh = mesh_of(copied);
        CHECK(mesh.positions == single.positions);
        CHECK(mesh.normals == single.normals);
    }
    Polyhedron both = waves;
    for (const auto& [a, b, c] : waves.triangles) both.triangles.push_back({a, c, b});
    both.triangles.insert(both.triangles.end(), waves.triangles.begin(), waves.triangles.end());
    const Mesh mesh = mesh_of(both);
    REQUIRE(mesh.positions.size() == 2 * single.positions.size());
    std::map<std::array<float, 6>, int> sides;
    const auto key = [](Vec3f p, Vec3f n) { return std::array{p.x, p.y, p.z, n.x + 0.0f, n.y + 0.0f, n.z + 0.0f}; };
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) ++sides[key(mesh.positions[i], mesh.normals[i])];
    for (std::size_t i = 0; i < single.positions.size(); ++i) {
        const Vec3f n = single.normals[i];
        CHECK(sides[key(single.positions[i], n)] == 1);
        CHECK(sides[key(single.positions[i], {-n.x, -n.y, -n.z})] == 1);
    }
}
