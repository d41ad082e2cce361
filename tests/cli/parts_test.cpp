// Parts of a scene: how flags name them, how they are drawn, and what halflit info says of them.
#include "tests/cli/program.hpp"
#include "tests/io/animated_file.hpp"
#include "tests/support/assets.hpp"
#include "tests/support/skip.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

using namespace halflit::test;

namespace {

using Json = nlohmann::json;
using Strings = std::vector<std::string>;

/// The triangle (0, 0), (1, 0), (0, 2), placed by named nodes. Part 5 has no name, and its mesh has none.
const std::string kTree = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,6,7]}],"nodes":[
{"name":"Wheels","children":[1,2,4]},{"name":"front.1","mesh":0},{"name":"Rear","children":[3]},{"name":"rear.1","mesh":0},
{"name":"front.2","mesh":0,"children":[5]},{"name":"2","mesh":0},{"mesh":0},{"name":"a,b*","mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,2,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAA"}]})";

/// A box between two corners as an object of an OBJ file. first: number of its first vertex, from 1.
std::string box(const std::string& name, std::vector<double> low, std::vector<double> high, int first) {
    std::string text = "o " + name + "\n";
    for (std::size_t i = 0; i < 8; ++i) {
        text += "v";
        for (std::size_t axis = 0; axis < 3; ++axis) text += " " + std::to_string((i >> axis & 1) != 0 ? high[axis] : low[axis]);
        text += "\n";
    }
    for (const char* face : {"0231", "4576", "0154", "2673", "0462", "1375"}) {
        text += "f";
        for (int corner = 0; corner < 4; ++corner) text += " " + std::to_string(first + (face[corner] - '0'));
        text += "\n";
    }
    return text;
}

const std::string kCore = box("core", {-1, -1, -1}, {1, 1, 1}, 1);
/// Part 1 is inside of part 2, part 3 beside them.
const std::string kBoxes = kCore + box("case", {-2, -2, -2}, {2, 2, 2}, 9) + box("foot", {3, -2, -2}, {4, 0, 2}, 17);

class Files {
public:
    Files() {
        write_contents(folder_.file("tree.gltf"), kTree);
        write_contents(folder_.file("boxes.obj"), kBoxes);
        write_contents(folder_.file("core.obj"), kCore);
    }
    [[nodiscard]] std::string operator()(const std::string& name) const { return folder_.file(name); }

private:
    TemporaryFolder folder_;
};

Json described(const std::string& scene, Strings flags) {
    flags.insert(flags.begin(), {"info", scene, "--json"});
    const Outcome outcome = run(flags);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return Json::parse(outcome.out);
}

/// Numbers of the parts that are drawn.
std::set<int> drawn(const std::string& scene, const Strings& flags) {
    std::set<int> numbers;
    const Json all = described(scene, flags);
    for (const Json& part : all["parts"])
        if (part["drawn"]) numbers.insert(part["number"].get<int>());
    return numbers;
}

/// Light without a colour from the camera's side, no shadows, no highlights.
const Strings kPlain = {
    "--size",     "64x64",       "--camera-position", "3,4,12", "--camera-target", "1,0,0", "--light",   "directional:dir=-0.2,-0.3,-1",
    "--ambient",  "0.2,0.2,0.2", "--exposure",        "0",      "--shadows",       "off",   "--tonemap", "none",
    "--specular", "none"};

Picture drawing(const Files& files, const std::string& scene, const Strings& flags, const Strings& usual = kPlain) {
    Strings all{"render", files(scene), "-o", files("x.png")};
    all.insert(all.end(), usual.begin(), usual.end());
    all.insert(all.end(), flags.begin(), flags.end());
    const Outcome outcome = run(all);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return read_picture(contents(files("x.png")));
}

/// Parts of the boxes in each pixel, also behind each other: a sum of 1 for part 1, 2 for part 2, 4 for part 3.
std::vector<int> parts_in(const Files& files) {
    std::vector<int> out;
    for (const char* part : {"1", "2", "3"}) {
        const Picture picture = drawing(files, "boxes.obj", {"--only", part, "--background", "transparent", "--samples", "1"});
        out.resize(picture.rgba8.size() / 4);
        for (std::size_t i = 0; i < out.size(); ++i)
            if (picture.rgba8[4 * i + 3] != 0) out[i] |= 1 << (part[0] - '1');
    }
    return out;
}

std::string refusal(const std::string& scene, Strings flags) {
    flags.insert(flags.begin(), {"info", scene});
    const Outcome outcome = run(flags);
    CHECK(outcome.code == 2);
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    return outcome.err;
}

}  // namespace

