// halflit mcp: the Model Context Protocol over pipes, compared with the command line.
#include "tests/cli/mcp_server.hpp"
#include "tests/cli/schema_checker.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

using namespace halflit::test;
using nlohmann::json;

namespace {

/// A failure does not print the bytes.
bool same(const std::string& a, const std::string& b) { return !a.empty() && a == b; }

json arguments_of(const std::string& path, json more = json::object()) {
    more["path"] = path;
    return more;
}

/// Bytes of the answer's picture.
std::string picture_of(const json& result) {
    for (const json& content : result["content"])
        if (content["type"] == "image") return decoded_base64(content["data"]);
    return {};
}

std::string text_of(const json& result) { return result["content"][0]["text"]; }

/// The report: the last line of the text, and nowhere else.
json report_of(const json& result) {
    const std::string text = text_of(result);
    CHECK(!result.contains("structuredContent"));
    return json::parse(text.substr(text.rfind('\n', text.size() - 2) + 1));
}

/// Words of a command line for the same picture.
std::vector<std::string> words_of(const std::string& command, const json& arguments, const std::string& output) {
    std::vector<std::string> words{command, arguments["path"]};
    for (const auto& [name, value] : arguments.items()) {
        if (name == "path") continue;
        const json values = value.is_array() ? value : json::array({value});
        for (const json& one : values) {
            if (one == true)
                words.push_back("--" + name);
            else
                words.push_back("--" + name + "=" + (one.is_string() ? one.get<std::string>() : one.dump()));
        }
    }
    words.insert(words.end(), {"-o", output});
    return words;
}

/// The tools, and the schema that the report of each has.
const std::map<std::string, std::string> kSchemas{
    {"look", "look-1.schema.json"},    {"render", "report-1.schema.json"},   {"measure", "measure-1.schema.json"},
    {"section", "look-1.schema.json"}, {"compare", "compare-1.schema.json"}, {"explain", "explain-1.schema.json"},
    {"info", "info-1.schema.json"},
};

struct Models {
    TemporaryFolder folder;
    Models() {
        write_contents(folder.file("box.stl"), box_stl(10, 20, 30));
        write_contents(folder.file("assembly.gltf"), assembly_gltf());
    }
};

}  // namespace

TEST_CASE("mcp: initialize agrees on the client's version, or else offers the newest", "[cli][mcp]") {
    const Models models;
    for (const std::string version : {"2024-11-05", "2025-03-26", "2025-06-18", "1999-01-01"}) {
        McpServer server(models.folder.path());
        const json answer = server.ask("initialize", {{"protocolVersion", version}, {"capabilities", json::object()}});
        INFO(answer.dump());
        CHECK(answer["jsonrpc"] == "2.0");
        CHECK(answer["result"]["protocolVersion"] == (version == "1999-01-01" ? "2025-06-18" : version));
        CHECK(answer["result"]["serverInfo"]["name"] == "halflit");
        CHECK(answer["result"]["capabilities"].contains("tools"));
        server.send(R"({"jsonrpc": "2.0", "method": "notifications/initialized"})");
        CHECK(server.ask("ping")["result"] == json::object());
        CHECK(server.end() == 0);
    }
}

