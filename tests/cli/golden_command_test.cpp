#include "tests/cli/program.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <algorithm>
#include <filesystem>

using namespace halflit::test;

namespace {

using Json = nlohmann::json;

Json scene(const std::string& name, const std::string& scene, std::vector<std::string> flags) {
    flags.insert(flags.end(), {"--size", "32x18"});
    return {{"name", name}, {"scene", scene}, {"flags", flags}};
}

void write_list(const TemporaryFolder& folder, const Json& scenes) {
    write_contents(folder.file("golden.json"), Json{{"schema", "halflit.golden-list/1"}, {"scenes", scenes}}.dump());
}

std::vector<std::pair<std::string, std::string>> statuses(const std::string& json) {
    std::vector<std::pair<std::string, std::string>> found;
    const auto report = Json::parse(json, nullptr, false);
    REQUIRE(!report.is_discarded());
    for (const Json& one : report["scenes"]) found.emplace_back(one["name"], one["status"]);
    return found;
}

using Statuses = std::vector<std::pair<std::string, std::string>>;

/// A triangle, with its data in the file.
std::string triangle() {
    // Positions (0,0,0) (1,0,0) (0,1,0) as float32.
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,
        "uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
}

}  // namespace

TEST_CASE("golden: check passes after update, and update touches nothing that stays the same", "[cli][golden]") {
    const TemporaryFolder folder;
    write_list(folder, {scene("a", "demo", {}), scene("b", "sphere:500", {})});
    CHECK(run({"golden", "check", folder.path()}).code == 1);  // nothing is expected yet
    const Outcome first = run({"golden", "update", folder.path()});
    INFO(first.err);
    REQUIRE(first.code == 0);
    CHECK(first.out == "new       a\nnew       b\n2 scenes, 0 unchanged\n");
    CHECK(folder.names() == std::vector<std::string>{"a.png", "b.png", "golden.json", "hashes.txt", "report"});
    const std::string rendered = run({"render", "demo", "--size", "32x18", "-o", "-"}).out;
    CHECK(contents(folder.file("a.png")) == rendered);
    const Outcome check = run({"golden", "check", folder.path(), "--json"});
    CHECK(check.code == 0);
    CHECK(statuses(check.out) == Statuses{{"a", "equal"}, {"b", "equal"}});
    const auto before = std::filesystem::last_write_time(folder.file("a.png"));
    CHECK(run({"golden", "update", folder.path()}).out == "2 scenes, 2 unchanged\n");
    CHECK(std::filesystem::last_write_time(folder.file("a.png")) == before);
}

TEST_CASE("golden: a change fails with page, pictures and JUnit, unless it is allowed", "[cli][golden]") {
    const TemporaryFolder folder;
    write_list(folder, {scene("a", "demo", {}), scene("b", "sphere:500", {})});
    REQUIRE(run({"golden", "update", folder.path()}).code == 0);
    write_list(folder, {scene("a", "demo", {}), scene("b", "sphere:500", {"--exposure", "1"})});
    const Outcome outcome = run({"golden", "check", folder.path(), "-o", folder.file("out"), "--junit", folder.file("j.xml")});
    CHECK(outcome.code == 1);
    CHECK(outcome.out.find("2 scenes: 1 equal, 1 differs\n") != std::string::npos);
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.file("out"))) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    CHECK(names == std::vector<std::string>{"b-actual.png", "b-difference.png", "b-expected.png", "index.html"});
    CHECK(contents(folder.file("out/b-actual.png")) == run({"render", "sphere:500", "--size", "32x18", "--exposure", "1", "-o", "-"}).out);
    CHECK(contents(folder.file("out/b-expected.png")) == contents(folder.file("b.png")));
    const std::string page = contents(folder.file("out/index.html"));
    for (const std::string& name : names)
        if (name != "index.html") CHECK(page.find("<img src=\"" + name + "\"") != std::string::npos);
    CHECK(page.find("http") == std::string::npos);
    CHECK(page.find("halflit render sphere:500 --exposure 1 --size 32x18 -o b.png") != std::string::npos);
    const std::string junit = contents(folder.file("j.xml"));
    CHECK(junit.find("tests=\"2\" failures=\"1\" errors=\"0\"") != std::string::npos);
    CHECK(junit.find("<testcase classname=\"golden\" name=\"a\"") < junit.find("<failure type=\"differs\""));

    CHECK(run({"golden", "check", folder.path(), "--max", "255"}).code == 0);
    CHECK(run({"golden", "check", folder.path(), "--max-share", "100%"}).code == 0);
    CHECK(run({"golden", "check", folder.path(), "a"}).code == 0);
    CHECK(run({"golden", "check", folder.path(), "b"}).code == 1);
    Json allowed = scene("b", "sphere:500", {"--exposure", "1"});
    allowed["max_share"] = 1;
    write_list(folder, Json::array({allowed}));
    CHECK(run({"golden", "check", folder.path()}).code == 0);
    CHECK(run({"golden", "check", folder.path(), "--max-share", "0"}).code == 1);
    const Outcome update = run({"golden", "update", folder.path()});
    CHECK(update.code == 0);
    CHECK(update.out.starts_with("changed   b  max "));
    CHECK(contents(folder.file("hashes.txt")).find("  a\n") == std::string::npos);  // it has left the list
    CHECK(run({"golden", "check", folder.path()}).code == 0);
}

