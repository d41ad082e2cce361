// STEP, IGES and BREP models by halflit-import-cad: what is in them, how fine their triangles are, and what is refused.
#include "halflit/model.hpp"

#include "tests/cli/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

using namespace halflit;
using namespace halflit::test;
using Json = nlohmann::json;

namespace {

const std::string kModels = HALFLIT_SOURCE_DIR "/tests/cli/cad/";
// A red ball of radius 10 at (0, 0, 40), a post of radius 5 and height 30 with a blue top, and the same one lying, in one assembly.
const std::string kMachine = kModels + "machine.step";

bool has_importer() { return std::filesystem::exists(std::filesystem::path(HALFLIT_PROGRAM).parent_path() / "halflit-import-cad"); }

LoadedScene load_cad(const std::string& path, double detail_px = 2048) {
    LoadOptions options;
    options.detail_px = detail_px;
    options.recentre = false;
    auto loaded = load_model(path, options);
    if (!loaded) FAIL(loaded.error().message);
    return *std::move(loaded);
}

Json info_of(const std::vector<std::string>& more) {
    std::vector<std::string> words{"info", kMachine, "--json", "-"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome ran = run(words);
    REQUIRE(ran.code == 0);
    return Json::parse(ran.out);
}

/// Largest distances of a ball's triangles, at their corners and middles, from its surface, and of its normals from the radii.
struct BallError {
    double corner = 0, middle = 0, normal = 0;
};
BallError error_of_ball(const Mesh& mesh, double radius) {
    BallError error;
    const auto apart = [&](Vec3d p) { return std::abs(length(p) - radius); };
    const auto at = [&](std::size_t i) { return Vec3d{mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z}; };
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        error.corner = std::max(error.corner, apart(at(i)));
        const Vec3d n{mesh.normals[i].x, mesh.normals[i].y, mesh.normals[i].z};
        error.normal = std::max(error.normal, length(n - at(i) * (1.0 / radius)));
    }
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Vec3d a = at(mesh.indices[i]), b = at(mesh.indices[i + 1]), c = at(mesh.indices[i + 2]);
        for (const Vec3d& middle : {(a + b + c) * (1.0 / 3.0), (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5})
            error.middle = std::max(error.middle, apart(middle));
    }
    return error;
}

}  // namespace

TEST_CASE("cad: names, colours, assemblies and places of a STEP file are the scene's", "[cli][cad]") {
    if (!has_importer()) HALFLIT_SKIP("halflit-import-cad was not built");
    const LoadedScene loaded = load_cad(kMachine);
    CHECK(loaded.warnings.empty());
    CHECK(loaded.info.format == "STEP");
    CHECK(loaded.info.unit_m == 1e-3);
    CHECK(loaded.placement.up == UpAxis::z);
    std::vector<std::string> names;
    for (const Node& node : loaded.nodes) names.push_back(node.name);
    // The second post has no name in its assembly, so it has that of its part.
    CHECK(names == std::vector<std::string>{"machine", "head", "post", "lying post"});
    CHECK(loaded.scene.meshes.size() == 3);     // ball, side and foot of the post, its top
    CHECK(loaded.scene.instances.size() == 5);  // both posts are instances of one
    const auto albedo = [&](std::size_t instance) {
        const Mesh& mesh = loaded.scene.meshes[static_cast<std::size_t>(loaded.scene.instances[instance].mesh)];
        return mesh.material < 0 ? Vec4f{} : loaded.scene.materials[static_cast<std::size_t>(mesh.material)].base_color;
    };
    // sRGB .8, .2, .2 and .2, .4, .8
    CHECK(std::abs(albedo(0).x - 0.6038f) < 2e-4f);
    CHECK(std::abs(albedo(0).y - 0.0331f) < 2e-4f);
    int blue = 0;
    for (std::size_t i = 0; i < loaded.scene.instances.size(); ++i) blue += std::abs(albedo(i).z - 0.6038f) < 2e-4f ? 1 : 0;
    CHECK(blue == 2);

    const Json measures = info_of({})["measures"];
    CHECK(measures["unit"] == "mm");
    CHECK(measures["bodies"] == 3);
    CHECK(measures["watertight"] == true);
    const double volume = std::acos(-1.0) * (4000.0 / 3.0 + 2 * 25 * 30);
    CHECK(std::abs(measures["volume"].get<double>() / volume - 1) < 3e-3);
    const double low[] = {-10, -30, 0}, high[] = {35, 10, 50};
    for (std::size_t k = 0; k < 3; ++k) {
        CHECK(std::abs(measures["min"][k].get<double>() - low[k]) < 0.02);
        CHECK(std::abs(measures["max"][k].get<double>() - high[k]) < 0.02);
    }
}

