#include "tests/cli/program.hpp"
#include "tests/io/animated_file.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

using namespace halflit::test;

namespace {

std::string arm_file(const TemporaryFolder& folder) {
    const Bytes file = Arm(1, Keys::linear).file;
    std::string path = folder.file("arm.glb");
    write_contents(path, std::string(reinterpret_cast<const char*>(file.data()), file.size()));
    return path;
}

}  // namespace

TEST_CASE("animation flags: --time and --animation choose the pose, and the report says it", "[cli]") {
    const TemporaryFolder folder;
    const std::string path = arm_file(folder);
    const auto report = [&](const std::vector<std::string>& flags) {
        std::vector<std::string> arguments{"render", path, "--size", "64x48", "-o", folder.file("a.png"), "--report", "-"};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const Outcome outcome = run(arguments);
        REQUIRE(outcome.code == 0);
        return nlohmann::json::parse(outcome.out);
    };
    const auto first = report({}), later = report({"--time", "1.25"}), rest = report({"--animation", "none"});
    CHECK(first["pose"] == nlohmann::json{{"animation", 0}, {"name", "wave"}, {"time_s", 0.0}});
    CHECK(later["pose"]["time_s"] == 1.25);
    CHECK(!rest.contains("pose"));
    CHECK(first["pixel_hash"] != later["pixel_hash"]);
    CHECK(later["pixel_hash"] == report({"--time", "1.25", "--animation", "wave"})["pixel_hash"]);
    CHECK(report({"--time", "1e6"})["pixel_hash"] == report({"--time", "1000"})["pixel_hash"]);
    CHECK(report({"--time", "7", "--animation", "none"})["pixel_hash"] == rest["pixel_hash"]);
}

TEST_CASE("animation flags: info lists the animations, and an unknown one is a wrong command line", "[cli]") {
    const TemporaryFolder folder;
    const std::string path = arm_file(folder);
    const auto info = nlohmann::json::parse(run({"info", path, "--json"}).out);
    REQUIRE(info["animations"].size() == 1);
    CHECK(info["animations"][0]["name"] == "wave");
    CHECK(info["animations"][0]["channels"] == 10);
    CHECK(info["animations"][0]["end_s"].get<double>() > 1.0);
    CHECK(info["pose"]["animation"] == 0);
    const Outcome wrong = run({"render", path, "--animation", "walk", "-o", folder.file("b.png")});
    CHECK(wrong.code == 2);
    CHECK(wrong.err.find("animation: expected an index below 1, an animation's name or none, found 'walk'") != std::string::npos);
    CHECK(run({"render", "demo", "--time", "3", "--size", "16x9", "-o", folder.file("c.png")}).code == 0);
}

TEST_CASE("scene and variant flags: info lists both, and unknown ones are a wrong command line", "[cli]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("two.glb");
    TriangleFile file;
    file.primitive = R"(,"material":0,"extensions":{"KHR_materials_variants":{"mappings":[{"material":1,"variants":[0]}]}})";
    file.rest = R"(,"extensionsUsed":["KHR_materials_variants"],"extensions":{"KHR_materials_variants":{"variants":[{"name":"red"}]}},)"
                R"("materials":[{},{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}}])";
    const Bytes bytes =
        glb(replaced(file.json(), R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])",
                     R"("scenes":[{"name":"one","nodes":[0]},{"nodes":[0,1]}],"nodes":[{"mesh":0},{"mesh":0,"translation":[3,0,0]}])"),
            file.bin);
    write_contents(path, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    const auto info = nlohmann::json::parse(run({"info", path, "--json", "--scene", "1"}).out);
    CHECK(info["file"]["scene_names"] == nlohmann::json{"one", ""});
    CHECK(info["file"]["scene"] == 1);
    CHECK(info["file"]["variants"] == nlohmann::json{"red"});
    CHECK(info["drawn"]["instances"] == 2);
    const auto hash = [&](const std::vector<std::string>& flags) {
        std::vector<std::string> arguments{"render", path, "--size", "64x48", "-o", folder.file("a.png"), "--report", "-"};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const Outcome outcome = run(arguments);
        REQUIRE(outcome.code == 0);
        return nlohmann::json::parse(outcome.out)["pixel_hash"];
    };
    const auto usual = hash({});
    CHECK(hash({"--scene", "one"}) == usual);
    CHECK(hash({"--scene", "1"}) != usual);
    CHECK(hash({"--variant", "red"}) != usual);
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--scene", "2"}, {"--variant", "blue"}}) {
        const Outcome outcome = run({"render", path, wrong[0], wrong[1], "-o", folder.file("b.png")});
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find(wrong[0] == "--scene" ? "'one'" : "'red'") != std::string::npos);
    }
}