TEST_CASE("mcp: every tool has a schema of types, with its required arguments among the properties", "[cli][mcp]") {
    const Models models;
    McpServer server(models.folder.path());
    const json tools = server.ask("tools/list")["result"]["tools"];
    const std::set<std::string> types{"boolean", "string", "number", "integer", "array"};
    std::set<std::string> names;
    for (const json& tool : tools) {
        INFO(tool["name"]);
        names.insert(tool["name"].get<std::string>());
        CHECK(tool["description"].get<std::string>().size() > 20);
        const json& schema = tool["inputSchema"];
        CHECK(schema["type"] == "object");
        for (const auto& [name, property] : schema["properties"].items()) {
            INFO(name);
            CHECK(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string::npos);
            CHECK(types.contains(property["type"]));
            CHECK((property["type"] == "array") == property.contains("items"));
            if (property.contains("enum")) CHECK(property["enum"].size() > 1);
            CHECK(!property["description"].get<std::string>().empty());
        }
        CHECK(!schema["required"].empty());
        for (const json& name : schema["required"]) CHECK(schema["properties"].contains(name.get<std::string>()));
    }
    CHECK(tools.dump().size() <= 12'000);  // an agent pays for each byte, about a quarter of a token
    CHECK(names == std::set<std::string>{"look", "render", "measure", "section", "explain", "info", "compare"});
}

TEST_CASE("mcp: look gives the sheet and the report of the command", "[cli][mcp]") {
    const Models models;
    McpServer server(models.folder.path());
    server.initialize();
    for (const std::string model : {"box.stl", "assembly.gltf"}) {
        const json result = server.call("look", arguments_of(model, {{"edges", "all"}}));
        INFO(text_of(result));
        CHECK(result["isError"] == false);
        const RunSettings in_folder{.folder = models.folder.path()};
        (void)run({"look", model, "--edges", "all", "-o", "sheet.png", "--json", "look.json"}, in_folder);
        CHECK(same(picture_of(result), contents(models.folder.file("sheet.png"))));
        CHECK(report_of(result) == json::parse(contents(models.folder.file("look.json"))));
        CHECK(contains(text_of(result), "\"schema\":\"halflit.look/1\""));
    }
    // The small box stands inside the large one.
    CHECK(text_of(server.call("look", arguments_of("assembly.gltf"))).starts_with("FAULT: part 2, inner is in no view\n"));
    CHECK(text_of(server.call("look", arguments_of("box.stl"))).starts_with("No faults"));
    CHECK(server.end() == 0);
}

TEST_CASE("mcp: answers of every tool are valid under the schema of its report", "[cli][mcp]") {
    const Models models;
    write_contents(models.folder.file("empty.gltf"), R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})");
    McpServer server(models.folder.path());
    server.initialize();
    for (const std::string model : {"box.stl", "assembly.gltf", "empty.gltf", "demo"})
        for (const auto& [tool, schema] : kSchemas) {
            INFO(tool << " of " << model);
            const bool certifies = tool == "look" && model == "box.stl";
            json arguments{{"size", "64"}};
            if (tool == "compare") arguments.update({{"a", model}, {"b", "box.stl"}});
            if (tool != "compare") arguments["path"] = model;
            if (tool == "section") arguments["section"] = {"x=50%"};
            if (tool == "explain") arguments["pixel"] = {"32,32", "0,0"};
            if (tool == "measure" || tool == "info") arguments.erase("size");
            if (certifies) arguments["certify"] = 4;
            const json result = server.call(tool, arguments);
            INFO(text_of(result));
            REQUIRE(result["isError"] == false);
            const Schema checker(schema);
            CHECK(checker.fault(report_of(result)) == "");
            CHECK(checker.unknown().empty());
        }
}