TEST_CASE("cad: triangles are within a quarter of a pixel of the surface, whose own normals they have", "[cli][cad]") {
    if (!has_importer()) HALFLIT_SKIP("halflit-import-cad was not built");
    const double diagonal = 20 * std::sqrt(3.0);
    for (const std::string name : {"ball.brep", "ball.igs"}) {
        for (const double detail : {128.0, 512.0, 2048.0}) {
            INFO(name << " " << detail);
            const LoadedScene ball = load_cad(kModels + name, detail);
            CHECK(ball.info.detail_px == detail);
            REQUIRE(ball.scene.meshes.size() == 1);
            const BallError error = error_of_ball(ball.scene.meshes[0], 10);
            CHECK(error.corner < 1e-4);
            CHECK(error.normal < 1e-4);
            CHECK(error.middle < 1.12 * 0.25 * diagonal / detail);  // the box may be taken for a ninth larger
        }
    }
}

TEST_CASE("cad: edges that no face has are lines", "[cli][cad]") {
    if (!has_importer()) HALFLIT_SKIP("halflit-import-cad was not built");
    const LoadedScene wire = load_cad(kModels + "wire.brep");  // 10 long, and a circle of radius 5
    REQUIRE(wire.scene.meshes.size() == 1);
    const Mesh& mesh = wire.scene.meshes[0];
    CHECK(mesh.topology == Topology::lines);
    double all = 0;
    for (std::size_t i = 0; i + 1 < mesh.indices.size(); i += 2) {
        const Vec3f a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]];
        all += std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
    }
    const double exact = 10 + 10 * std::acos(-1.0);
    CHECK(all < exact + 1e-4);
    CHECK(all > exact - 0.01);
}

TEST_CASE("cad: the fineness follows the view, and a finer one changes no pixel that is not at an outline", "[cli][cad]") {
    if (!has_importer()) HALFLIT_SKIP("halflit-import-cad was not built");
    const auto detail = [](const std::vector<std::string>& flags) { return info_of(flags)["file"]["detail_px"].get<double>(); };
    CHECK(detail({}) == 2048);
    CHECK(detail({"--size", "256x256"}) == 2048);
    CHECK(detail({"--size", "1600x900"}) == 4096);
    CHECK(detail({"--size", "1600x900", "--zoom", "4"}) == 16384);
    CHECK(detail({"--detail", "100"}) == 100);
    CHECK(detail({"--camera-position", "14,0,40", "--camera-target", "0,0,40"}) > 8192);

    const TemporaryFolder folder;
    const auto draw = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{kModels + "ball.brep", "--size", "320x240", "--aov", "coverage", "-o", folder.file("x.png"), "-q"};
        words.insert(words.end(), more.begin(), more.end());
        REQUIRE(run(words).code == 0);
        return std::pair(read_picture(contents(folder.file("x.png"))), read_picture(contents(folder.file("x.coverage.png"))));
    };
    const auto [usual, coverage] = draw({});
    const auto [fine, unused] = draw({"--detail", "8192"});
    const auto is_inside = [&, &all = coverage](int x, int y) {
        for (int dy = -3; dy <= 3; ++dy)  // beside an outline a pixel's surface turns by more than its light's rounding
            for (int dx = -3; dx <= 3; ++dx)
                if (all.pixel(x + dx, y + dy)[0] != 255) return false;
        return true;
    };
    int inside = 0, most = 0;
    for (int y = 3; y < 237; ++y) {
        for (int x = 3; x < 317; ++x) {
            if (!is_inside(x, y)) continue;
            ++inside;
            for (std::size_t k = 0; k < 3; ++k) most = std::max(most, std::abs(usual.pixel(x, y)[k] - fine.pixel(x, y)[k]));
        }
    }
    CHECK(inside > 5000);
    CHECK(most <= 1);
}

TEST_CASE("cad: what cannot be read is refused with a reason", "[cli][cad]") {
    const TemporaryFolder folder;
    const auto refused = [&](const std::string& text, const std::string& name) {
        write_contents(folder.file(name), text);
        const Outcome ran = run({"info", folder.file(name)});
        CHECK(ran.code == 3);
        return ran.err;
    };
    const std::string machine = contents(kMachine);
    if (!has_importer()) {
        CHECK(contains(refused(machine, "x.step"), "is STEP, which is not read; halflit-import-cad, of the package halflit-cad, reads it"));
        return;
    }
    CHECK(contains(refused(machine.substr(0, machine.size() / 2), "x.step"), "halflit-import-cad: cannot be read to its end"));
    CHECK(contains(refused("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n", "x.step"), "halflit-import-cad: "));
    CHECK(contains(refused("\nCASCADE Topology V3, (c) Open Cascade\nLocations 99999999\n", "x.brep"), "halflit-import-cad: "));
    CHECK(contains(refused("ISO-10303-21; IFC4", "x.ifc"), "IfcConvert"));
}
