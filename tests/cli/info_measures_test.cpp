// Measures that halflit info prints.
#include "tests/cli/program.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <string>
#include <vector>

using namespace halflit::test;

namespace {

using Json = nlohmann::json;

/// An OFF file of a box of 1 x 2 x 3 units with its lowest corner at `low`, without the last `left_out` of its six faces.
std::string box_file(const std::vector<double>& low, std::size_t left_out = 0) {
    const std::vector<std::string> faces = {"0 2 3 1", "4 5 7 6", "0 1 5 4", "2 6 7 3", "0 4 6 2", "1 3 7 5"};
    std::string text = "OFF\n8 " + std::to_string(faces.size() - left_out) + " 0\n";
    for (int i = 0; i < 8; ++i)
        text += std::to_string(low[0] + (i & 1)) + " " + std::to_string(low[1] + (i >> 1 & 1) * 2) + " " +
                std::to_string(low[2] + (i >> 2) * 3) + "\n";
    for (std::size_t i = 0; i < faces.size() - left_out; ++i) text += "4 " + faces[i] + "\n";
    return text;
}

Json measures_of(const std::string& file, const std::vector<std::string>& flags = {}) {
    const TemporaryFolder folder;
    write_contents(folder.file("model"), file);
    std::vector<std::string> arguments{"info", folder.file("model"), "--json"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Outcome outcome = run(arguments);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return Json::parse(outcome.out)["measures"];
}

}  // namespace

TEST_CASE("info: measures are in the file's axes and unit, where it is moved and turned too", "[cli][measures]") {
    // The far box is drawn at the origin.
    for (const std::vector<double>& low : {std::vector<double>{0, 0, 0}, {4000000.25, 5000000, 120}})
        for (const char* up : {"x", "y", "z", "-x", "-y", "-z"}) {
            INFO(low[0] << " " << up);
            const Json m = measures_of(box_file(low), {"--up", up});
            CHECK(m["unit"].is_null());
            CHECK(m["min"] == Json(low));
            CHECK(m["max"] == Json(std::vector<double>{low[0] + 1, low[1] + 2, low[2] + 3}));
            CHECK(m["size"] == Json(std::vector<double>{1, 2, 3}));
            CHECK(m["center"] == Json(std::vector<double>{low[0] + 0.5, low[1] + 1, low[2] + 1.5}));
            CHECK(m["area"] == 22.0);
            CHECK(m["volume"] == 6.0);
            CHECK(m["watertight"] == true);
            CHECK(m["bodies"] == 1);
        }
}

TEST_CASE("info: a tiny box keeps its measures", "[cli][measures]") {
    std::string file = "OFF\n8 6 0\n";
    for (int i = 0; i < 8; ++i) file += std::string(i & 1 ? "1e-12" : "0") + (i & 2 ? " 2e-12" : " 0") + (i & 4 ? " 3e-12\n" : " 0\n");
    file += "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
    const Json m = measures_of(file);
    CHECK(m["size"] == Json(std::vector<double>{1e-12, 2e-12, 3e-12}));
    CHECK(m["area"] == 22e-24);
    CHECK(m["volume"] == 6e-36);
}

TEST_CASE("info: a box without a face has no volume and four open edges", "[cli][measures]") {
    const Json m = measures_of(box_file({0, 0, 0}, 1));
    CHECK(m["volume"].is_null());
    CHECK(m["watertight"] == false);
    CHECK(m["open_edges"] == 4);
    CHECK(m["area"] == 16.0);
    const TemporaryFolder folder;
    write_contents(folder.file("open.off"), box_file({0, 0, 0}, 1));
    const std::string text = run({"info", folder.file("open.off")}).out;
    CHECK(text.find("measures:\n  unit: null\n  min: 0.0, 0.0, 0.0\n  max: 1.0, 2.0, 3.0\n") != std::string::npos);
    CHECK(text.find("  open_edges: 4\n") != std::string::npos);
}

TEST_CASE("info: glTF is in metres, and a scene without triangles has no measures", "[cli][measures]") {
    // The triangle (0, 0), (1, 0), (0, 2) in the plane z = 0.
    const Json m = measures_of(R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[2,2,2]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,2,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAA"}]})");
    CHECK(m["unit"] == "m");
    CHECK(m["area"] == 4.0);
    CHECK(m["open_edges"] == 3);
    CHECK(m["center"] == Json(std::vector<double>{0.666667, 1.333333, 0}));
    CHECK(measures_of(R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})").is_null());
}