TEST_CASE("mcp: what a long report leaves out is counted, list by list", "[cli][mcp]") {
    const Models models;
    write_contents(models.folder.file("many.obj"), [] {
        std::string text;  // 2000 triangles that face up and down in turn: from no side are all of them seen
        for (int i = 0; i < 2000; ++i) {
            const std::string name = "o " + std::string(40, 'n') + std::to_string(i) + "\n";
            const auto vertex = [&](double x, double z) { return "v " + std::to_string(i + x) + " 0 " + std::to_string(z) + "\n"; };
            text += name + vertex(0, 0) + vertex(0.5, 0) + vertex(0, 1) + "f " + (i % 2 == 0 ? "-3 -2 -1\n" : "-3 -1 -2\n");
        }
        return text;
    }());
    McpServer server(models.folder.path());
    server.initialize();
    const json arguments{{"size", "64"}, {"certify", 1}, {"view", {"front"}}};
    const json result = server.call("look", arguments_of("many.obj", arguments));
    const RunSettings in_folder{.folder = models.folder.path()};
    (void)run({"look", "many.obj", "--size", "64", "--certify", "1", "--view", "front", "--json", "whole.json"}, in_folder);
    const json whole = json::parse(contents(models.folder.file("whole.json")));
    const json cut = report_of(result);
    CHECK(whole.dump().size() > 200'000);
    CHECK(cut.dump().size() <= 60'000);
    CHECK(text_of(result).size() < 80'000);
    json without = cut;
    without.erase("left_out");
    CHECK(Schema("look-1.schema.json").fault(without) == "");
    CHECK(Schema("answer-1.schema.json").fault({{"left_out", cut["left_out"]}}) == "");
    CHECK(!whole.contains("left_out"));
    REQUIRE(cut["left_out"].size() > 1);
    std::set<std::string> lists;
    for (const json& left : cut["left_out"]) {
        const json::json_pointer list(left["list"].get<std::string>());
        INFO(left.dump());
        lists.insert(left["list"]);
        const json &kept = cut[list], &all = whole[list];
        CHECK(kept.size() + left["items"].get<std::size_t>() == all.size());
        CHECK(kept[0].dump().substr(0, 30) == all[0].dump().substr(0, 30));
    }
    CHECK(lists.contains("/parts"));
    CHECK(cut["parts"][0] == whole["parts"][0]);
    CHECK(cut["views"][0]["camera"] == whole["views"][0]["camera"]);
    CHECK(cut["certificate"]["triangles"] == whole["certificate"]["triangles"]);
    // Lists that were not cut are whole.
    CHECK(cut["views"].size() == whole["views"].size());
}

TEST_CASE("mcp: ten calls on one server give the pictures of the command line", "[cli][mcp]") {
    const Models models;
    McpServer server(models.folder.path());
    const json calls[] = {arguments_of("box.stl", {{"size", "64"}}),
                          arguments_of("box.stl", {{"size", "64x32"}, {"azimuth", -40}, {"elevation", 10.5}}),
                          arguments_of("box.stl", {{"size", "64"}, {"section", {"x=50%", "-z=10%"}}}),
                          arguments_of("box.stl", {{"size", "64"}, {"view", {"top"}}, {"orthographic", true}}),
                          arguments_of("assembly.gltf", {{"size", "64"}, {"samples", 1}}),
                          arguments_of("assembly.gltf", {{"size", "64"}, {"ground", true}, {"background", "#fff"}}),
                          arguments_of("box.stl", {{"size", "64"}, {"kd", 0.2}, {"edges", "all"}}),
                          arguments_of("box.stl", {{"size", "64"}, {"env", "sky"}}),
                          arguments_of("demo", {{"size", "64"}}),
                          arguments_of("box.stl", {{"size", "64"}})};
    for (const json& arguments : calls) {
        INFO(arguments.dump());
        const json result = server.call("render", arguments);
        INFO(text_of(result));
        REQUIRE(run(words_of("render", arguments, "picture.png"), {.folder = models.folder.path()}).code == 0);
        CHECK(same(picture_of(result), contents(models.folder.file("picture.png"))));
        CHECK(read_picture(picture_of(result)).width == 64);
    }
}

TEST_CASE("mcp: measures and sections of a box are those of its sides", "[cli][mcp]") {
    const Models models;
    McpServer server(models.folder.path());
    server.initialize();
    const json measured = report_of(server.call("measure", arguments_of("box.stl")));
    INFO(measured.dump());
    CHECK(measured["measures"]["volume"] == 6000);
    CHECK(measured["measures"]["area"] == 2200);
    CHECK(measured["measures"]["watertight"] == true);
    REQUIRE(measured["parts"].size() == 1);
    for (const auto& [key, value] : measured["parts"][0]["measures"].items()) CHECK(measured["measures"][key] == value);
    CHECK(measured["parts"][0]["measures"].size() >= 5);
    const json parts = report_of(server.call("measure", arguments_of("assembly.gltf")))["parts"];
    REQUIRE(parts.size() == 2);
    CHECK(parts[0]["name"] == "outer");
    CHECK(parts[0]["measures"]["volume"] == 1);
    CHECK(parts[1]["measures"]["volume"] == 0.125);
    const json cut = server.call("section", arguments_of("box.stl", {{"section", {"x=50%"}}}));
    INFO(text_of(cut));
    REQUIRE(report_of(cut)["sections"].size() == 1);
    CHECK(report_of(cut)["sections"][0]["area"] == 600);
    CHECK(contains(text_of(cut), "section x=50%: area 600\n"));
    CHECK(picture_of(cut).starts_with("\x89PNG"));
    // The outer box spans -0.5 to 0.5, the inner one half of it.
    const auto removed = [&](const std::string& plane) {
        const json look = report_of(server.call("look", arguments_of("assembly.gltf", {{"section", {plane}}, {"size", "64"}})));
        return std::pair(look["removed_by_section"], look["never_seen"]);
    };
    CHECK(removed("x=0.1") == std::pair(json::array(), json::array()));
    CHECK(removed("x=-0.3") == std::pair(json::array({2}), json::array()));
    CHECK(removed("x=-0.6").first == json::array({1, 2}));
    const json bodies = report_of(server.call("measure", arguments_of("assembly.gltf")))["measures"]["body_list"];
    REQUIRE(bodies.size() == 2);
    CHECK(bodies[0]["part"] == 1);
    CHECK(bodies[1]["part"] == 2);
    CHECK(bodies[1]["min"] == json({-0.25, -0.25, -0.25}));
    CHECK(bodies[1]["max"] == json({0.25, 0.25, 0.25}));
    CHECK(bodies[1]["center"] == json({0, 0, 0}));
    CHECK(bodies[1]["volume"] == 0.125);
    const json info = server.call("info", arguments_of("box.stl"));
    CHECK(report_of(info) == json::parse(run({"info", "box.stl", "--json"}, {.folder = models.folder.path()}).out));
}

TEST_CASE("mcp: explain tells of the part that look shows in a view's box", "[cli][mcp]") {
    const Models models;
    McpServer server(models.folder.path());
    server.initialize();
    const json look = report_of(server.call("look", arguments_of("assembly.gltf")));
    for (const json& view : look["views"]) {
        const json& box = view["box"];
        const int x = box[0].get<int>() + box[2].get<int>() / 2, y = box[1].get<int>() + box[3].get<int>() / 2;
        const std::string pixel = std::to_string(x) + "," + std::to_string(y);
        const json story = server.call("explain", arguments_of("assembly.gltf", {{"pixel", {pixel, "0,0"}}, {"of", view["name"]}}));
        INFO(text_of(story));
        CHECK(report_of(story)["size"] == json({480, 400}));
        CHECK(report_of(story)["pixels"][0]["shows"] == "surface");
        CHECK(contains(text_of(story), "outer"));
        CHECK(report_of(story)["pixels"][1]["shows"] == "background");
    }
    CHECK(server.call("explain", arguments_of("box.stl", {{"pixel", "480,0"}}))["isError"] == true);
    CHECK(server.call("explain", arguments_of("box.stl", {{"pixel", "1,1"}, {"of", "left"}}))["isError"] == true);
}

TEST_CASE("mcp: a picture in which nothing is seen is told before the report", "[cli][mcp]") {
    const Models models;
    McpServer server(models.folder.path());
    server.initialize();
    const json away{{"camera-position", "100,0,0"}, {"camera-target", "200,0,0"}, {"size", "64"}};
    const json look = server.call("look", arguments_of("box.stl", away));
    CHECK(text_of(look).starts_with("FAULT: view view: blank\n"));
    CHECK(report_of(look)["good"] == false);
    CHECK(text_of(server.call("render", arguments_of("box.stl", away))).starts_with("FAULT: blank"));
}

TEST_CASE("mcp: paths that leave the root are refused, also by symbolic links", "[cli][mcp]") {
    const Models models;
    const TemporaryFolder outside;
    write_contents(outside.file("secret.stl"), box_stl(1, 1, 1));
    const TemporaryFolder& folder = models.folder;
    const bool links = make_link(outside.file("secret.stl"), folder.file("link.stl")) && make_link(outside.path(), folder.file("door")) &&
                       make_link(outside.file("new.png"), folder.file("new.png")) && make_link("box.stl", folder.file("inside.stl"));
    (void)make_pipe(folder.file("pipe.stl"));
    const std::string name = std::filesystem::path(outside.path()).filename().string();
    McpServer server(folder.path());
    for (const std::string& path :
         std::vector<std::string>{"link.stl", "door/secret.stl", "../" + name + "/secret.stl", "x/../../" + name + "/secret.stl",
                                  outside.file("secret.stl"), "/etc/passwd", "-", ".", "", "pipe.stl", "missing.stl"}) {
        INFO(path);
        for (const std::string tool : {"look", "info"}) CHECK(server.call(tool, arguments_of(path))["isError"] == true);
        CHECK(server.call("render", arguments_of("box.stl", {{"env", path}, {"size", "16"}}))["isError"] == true);
    }
    CHECK(contains(text_of(server.call("info", arguments_of("bxo.stl"))), "did you mean box.stl?"));
    if (links) CHECK(server.call("info", arguments_of("inside.stl"))["isError"] == false);
    CHECK(server.call("info", arguments_of(folder.file("box.stl")))["isError"] == false);
    for (const std::string& path :
         std::vector<std::string>{"../" + name + "/a.png", "door/a.png", "new.png", "box.stl", "a.txt", "a.exr", "no/a.png"}) {
        INFO(path);
        if (path == "new.png" && !links) continue;
        for (const std::string tool : {"look", "render"})
            CHECK(server.call(tool, arguments_of("box.stl", {{"output", path}, {"size", "16"}}))["isError"] == true);
    }
    CHECK(outside.names() == std::vector<std::string>{"secret.stl"});
    CHECK(contents(folder.file("box.stl")) == box_stl(10, 20, 30));
    const json written = server.call("render", arguments_of("box.stl", {{"output", "a.png"}, {"size", "16"}}));
    CHECK(same(picture_of(written), contents(folder.file("a.png"))));

    McpServer open(folder.path(), {"--allow-external"});
    CHECK(open.call("info", arguments_of(links ? "link.stl" : outside.file("secret.stl")))["isError"] == false);
    CHECK(open.call("render", arguments_of("link.stl", {{"output", outside.file("a.png")}, {"size", "16"}}))["isError"] == true);
    CHECK(outside.names() == std::vector<std::string>{"secret.stl"});
}

TEST_CASE("mcp: nothing is written without an output", "[cli][mcp]") {
    const Models models;
    const auto names = models.folder.names();
    McpServer server(models.folder.path());
    for (const std::string tool : {"look", "render", "measure", "info"})
        CHECK(server.call(tool, arguments_of("box.stl"))["isError"] == false);
    CHECK(server.end() == 0);
    CHECK(models.folder.names() == names);
}

TEST_CASE("mcp: arguments that are wrong give an error that names them", "[cli][mcp]") {
    const Models models;
    McpServer server(models.folder.path());
    const auto refused = [&](const std::string& tool, const json& arguments, const std::string& says) {
        const json result = server.call(tool, arguments);
        INFO(result.dump());
        CHECK(result["isError"] == true);
        CHECK(contains(text_of(result), says));
    };
    refused("look", json::object(), "path");
    refused("look", {{"path", 7}}, "path");
    refused("look", {{"path", {{"a", 1}}}}, "path");
    refused("look", {{"path", std::string("box.stl\0.png", 12)}}, "path");
    refused("look", arguments_of("box.stl", {{"size", "big"}}), "size: expected");
    refused("look", arguments_of("box.stl", {{"edges", "som"}}), "edges: expected");
    refused("look", arguments_of("box.stl", {{"perspective", "yes"}}), "perspective: expected true or false");
    refused("look", arguments_of("box.stl", {{"hidden_edgs", "dashed"}}), "did you mean hidden-edges?");
    refused("look", arguments_of("box.stl", {{"max-memory", 64}}), "unknown argument");
    refused("look", {{"model", "box.stl"}}, "look: unknown argument 'model', expected some of path, view");
    refused("look", arguments_of("box.stl", {{"size", {"64", "32"}}}), "size");
    refused("render", arguments_of("box.stl", {{"view", "front,top"}}), "expected one view");
    refused("render", arguments_of("box.stl", {{"output", std::string("a.png\0.jpg", 10)}}), "output: expected text without zero bytes");
    refused("render", arguments_of("box.stl", {{"output", ""}}), "output: expected a value");
    refused("measure", arguments_of("box.stl", {{"output", "a.png"}}), "unknown argument 'output'");
    refused("section", arguments_of("box.stl"), "section");
    refused("explain", arguments_of("box.stl"), "pixel");
    write_contents(models.folder.file("broken.gltf"), "{\"asset\": ");
    refused("look", arguments_of("broken.gltf"), "broken.gltf");
    CHECK(server.call("look", arguments_of("box.stl"))["isError"] == false);
}

TEST_CASE("mcp: a message that is none gets an error, and the server goes on", "[cli][mcp]") {
    const Models models;
    McpServer server(models.folder.path());
    const auto code_for = [&](const std::string& line) {
        server.send(line);
        const json answer = server.read();
        INFO(answer.dump());
        CHECK(answer["jsonrpc"] == "2.0");
        return answer["error"]["code"].get<int>();
    };
    CHECK(code_for("{") == -32700);
    CHECK(code_for("\xff") == -32700);
    CHECK(code_for(std::string(100'000, '[')) == -32700);
    CHECK(code_for(std::string(3'000'000, ' ') + "{}") == -32700);
    CHECK(code_for("7") == -32600);
    CHECK(code_for("[]") == -32600);
    CHECK(code_for("{}") == -32600);
    CHECK(code_for(R"({"jsonrpc": "2.0", "id": null, "method": "ping"})") == -32600);
    CHECK(code_for(R"({"jsonrpc": "2.0", "id": {}, "method": "ping"})") == -32600);
    CHECK(code_for(R"({"jsonrpc": "1.0", "id": 1, "method": "ping"})") == -32600);
    CHECK(code_for(R"({"jsonrpc": "2.0", "id": 1, "method": 5})") == -32600);
    CHECK(code_for(R"({"jsonrpc": "2.0", "id": 1, "method": "resources/list"})") == -32601);
    CHECK(code_for(R"({"jsonrpc": "2.0", "id": 1, "method": "tools/call"})") == -32602);
    CHECK(code_for(R"({"jsonrpc": "2.0", "id": 1, "method": "ping", "params": [1]})") == -32602);
    CHECK(code_for(R"({"jsonrpc": "2.0", "id": 1, "method": "tools/call", "params": {"name": "loook"}})") == -32602);
    CHECK(code_for(R"({"jsonrpc": "2.0", "id": 1, "method": "tools/call", "params": {"name": "look", "arguments": 3}})") == -32602);
    server.send("");
    server.send(R"({"jsonrpc": "2.0", "method": "notifications/nothing"})");
    server.send(R"({"jsonrpc": "2.0", "id": 9, "result": {}})");
    CHECK(server.ask("ping")["result"] == json::object());
    CHECK(server.end() == 0);
}

TEST_CASE("mcp: lists of messages are answered in the version that has them alone", "[cli][mcp]") {
    const Models models;
    const std::string list = R"([{"jsonrpc": "2.0", "id": "a", "method": "ping"}, {"jsonrpc": "2.0", "method": "notifications/x"},
        {"jsonrpc": "2.0", "id": "b", "method": "nothing"}])";
    std::string line = list;
    std::replace(line.begin(), line.end(), '\n', ' ');
    for (const std::string version : {"2024-11-05", "2025-03-26", "2025-06-18"}) {
        McpServer server(models.folder.path());
        (void)server.ask("initialize", {{"protocolVersion", version}});
        server.send(line);
        const json answer = server.read();
        INFO(version << answer.dump());
        if (version != "2025-03-26") {
            CHECK(answer["error"]["code"] == -32600);
            continue;
        }
        REQUIRE(answer.size() == 2);
        CHECK(answer[0]["id"] == "a");
        CHECK(answer[1]["error"]["code"] == -32601);
    }
}

TEST_CASE("mcp: a call that takes too long ends with an error", "[cli][mcp]") {
    const Models models;
    McpServer server(models.folder.path(), {"--timeout", "0.05"});
    const json result = server.call("render", arguments_of("sphere:3000000", {{"size", "4000"}, {"samples", 16}}));
    CHECK(result["isError"] == true);
    CHECK(contains(text_of(result), "time limit"));
    CHECK(server.ask("ping")["result"] == json::object());
}

TEST_CASE("mcp: a cancelled call gets no answer, and the next one does", "[cli][mcp]") {
    const Models models;
    McpServer server(models.folder.path());
    const json slow = arguments_of("demo", {{"size", "8000"}, {"samples", 16}, {"sky-shadows", 64}});
    server.send(
        json{{"jsonrpc", "2.0"}, {"id", 500}, {"method", "tools/call"}, {"params", {{"name", "render"}, {"arguments", slow}}}}.dump());
    server.send(
        json{{"jsonrpc", "2.0"}, {"id", 501}, {"method", "tools/call"}, {"params", {{"name", "render"}, {"arguments", slow}}}}.dump());
    for (const int id : {501, 500})
        server.send(json{{"jsonrpc", "2.0"}, {"method", "notifications/cancelled"}, {"params", {{"requestId", id}}}}.dump());
    const auto started = std::chrono::steady_clock::now();
    server.send(R"({"jsonrpc": "2.0", "id": 502, "method": "ping"})");
    CHECK(server.read()["id"] == 502);
    CHECK(std::chrono::steady_clock::now() - started < std::chrono::seconds(20));  // a call takes a minute
    CHECK(server.end() == 0);
}

TEST_CASE("mcp: a kept model is answered sooner, and is loaded anew when its file changes", "[cli][mcp]") {
    const Models models;
    const std::string path = models.folder.file("large.obj");
    write_contents(path, grid_obj(300, 1.0));
    McpServer server(models.folder.path());
    server.initialize();
    const auto ms = [&] {
        const auto started = std::chrono::steady_clock::now();
        const json result = server.call("info", arguments_of("large.obj"));
        REQUIRE(result["isError"] == false);
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started).count();
    };
    const double first = ms();
    double later = ms();
    for (int i = 0; i < 4; ++i) later = std::min(later, ms());
    INFO(first << " ms, then " << later << " ms");
    CHECK(later < first);
    CHECK(report_of(server.call("measure", arguments_of("large.obj")))["measures"]["size"] == json({300, 0, 300}));
    write_contents(path, grid_obj(300, 2.0));
    CHECK(report_of(server.call("measure", arguments_of("large.obj")))["measures"]["size"] == json({600, 0, 600}));
    // Another file of the same size and time, put in its place.
    const auto time = std::filesystem::last_write_time(path);
    write_contents(path + ".new", grid_obj(300, 3.0));
    std::filesystem::last_write_time(path + ".new", time);
    std::filesystem::rename(path + ".new", path);
    CHECK(report_of(server.call("measure", arguments_of("large.obj")))["measures"]["size"] == json({900, 0, 900}));
    // Flags of loading count: z up.
    CHECK(report_of(server.call("measure", arguments_of("box.stl")))["measures"]["volume"] == 6000);
    const json turned = server.call("render", arguments_of("box.stl", {{"up", "y"}, {"size", "32"}}));
    const json upright = server.call("render", arguments_of("box.stl", {{"size", "32"}}));
    CHECK(!same(picture_of(turned), picture_of(upright)));
}

TEST_CASE("mcp: mutated messages get one answer for each request", "[cli][mcp]") {
    const Models models;
    const std::vector<std::string> seeds{
        R"({"jsonrpc": "2.0", "id": 1, "method": "ping"})",
        R"({"jsonrpc": "2.0", "id": 2, "method": "tools/list", "params": {}})",
        R"({"jsonrpc": "2.0", "id": 3, "method": "tools/call", "params": {"name": "measure", "arguments": {"path": "box.stl"}}})",
        R"({"jsonrpc": "2.0", "id": "four", "method": "tools/call", "params": {"name": "look", "arguments": )"
        R"({"path": "box.stl", "size": "16"}}})",
        R"({"jsonrpc": "2.0", "id": 5, "method": "tools/call", "params": {"name": "section", "arguments": )"
        R"({"path": "box.stl", "section": ["x=1"], "size": "16x8"}}})",
        R"({"jsonrpc": "2.0", "method": "notifications/initialized"})"};
    std::uint64_t state = 1;
    const auto random = [&](std::size_t below) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<std::size_t>(state >> 33) % below;
    };
    std::string input;
    std::map<std::string, int> expected;
    for (int i = 0; i < 2000; ++i) {
        std::string line = seeds[random(seeds.size())];
        for (std::size_t changes = random(4); changes > 0; --changes) {
            const std::size_t at = random(line.size());
            const char byte = static_cast<char>(random(3) == 0 ? random(256) : std::string_view("{}[]\",:0129-.eE\\ntu")[random(19)]);
            switch (random(4)) {
                case 0:
                    line[at] = byte;
                    break;
                case 1:
                    line.insert(at, 1, byte);
                    break;
                case 2:
                    line.erase(at, 1 + random(3));
                    break;
                default:
                    line.insert(at, line.substr(random(line.size()), random(12)));
            }
            if (line.empty()) line = " ";
        }
        std::replace(line.begin(), line.end(), '\n', ' ');
        input += line + "\n";
        if (const auto id = id_of_answer(line)) ++expected[*id];
    }
    const Outcome outcome = run({"mcp", "--timeout", "5"}, {.input = input, .folder = models.folder.path()});
    CHECK(outcome.code == 0);
    std::map<std::string, int> found;
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);) ++found[json::parse(line)["id"].dump()];
    CHECK(found == expected);
    CHECK(expected.size() > 5);
}
