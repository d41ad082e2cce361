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