TEST_CASE("parts: names, numbers, patterns and groups mean the parts that they name", "[cli][parts]") {
    const Files files;
    const std::string tree = files("tree.gltf");
    const std::vector<std::pair<std::string, std::set<int>>> cases = {{"rear.1", {2}},
                                                                      {"2", {4}},
                                                                      {"1", {1}},
                                                                      {"6", {6}},
                                                                      {"front.*", {1, 3}},
                                                                      {"*.1", {1, 2}},
                                                                      {"f?ont.2", {3}},
                                                                      {"FRONT.2", {3}},
                                                                      {"R*.1", {2}},
                                                                      {"Rear", {2}},
                                                                      {"Wheels", {1, 2, 3, 4}},
                                                                      {"wheels", {1, 2, 3, 4}},
                                                                      {"a,b*", {6}},
                                                                      {"5,rear.1", {2, 5}},
                                                                      {"?", {4}},
                                                                      {"*", {1, 2, 3, 4, 5, 6}},
                                                                      {"**r**.?", {1, 2, 3}},
                                                                      {"Whe*", {1, 2, 3, 4}}};
    for (const auto& [text, expected] : cases) {
        INFO(text);
        CHECK(drawn(tree, {"--only", text}) == expected);
        std::set<int> others{1, 2, 3, 4, 5, 6};
        for (const int number : expected) others.erase(number);
        if (!others.empty()) CHECK(drawn(tree, {"--hide", text}) == others);
    }
    CHECK(drawn(tree, {"--only", "1", "--only", "2", "--hide", "front.1"}) == std::set<int>{4});
    CHECK(drawn("sphere:500", {"--ghost", "1"}) == std::set<int>{1});
}

TEST_CASE("parts: a name that finds nothing is refused with a near name and the number of parts", "[cli][parts]") {
    const Files files;
    const std::string tree = files("tree.gltf");
    for (const char* flag : {"--only", "--hide", "--ghost", "--highlight"}) {
        const std::string text = refusal(tree, {flag, "frond.1"});
        CHECK(text.find(std::string(flag) + ": expected the name or number of a part, found 'frond.1' (did you mean front.1?); the scene "
                                            "has 6 parts, which halflit info lists") != std::string::npos);
    }
    CHECK(refusal(tree, {"--only", "ront"}).find("(did you mean front.1?)") != std::string::npos);
    for (const char* wrong : {"7", "0", "-1", "x*y", "1,", "1,,2", "1,nothing", ","}) {
        INFO(wrong);
        if (std::string(wrong) == "1,")
            CHECK(drawn(tree, {"--only", wrong}) == std::set<int>{1});
        else
            CHECK(refusal(tree, {std::string("--only=") + wrong}).find("the scene has 6 parts") != std::string::npos);
    }
    CHECK(refusal(tree, {"--hide", "*"}).find("--hide: none of the scene's 6 parts is left") != std::string::npos);
    CHECK(refusal(tree, {"--only", "1", "--hide", "1"}).find("is left") != std::string::npos);
}

TEST_CASE("parts: a part alone is drawn as a file that has it alone", "[cli][parts]") {
    const Files files;
    const Picture alone = drawing(files, "core.obj", {});
    CHECK(drawing(files, "boxes.obj", {"--only", "core"}).rgba8 == alone.rgba8);
    CHECK(drawing(files, "boxes.obj", {"--hide", "2,foot"}).rgba8 == alone.rgba8);
    CHECK(drawing(files, "boxes.obj", {}).rgba8 != alone.rgba8);
    // Without a camera, light or exposure the view and the light are of what is left.
    const Strings usual{"--size", "64x64"};
    CHECK(drawing(files, "boxes.obj", {"--only", "core"}, usual).rgba8 == drawing(files, "core.obj", {}, usual).rgba8);
}

