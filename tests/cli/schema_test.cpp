#include "tests/cli/program.hpp"
#include "tests/cli/schema_checker.hpp"
#include "tests/io/animated_file.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <filesystem>
#include <regex>

using namespace halflit::test;

namespace {

using Json = nlohmann::json;

void check_report(const std::string& kind, const std::string& text) {
    const Json json = Json::parse(text, nullptr, false);
    REQUIRE(!json.is_discarded());
    INFO(kind << ": " << text.substr(0, 4000));
    CHECK(json["schema"] == "halflit." + kind + "/1");
    const Schema schema(kind + "-1.schema.json");
    CHECK(schema.fault(json) == "");
    CHECK(schema.unknown().empty());
}

std::string output_of(const std::vector<std::string>& arguments, int code = 0) {
    const Outcome outcome = run(arguments);
    INFO(outcome.err);
    CHECK(outcome.code == code);
    return outcome.out;
}

}  // namespace

TEST_CASE("schema: the checker finds missing, unknown and wrong keys", "[cli][schema]") {
    const Schema schema("diff-1.schema.json");
    const TemporaryFolder folder;
    write_contents(folder.file("a.png"), png_of(1, 1, {1, 2, 3, 255}));
    const Json good = Json::parse(output_of({"diff", folder.file("a.png"), folder.file("a.png"), "--json"}));
    REQUIRE(schema.fault(good) == "");
    for (const auto& [key, value] : good.items()) {
        Json lacking = good;
        lacking.erase(key);
        INFO(key);
        CHECK(schema.fault(lacking) != "");
        Json wrong = good;
        wrong[key] = Json::object({{"x", 1}});
        CHECK(schema.fault(wrong) != "");
    }
    Json more = good;
    more["more"] = 1;
    CHECK(schema.fault(more).find("/more: is not in the schema") != std::string::npos);
    Json deep = good;
    deep["tolerance"]["more"] = 1;
    CHECK(schema.fault(deep).find("/tolerance/more: is not in the schema") != std::string::npos);
}

TEST_CASE("schema: reports of render have the keys that their schema describes", "[cli][schema]") {
    const TemporaryFolder folder;
    const std::vector<std::string> head{"render", "demo", "--size", "16x9", "-o", folder.file("a.png"), "--report", "-"};
    const auto report = [&](const std::vector<std::string>& flags, int code = 0) {
        std::vector<std::string> arguments = head;
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        check_report("report", output_of(arguments, code));
    };
    report({});
    report({"--env", "sky", "--max-error", "1"});
    report({"--shading", "gouraud", "--accuracy", "reference", "--region", "1,1,4,4", "--power", "0.5"});
    report({"--camera", "none"}, 2);
}

TEST_CASE("schema: bench, info, diff, golden and trade have the keys that their schemas describe", "[cli][schema]") {
    const TemporaryFolder folder;
    check_report("bench", output_of({"bench", "sphere:500", "--size", "16x9", "--frames", "2", "--json", "--encode", "--env", "sky"}));
    check_report("info", output_of({"info", "demo", "--json"}));
    check_report("info", output_of({"info", "demo", "--json", "--env", "sky", "--max-error", "1", "--light", "spot:range=3", "--lobe",
                                    "mcauley", "--wrap", "0.3", "--power", "2.5"}));
    check_report("info", output_of({"info", "sphere:100", "--json", "--specular", "none", "--light", "point"}));
    write_contents(folder.file("empty.gltf"), R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})");
    check_report("info", output_of({"info", folder.file("empty.gltf"), "--json"}));
    const Bytes arm = Arm(1, Keys::linear).file;  // animated
    write_contents(folder.file("arm.glb"), std::string(reinterpret_cast<const char*>(arm.data()), arm.size()));
    check_report("info", output_of({"info", folder.file("arm.glb"), "--json", "--parts", "--hide", "1"}));
    check_report("report", output_of({"render", folder.file("arm.glb"), "--size", "16x9", "-o", folder.file("arm.png"), "--report", "-"}));
    check_report("report", output_of({"render", "demo", "--size", "16x9", "--turntable", "9", "--frames", "4", "-o",
                                      folder.file("t_{}.png"), "--report", "-"}));

    for (const char* sub : {"a", "b"}) std::filesystem::create_directory(folder.file(sub));
    const auto picture = [&](const std::string& path, unsigned char red) {
        write_contents(folder.file(path), png_of(1, 1, {red, 2, 3, 255}));
    };
    for (const char* path : {"a/same.png", "b/same.png", "a/other.png", "a/missing.png", "b/extra.png"}) picture(path, 1);
    picture("b/other.png", 9);
    write_contents(folder.file("a/wide.png"), png_of(2, 1, {1, 2, 3, 255, 1, 2, 3, 255}));
    picture("b/wide.png", 1);
    check_report("diff", output_of({"diff", folder.file("a/same.png"), folder.file("b/other.png"), "--json"}, 1));
    check_report("diff", output_of({"diff", folder.file("a"), folder.file("b"), "--json"}, 1));

    const std::string list = R"({"schema": "halflit.golden-list/1", "scenes": [
        {"name": "a", "scene": "demo", "flags": ["--size", "16x9"], "max": 2, "max_share": 0.5},
        {"name": "b", "scene": "sphere:500", "flags": ["--size", "8x8", "--exposure", "0"]}, {"name": "c", "scene": "lost.glb"}]})";
    write_contents(folder.file("golden.json"), list);
    const Schema list_schema("golden-list-1.schema.json");
    CHECK(list_schema.fault(Json::parse(list)) == "");
    CHECK(list_schema.unknown().empty());
    check_report("golden", output_of({"golden", "update", folder.path(), "--json"}, 4));
    const std::string before = contents(folder.file("golden.json"));
    write_contents(folder.file("golden.json"), std::regex_replace(before, std::regex("\"--exposure\", \"0\""), "\"--exposure\", \"1\""));
    check_report("golden", output_of({"golden", "check", folder.path(), "--json"}, 4));
    check_report("golden", output_of({"golden", "check", folder.path(), "b", "--json"}, 1));

    output_of({"trade", "sphere:100", "--quick", "--size", "16x9", "--frames", "1", "-o", folder.file("trade")});
    check_report("trade", contents(folder.file("trade/trade.json")));
}