TEST_CASE("golden: a picture that is not that of its hash fails, and a lost one is made again", "[cli][golden]") {
    const TemporaryFolder folder;
    write_list(folder, {scene("a", "demo", {}), scene("b", "sphere:500", {})});
    REQUIRE(run({"golden", "update", folder.path()}).code == 0);
    std::string hashes = contents(folder.file("hashes.txt"));
    char& digit = hashes[hashes.find("  a\n") - 1];
    digit = digit == '0' ? '1' : '0';
    write_contents(folder.file("hashes.txt"), hashes);
    const Outcome other = run({"golden", "check", folder.path()});
    CHECK(other.code == 1);
    CHECK(other.out.find("as in hashes.txt") != std::string::npos);
    CHECK(run({"golden", "update", folder.path()}).code == 0);
    CHECK(run({"golden", "check", folder.path()}).code == 0);
    std::filesystem::remove(folder.file("b.png"));
    CHECK(run({"golden", "check", folder.path()}).code == 0);  // the hash is enough
    CHECK(run({"golden", "update", folder.path()}).out == "new       b\n2 scenes, 1 unchanged\n");
}

TEST_CASE("golden: update makes the list from models, and overwrites no picture of theirs", "[cli][golden]") {
    const TemporaryFolder folder;
    CHECK(run({"golden", "update", folder.path()}).code == 4);
    for (const char* sub : {"sub", "report", ".hidden"}) std::filesystem::create_directory(folder.file(sub));
    for (const char* name : {"one.gltf", "two.gltf", "sub/one.gltf", "report/no.gltf", ".hidden/no.gltf"})
        write_contents(folder.file(name), triangle());
    const std::string texture = png_of(1, 1, {1, 2, 3, 255});
    write_contents(folder.file("two.png"), texture);
    const Outcome outcome = run({"golden", "update", folder.path()});
    CHECK(outcome.code == 4);
    CHECK(outcome.out.find("failed    two") != std::string::npos);
    CHECK(contents(folder.file("two.png")) == texture);
    const auto list = Json::parse(contents(folder.file("golden.json")));
    Statuses found;
    for (const Json& one : list["scenes"]) found.emplace_back(one["name"], one["scene"]);
    CHECK(found == Statuses{{"one", "one.gltf"}, {"two", "two.gltf"}, {"sub-one", "sub/one.gltf"}});
    CHECK(statuses(run({"golden", "check", folder.path(), "--json"}).out) ==
          Statuses{{"one", "equal"}, {"two", "missing"}, {"sub-one", "equal"}});
}