TEST_CASE("parts: a ghost is a layer that shows what lies inside, and the others stay as they are", "[cli][parts]") {
    const Files files;
    const std::vector<int> parts = parts_in(files);
    const Strings one_sample{"--samples", "1"};
    const auto with = [&](Strings flags) {
        flags.insert(flags.end(), one_sample.begin(), one_sample.end());
        return drawing(files, "boxes.obj", flags);
    };
    const Picture usual = with({}), ghost = with({"--ghost", "case"}), core = with({"--only", "core"});
    int inside = 0, foot = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        INFO(i);
        const auto code = [&](const Picture& picture) { return int{picture.rgba8[4 * i]}; };
        if ((parts[i] & 3) == 3) {  // the core is behind the case
            ++inside;
            CHECK(code(ghost) != code(usual));
            CHECK(code(ghost) != code(core));
        } else if (parts[i] == 4 || parts[i] == 0) {
            foot += parts[i] == 4;
            CHECK(code(ghost) == code(usual));
        }
    }
    CHECK(inside > 100);
    CHECK(foot > 20);
    // OBJ's surfaces have two sides, so each ray passes two layers: 255 (1 - (1 - 0.16)^2) = 75.07.
    const Picture layer = with({"--only", "case", "--ghost", "case", "--background", "transparent", "--alpha", "linear"});
    std::set<int> alphas;
    for (std::size_t i = 3; i < layer.rgba8.size(); i += 4) alphas.insert(layer.rgba8[i]);
    CHECK(alphas == std::set<int>{0, 75});
}

TEST_CASE("parts: a highlight has its colour, the others are grey, and no edge moves", "[cli][parts]") {
    const Files files;
    const std::vector<int> parts = parts_in(files);
    Strings flags{"--highlight", "foot", "--highlight-color", "#f00", "--samples", "1", "--background", "transparent"};
    const Picture picture = drawing(files, "boxes.obj", flags);
    std::set<int> reds;
    int others = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::vector<int> pixel(picture.rgba8.begin() + static_cast<std::ptrdiff_t>(4 * i),
                                     picture.rgba8.begin() + static_cast<std::ptrdiff_t>(4 * i + 4));
        INFO(i);
        CHECK((pixel[3] == 255) == (parts[i] != 0));
        if (parts[i] == 4) {
            reds.insert(pixel[0]);
            CHECK((pixel[1] == 0 && pixel[2] == 0));
        } else if (parts[i] != 0 && (parts[i] & 4) == 0) {
            ++others;
            CHECK((pixel[0] == pixel[1] && pixel[1] == pixel[2] && pixel[0] > 0));
        }
    }
    CHECK(reds.size() == 2);  // two sides of the box are seen, each with light of its own
    CHECK(*reds.begin() > 50);
    CHECK(others > 100);
    // A highlight counts more than a ghost.
    flags.insert(flags.end(), {"--ghost", "*"});
    const Picture with_ghosts = drawing(files, "boxes.obj", flags);
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i] == 4) CHECK(with_ghosts.rgba8[4 * i] == picture.rgba8[4 * i]);
}

TEST_CASE("parts: hidden parts are not cut, and caps have the look of their part", "[cli][parts]") {
    const Files files;
    const Strings cut{"--section", "z=0", "--section-hatch", "off", "--highlight", "core", "--highlight-color", "#0f0", "--hide", "foot"};
    Strings reported = cut;
    reported.insert(reported.end(), {"--report", files("r.json")});
    const Picture picture = drawing(files, "boxes.obj", reported);
    const Json report = Json::parse(contents(files("r.json")));
    REQUIRE(report["sections"].size() == 2);
    CHECK(report["sections"][0]["name"] == "core");
    CHECK(report["sections"][0]["area"] == 4.0);
    CHECK(report["sections"][1]["area"] == 16.0);
    // Both caps lie in the plane z = 0. Without the case, that of the core alone is seen.
    Strings alone = cut;
    alone.insert(alone.end(), {"--hide", "case", "--background", "transparent", "--samples", "1"});
    const Picture core = drawing(files, "boxes.obj", alone);
    int green = 0;
    for (std::size_t i = 0; i < core.rgba8.size(); i += 4) {
        green += core.rgba8[i + 3] != 0;
        CHECK((core.rgba8[i] == 0 && core.rgba8[i + 2] == 0));
    }
    CHECK(green > 50);
    CHECK(std::set<int>(picture.rgba8.begin(), picture.rgba8.end()).size() > 2);
}

