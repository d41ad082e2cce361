// halflit explain: the story of a pixel, as text and as JSON.
#include "tests/cli/program.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <cstdio>

using namespace halflit::test;
using nlohmann::json;

namespace {

/// One triangle that fills the lower left half of the view, with names that must be escaped on a terminal.
constexpr const char* kTriangle = R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "scene": 0,
    "nodes": [{"name": "lid\u001b[2J", "mesh": 0}],
    "meshes": [{"name": "sheet", "primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "materials": [{"name": "tin", "doubleSided": true, "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.75}}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36,
    "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";

}  // namespace

TEST_CASE("explain: the text has the codes of the picture, and names of mesh, node and material", "[cli][explain]") {
    const TemporaryFolder folder;
    const std::string scene = folder.file("sheet.gltf"), picture = folder.file("a.png");
    write_contents(scene, kTriangle);
    const std::vector<std::string> view{"--size", "64", "--azimuth", "0", "--elevation", "0"};
    const auto with = [&](std::vector<std::string> words) {
        words.insert(words.end(), view.begin(), view.end());
        return run(words);
    };
    REQUIRE(with({"render", scene, "-o", picture}).code == 0);
    const auto color = [drawn = read_picture(contents(picture))](int x, int y) {
        const std::vector<int> codes = drawn.pixel(x, y);
        char text[24];
        std::snprintf(text, sizeof text, "#%02x%02x%02x, alpha %d", codes[0] & 255, codes[1] & 255, codes[2] & 255, codes[3] & 255);
        return std::string(text);
    };
    const Outcome outcome = with({"explain", scene, "--pixel", "20,40", "--pixel", "63,0"});
    INFO(outcome.err << outcome.out);
    REQUIRE(outcome.code == 0);
    CHECK(outcome.out.starts_with("pixel 20,40 of 64x64: " + color(20, 40) + "\n"));
    CHECK(contains(outcome.out, "surface: triangle 0 of mesh 0 \"sheet\"\n  instance 0 \"lid\\x1b[2J\"\n"));
    CHECK(contains(outcome.out, "material: 0 \"tin\"\n"));
    CHECK(contains(outcome.out, "  roughness: 0.75\n"));
    CHECK(contains(outcome.out, "\npixel 63,0 of 64x64: " + color(63, 0) + "\nno surface: background, a colour\n"));
}

TEST_CASE("explain: a pixel in the contact shadow says its opacity", "[cli][explain]") {
    const std::vector<std::string> head{"explain", "sphere:500", "--size", "64x64", "--elevation", "60", "--pixel", "32,60"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), head.begin(), head.end());
        return run(more).out;
    };
    CHECK(contains(with({}), "no surface: background, a colour, in a contact shadow of "));
    CHECK_FALSE(contains(with({"--contact-shadow", "0"}), "contact shadow"));
    CHECK(json::parse(with({"--json"}))["pixels"][0]["contact_shadow"] > 0.0);
}

TEST_CASE("explain: JSON has a pixel for each flag, whose parts add up", "[cli][explain]") {
    const Outcome outcome = run({"explain", "demo", "--size", "64x36", "--pixel", "32,20", "--pixel", "3,3", "--json"});
    REQUIRE(outcome.code == 0);
    const json report = json::parse(outcome.out);
    CHECK(report["schema"] == "halflit.explain/1");
    CHECK(report["size"] == json({64, 36}));
    REQUIRE(report["pixels"].size() == 2);
    CHECK(report["pixels"][1]["at"] == json({3, 3}));
    for (const json& pixel : report["pixels"])
        for (std::size_t c = 0; c < 3; ++c) {
            double sum = pixel["around"][c].get<double>() + pixel["emitted"][c].get<double>() + pixel["background"][c].get<double>();
            for (const json& light : pixel["lights"]) sum += light["linear"][c].get<double>();
            CHECK(sum == Approx(pixel["linear"][c].get<double>() * pixel["alpha"].get<double>()).epsilon(1e-5).margin(1e-6));
        }
}

TEST_CASE("explain: pixels that are missing, faulty or outside of the picture are usage errors", "[cli][explain]") {
    CHECK(contains(run({"explain", "demo"}).err, "expected --pixel X,Y"));
    for (const std::string pixel : {"1", "1,2,3", "-1,0", "a,b", "1.5,2"}) {
        const Outcome outcome = run({"explain", "demo", "--size", "64x36", "--pixel", pixel});
        INFO(pixel);
        CHECK(outcome.code == 2);
        CHECK(outcome.out.empty());
        CHECK(contains(outcome.err, "--pixel: expected a pixel X,Y"));
    }
    for (const std::string pixel : {"64,0", "0,36", "2147483647,0"}) {
        const Outcome outcome = run({"explain", "demo", "--size", "64x36", "--pixel", "1,1", "--pixel", pixel});
        INFO(pixel);
        CHECK(outcome.code == 2);
        CHECK(outcome.out.empty());
        CHECK(contains(outcome.err, "--pixel: expected a pixel of the 64x36 picture, found " + pixel));
    }
}

TEST_CASE("explain: a dash after --json is standard output, unless it is the only scene", "[cli][explain]") {
    const std::vector<std::string> head{"explain", "--size", "16", "--pixel", "8,8"};
    const auto with = [&](std::vector<std::string> words, const RunSettings& settings = {}) {
        words.insert(words.begin(), head.begin(), head.end());
        return run(words, settings);
    };
    const Outcome plain = with({"sphere:100", "--json"});
    REQUIRE(plain.code == 0);
    CHECK(with({"sphere:100", "--json", "-"}).out == plain.out);
    CHECK(with({"--json", "-", "sphere:100"}).out == plain.out);
    CHECK(with({"--json", "-", "--pixel=0,0", "sphere:100"}).code == 0);
    CHECK(with({"sphere:100", "-"}).code == 2);
    CHECK(with({"sphere:100", "-", "--json"}).code == 2);
    const Outcome piped = with({"--json", "-"}, {.input = kTriangle});
    INFO(piped.err);
    REQUIRE(piped.code == 0);
    CHECK(json::parse(piped.out)["scene"] == "standard input");
    CHECK(run({"info", "sphere:100", "--json", "-"}).out == run({"info", "sphere:100", "--json"}).out);
}