TEST_CASE("golden: a wrong list ends with 3, and one line that names the place", "[cli][golden]") {
    const TemporaryFolder folder;
    CHECK(run({"golden", "check", folder.path()}).code == 4);
    const std::string head = R"({"schema": "halflit.golden-list/1", "scenes": )";
    const std::pair<std::string, std::string> cases[] = {
        {"[1,", "line 1, column 4"},
        {"[]", "expected an object"},
        {R"({"schema": "halflit.golden-list/2", "scenes": []})", "halflit.golden-list/1"},
        {head + "[]}", "one or more"},
        {head + R"([{"name": "a"}]})", "scenes[0].scene: expected"},
        {head + R"([{"name": "../a", "scene": "demo"}]})", "scenes[0].name: expected"},
        {head + R"([{"name": "a", "scene": "demo"}, {"name": "a", "scene": "demo"}]})", "scenes[1].name: \"a\" is used twice"},
        {head + R"([{"name": "a", "scene": "demo", "flag": []}]})", "unknown key \"flag\""},
        {head + R"([{"name": "a", "scene": "demo", "flags": "--size 1x1"}]})", "scenes[0].flags: expected"},
        {head + R"([{"name": "a", "scene": "demo", "max": 256}]})", "scenes[0].max: expected"}};
    for (const auto& [list, place] : cases) {
        write_contents(folder.file("golden.json"), list);
        const Outcome outcome = run({"golden", "check", folder.path()});
        INFO(list << "\n" << outcome.err);
        CHECK(outcome.code == 3);
        CHECK(outcome.err.find("golden.json: ") != std::string::npos);
        CHECK(outcome.err.find(place) != std::string::npos);
        CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    }
    write_list(folder, Json::array({scene("a", "demo", {})}));
    write_contents(folder.file("hashes.txt"), "0123456789abcdef a\n");
    const Outcome hashes = run({"golden", "check", folder.path()});
    CHECK(hashes.code == 3);
    CHECK(hashes.err.find("hashes.txt: line 1: ") != std::string::npos);
    CHECK(run({"golden", "check", folder.path(), "nobody"}).code == 3);
    std::filesystem::remove(folder.file("hashes.txt"));
    CHECK(run({"golden", "check", folder.path(), "nobody"}).code == 2);
    CHECK(run({"golden", "draw", folder.path()}).code == 2);
    CHECK(run({"golden", "update", folder.path(), "--max", "1"}).code == 2);
    CHECK(run({"golden", "check", folder.path(), "-o", folder.path()}).code == 2);
}

TEST_CASE("golden: scenes do not reach files outside the folder, and one that fails does not hide the others", "[cli][golden]") {
    const TemporaryFolder outside, folder;
    write_contents(outside.file("out.gltf"), triangle());
    const bool has_link = make_link(outside.path(), folder.file("link"));  // where the system makes none, the name leads nowhere
    write_list(folder, {scene("up", "../" + std::filesystem::path(outside.path()).filename().string() + "/out.gltf", {}),
                        scene("absolute", outside.file("out.gltf"), {}), scene("link", "link/out.gltf", {}),
                        scene("env", "demo", {"--env", outside.file("out.gltf")}), scene("more", "demo", {"--allow-external", ".."}),
                        scene("output", "demo", {"-o", "x.png"}), scene("second", "demo", {"demo"}), scene("good", "demo", {})});
    const Outcome outcome = run({"golden", "update", folder.path(), "--json"});
    CHECK(outcome.code == 3);
    const Statuses found = statuses(outcome.out);
    REQUIRE(found.size() == 8);
    for (std::size_t i = 0; i < 7; ++i) {
        INFO(found[i].first);
        CHECK(found[i].second == "failed");
    }
    CHECK(found[7].second == "missing");
    std::vector<std::string> names{"golden.json", "good.png", "hashes.txt"};
    if (has_link) names.emplace_back("link");
    CHECK(folder.names() == names);
    CHECK(run({"golden", "check", folder.path(), "good"}).code == 0);
    const Outcome junit = run({"golden", "check", folder.path(), "--junit", folder.file("j.xml")});
    CHECK(junit.code == 3);
    CHECK(contents(folder.file("j.xml")).find("failures=\"0\" errors=\"7\"") != std::string::npos);
}

TEST_CASE("golden: --junit replaces no file that is not an earlier report", "[cli][golden]") {
    const TemporaryFolder folder;
    write_list(folder, Json::array({scene("ball", "sphere:12", {})}));
    REQUIRE(run({"golden", "update", folder.path()}).code == 0);
    for (const char* name : {"golden.json", "ball.png"}) {
        const Outcome outcome = run({"golden", "check", folder.path(), "--junit", folder.file(name)});
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find("--junit") != std::string::npos);
    }
    for (int i = 0; i < 2; ++i) CHECK(run({"golden", "check", folder.path(), "--junit", folder.file("results.xml")}).code == 0);
}