TEST_CASE("schema: lobe and env have the keys that their schemas describe", "[cli][schema]") {
    for (const std::vector<std::string>& model :
         {std::vector<std::string>{"lambert"}, {"sloan", "--wrap", "1"}, {"green", "--power", "0.5"}}) {
        std::vector<std::string> arguments{"lobe", "--json"};
        arguments.insert(arguments.begin() + 1, model.begin(), model.end());
        check_report("lobe", output_of(arguments));
    }
    check_report("env", output_of({"env", "sky", "--json"}));
    check_report("env", output_of({"env", "sky", "--bands", "3", "--json"}));
}

TEST_CASE("schema: compare has the keys that its schema describes", "[cli][schema]") {
    const TemporaryFolder folder;
    const auto compare = [&](const std::string& a, const std::string& b, int code) {
        check_report("compare", output_of({"compare", a, b, "--size", "32x24", "--json", "-"}, code));
    };
    compare("sphere:100", "sphere:100", 0);
    compare("sphere:100", "demo", 1);
    write_contents(folder.file("empty.gltf"), R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})");
    compare(folder.file("empty.gltf"), "sphere:100", 1);
    compare(folder.file("empty.gltf"), folder.file("empty.gltf"), 0);
}

TEST_CASE("schema: explain has the keys that its schema describes", "[cli][schema]") {
    check_report("explain", output_of({"explain", "demo", "--size", "64x36", "--json", "--pixel", "32,20", "--pixel", "0,0", "--pixel",
                                       "40,30", "--max-error", "1"}));
    check_report("explain", output_of({"explain", "sphere:100", "--size", "16", "--json", "--pixel", "8,8", "--background", "#ff0000"}));
}

TEST_CASE("schema: look has the keys that its schema describes", "[cli][schema]") {
    check_report("look", output_of({"look", "demo", "--size", "120x90", "--json", "-"}, 1));  // a long row: tiny from the right
    check_report("look", output_of({"look", "sphere:100", "--size", "64", "--json", "-", "--camera-position", "0,0,0.2"}, 1));
    check_report("look", output_of({"look", "sphere:100", "--size", "64", "--json", "-", "--perspective", "--view", "front"}));
    check_report("look", output_of({"look", "sphere:2000", "--size", "64", "--json", "-", "--certify", "8", "--certify-views", "5"}, 1));
    const TemporaryFolder folder;
    write_contents(folder.file("empty.gltf"), R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})");
    check_report("look", output_of({"look", folder.file("empty.gltf"), "--size", "64", "--json", "-"}, 1));
    check_report("look", output_of({"look", "sphere:100", "--size", "64", "--json", "-", "--section", "x=50%"}));
}

TEST_CASE("schema: the report of view has the keys that its schema describes", "[cli][schema]") {
    RunSettings settings;
    settings.environment = {{"SDL_VIDEODRIVER", "dummy"}};
    for (const std::vector<std::string>& how : {std::vector<std::string>{"--orbit", "3", "--click", "32,24"}, {"--click", "0,0"}}) {
        std::vector<std::string> arguments{"view", "sphere:500", "--size", "64x48", "--report", "-"};
        arguments.insert(arguments.end(), how.begin(), how.end());
        const Outcome outcome = run(arguments, settings);
        if (outcome.code == 2 && outcome.err.find("needs the librar") != std::string::npos) HALFLIT_SKIP(outcome.err);
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        check_report("view", outcome.out);
    }
}