TEST_CASE("parts: frames of an animation are the pictures of their times, with the same looks", "[cli][parts][film]") {
    const Files files;
    const Bytes arm = Arm(1, Keys::linear).file;
    write_contents(files("arm.glb"), std::string(reinterpret_cast<const char*>(arm.data()), arm.size()));
    // A camera, light and an exposure that do not depend on the pose.
    const Strings looks{"--size",
                        "48x40",
                        "--samples",
                        "1",
                        "--camera-position",
                        "9,7,12",
                        "--camera-target",
                        "0,0,0",
                        "--exposure",
                        "1",
                        "--no-scene-lights",
                        "--env",
                        "sky",
                        "--contact-shadow",  // a film takes it from what leaves the ground
                        "0",
                        "--highlight",
                        "1",
                        "--ghost",
                        "2"};
    Strings film{"render", files("arm.glb"), "--fps", "2", "--frames", "0-2", "-o", files("f_{}.png")};
    film.insert(film.end(), looks.begin(), looks.end());
    REQUIRE(run(film).code == 0);
    int highlighted = 0;
    for (const char* frame : {"0", "1", "2"}) {
        const std::string file = files(std::string("f_") + frame + ".png");
        const Picture still = drawing(files, "arm.glb", {"--time", std::to_string(std::stoi(frame) * 0.5)}, looks);
        INFO(frame);
        CHECK((read_picture(contents(file)).rgba8 == still.rgba8));  // without a list of all bytes
        const Picture blue =
            drawing(files, "arm.glb", {"--time", std::to_string(std::stoi(frame) * 0.5), "--highlight-color", "#00f"}, looks);
        highlighted += blue.rgba8 != still.rgba8;
    }
    CHECK(highlighted > 0);  // the part is hidden in some of the poses
}

TEST_CASE("parts: info lists each part, and measures it where asked", "[cli][parts]") {
    const Files files;
    const Json parts = described(files("boxes.obj"), {"--parts", "--hide", "foot"})["parts"];
    REQUIRE(parts.size() == 3);
    const std::vector<double> sizes[] = {{2, 2, 2}, {4, 4, 4}, {1, 2, 4}};
    for (std::size_t i = 0; i < 3; ++i) {
        INFO(i);
        const Json& part = parts[i];
        const double x = sizes[i][0], y = sizes[i][1], z = sizes[i][2];
        CHECK(part["number"] == i + 1);
        CHECK(part["name"] == std::vector<std::string>{"core", "case", "foot"}[i]);
        CHECK(part["instances"] == 1);
        CHECK(part["triangles"] == 12);
        CHECK(part["drawn"] == (i != 2));
        CHECK(part["measures"] == Json{{"size", sizes[i]},
                                       {"area", 2 * (x * y + y * z + z * x)},
                                       {"volume", x * y * z},
                                       {"watertight", true},
                                       {"open_edges", 0},
                                       {"exact", nullptr}});
    }
    CHECK_FALSE(described(files("boxes.obj"), {})["parts"][0].contains("measures"));
    const std::string text = run({"info", files("boxes.obj"), "--parts", "--hide", "foot"}).out;
    CHECK(text.find("parts:\n  count: 3\n  1: core, 1 instance, 12 triangles, size 2.0 x 2.0 x 2.0, area 24.0, volume 8.0\n") !=
          std::string::npos);
    CHECK(text.find("  3: foot, 1 instance, 12 triangles, not drawn, size 1.0 x 2.0 x 4.0, area 28.0, volume 8.0\n") != std::string::npos);
    const std::string tree = run({"info", files("tree.gltf"), "--parts"}).out;
    CHECK(tree.find("  5: (no name), 1 instance, 1 triangle, size 1.0 x 2.0 x 0.0, area 1.0, 3 open edges\n") != std::string::npos);
}

TEST_CASE("parts: text lists the first hundred, JSON all of them", "[cli][parts]") {
    const TemporaryFolder folder;
    std::string many = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 1; i <= 123; ++i) many += "o part" + std::to_string(i) + "\nf 1 2 3\n";
    write_contents(folder.file("many.obj"), many);
    CHECK(described(folder.file("many.obj"), {})["parts"].size() == 123);
    const std::string text = run({"info", folder.file("many.obj")}).out;
    CHECK(text.find("  count: 123\n") != std::string::npos);
    CHECK(text.find("  100: part100, 1 instance, 1 triangle\n  more: 23, which --json lists\n") != std::string::npos);
}

TEST_CASE("parts: a truck's wheels are two parts of one name", "[cli][parts]") {
    const auto assets = asset_dir();
    if (!assets) HALFLIT_SKIP("no large models");
    const std::string truck = (*assets / "models/CesiumMilkTruck/CesiumMilkTruck.glb").string();
    CHECK(drawn(truck, {"--only", "Wheels"}) == std::set<int>{2, 3});
    CHECK(drawn(truck, {"--only", "wheels", "--hide", "3"}) == std::set<int>{2});
    const Files files;
    Strings flags{"render", truck, "-o", files("t.png"), "--size", "64", "--report", files("t.json"), "--only", "Wheels"};
    REQUIRE(run(flags).code == 0);
    CHECK(Json::parse(contents(files("t.json")))["triangles_submitted"] == 2 * 768);
}
