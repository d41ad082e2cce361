// The command line as users type it: scenes without a command, pictures without a flag, folders, terminals.
#include "tests/cli/program.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <algorithm>
#include <cstdlib>

using namespace halflit::test;

namespace {

/// Pixels that differ from the one in the corner.
std::size_t pixels_drawn(const Picture& picture) {
    std::size_t drawn = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) drawn += picture.pixel(x, y) != picture.pixel(0, 0);
    return drawn;
}

Picture drawn(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"-q", "-o", "-"});
    const Outcome outcome = run(arguments);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return read_picture(outcome.out);
}

}  // namespace

TEST_CASE("command line: a scene without a command is rendered", "[cli]") {
    const TemporaryFolder folder;
    write_triangle(folder.file("triangle.gltf"));
    const std::string expected = run({"render", folder.file("triangle.gltf"), "--size", "20x20", "-o", "-"}).out;
    REQUIRE(!expected.empty());
    const RunSettings here{.folder = folder.path()};
    CHECK(run({"triangle.gltf", "--size", "20", "-o", "-"}, here).out == expected);
    CHECK(run({"--size", "20", "triangle.gltf", "-o", "-"}, here).out == expected);
    CHECK(run({"-o", "-", "--size=20", "triangle.gltf"}, here).out == expected);
    CHECK(run({"-", "--size", "20", "-o", "-"}, {.input = contents(folder.file("triangle.gltf"))}).out == expected);
    CHECK(run({"sphere:500", "--size", "20", "-o", "-"}).out == run({"render", "sphere:500", "--size", "20x20", "-o", "-"}).out);
    CHECK(run({"triangle.gltf", "out.png", "--size", "20"}, here).code == 0);
    CHECK(contents(folder.file("out.png")) == expected);
    CHECK(run({"render", "--size", "20", "triangle.gltf", "second.PNG"}, here).code == 0);
    CHECK(contents(folder.file("second.PNG")) == expected);
    CHECK(folder.names() == std::vector<std::string>{"out.png", "second.PNG", "triangle.gltf"});
}

TEST_CASE("command line: what people type is answered with what to type", "[cli]") {
    const TemporaryFolder folder;
    write_triangle(folder.file("triangle.gltf"));
    std::filesystem::create_directory(folder.file("empty"));
    const RunSettings here{.folder = folder.path()};
    struct Row {
        std::vector<std::string> arguments;
        int code;
        const char* message;
    };
    const Row rows[] = {
        {{"https://example.invalid/duck.glb"}, 2, "curl -L 'https://example.invalid/duck.glb' | halflit -"},
        {{"empty"}, 2, "empty: is a folder without models"},
        {{"."}, 2, ".: stands for one model: expected -o FOLDER/"},
        {{".", "-o", "one.png"}, 2, "one.png is one picture: expected -o FOLDER/"},
        {{"file:///a/b.glb"}, 2, "expected the file's path: /a/b.glb"},
        {{"triangle.gltf", "a.png", "b.png"}, 2, "two pictures are named, a.png and b.png"},
        {{"triangle.gltf", "-o", "a.png", "-o", "b.png"}, 2, "--output: expected once, found 2 times"},
        {{"triangle.gltf", "--size"}, 2, "--size: expected WxH after it, found nothing"},
        {{"triangle.gltf", "-size", "9"}, 2, "did you mean --size?"},
        {{"TRIANGLE.GLTF"}, 4, "did you mean triangle.gltf?"},
        {{"compare", "triangle.gltf", "triangle.gltf", "-o", "c.png"}, 2, "expected a folder, found 'c.png'"},
        {{"compare", "triangle.gltf"}, 2, "expected B, found nothing"},
        {{"lobe"}, 2, "expected MODEL, found nothing"},
    };
    for (const Row& row : rows) {
        const Outcome outcome = run(row.arguments, here);
        INFO(outcome.err);
        CHECK(outcome.code == row.code);
        CHECK(contains(outcome.err, row.message));
    }
    CHECK(folder.names() == std::vector<std::string>{"empty", "triangle.gltf"});
    CHECK(contains(run({"triangle.gltf", "--turntable", "2", "--size", "16"}, here).err, "-o film.gif"));
}

TEST_CASE("command line: a folder and a pattern stand for their models", "[cli][many]") {
    const TemporaryFolder folder;
    for (const char* const name : {"a.gltf", "B.GLTF", "notes.txt"}) write_triangle(folder.file(name));
    const RunSettings here{.folder = folder.path()};
    CHECK(run({".", "-o", "all", "--size", "16"}, here).code == 0);
    CHECK(run({"*.gltf", "-o", "fit/", "--size", "16"}, here).code == 0);
    for (const char* const name : {"all/a.png", "all/B.png", "fit/a.png", "fit/B.png"}) CHECK(std::filesystem::exists(folder.file(name)));
    CHECK(!std::filesystem::exists(folder.file("all/notes.png")));
}

TEST_CASE("command line: many pictures are told of in one line, and a list is not overwritten", "[cli][many]") {
    const TemporaryFolder folder;
    const RunSettings here{.folder = folder.path()};
    std::string list;
    for (int i = 0; i < 21; ++i) list += "sphere:200\n";
    write_contents(folder.file("list.png"), list);
    const Outcome many = run({"--files-from", "list.png", "-o", "{index}.png", "--size", "8"}, here);
    CHECK(many.code == 0);
    CHECK(many.err == "halflit: wrote 21 pictures, 0.png to 20.png\n");
    const Outcome refused = run({"--files-from", "list.png", "-o", "list.png"}, here);
    CHECK(refused.code == 2);
    CHECK(contains(refused.err, "is not overwritten"));
    CHECK(contents(folder.file("list.png")) == list);
}

TEST_CASE("command line: several scenes go into a folder, and one that fails does not stop the others", "[cli]") {
    const TemporaryFolder folder;
    const RunSettings here{.folder = folder.path()};
    const Outcome outcome = run({"render", "sphere:500", "missing.glb", "lights:2", "-o", "new/out/", "--size", "16"}, here);
    CHECK(outcome.code == 4);
    CHECK(contains(outcome.err, "missing.glb: cannot be opened"));
    CHECK(std::filesystem::exists(folder.file("new/out/sphere.png")));
    CHECK(std::filesystem::exists(folder.file("new/out/lights.png")));
    CHECK(run({"sphere:500", "-o", "one/", "--size", "16"}, here).err == "halflit: wrote one/sphere.png\n");
    CHECK(contains(run({"render", "sphere:12", "sphere:13", "-o", "new/"}, here).err,
                   "sphere:13: sphere:12 has the same picture new/sphere.png"));
}

TEST_CASE("command line: quiet leaves errors alone, verbose says what was chosen", "[cli]") {
    const TemporaryFolder folder;
    const std::vector<std::string> scene = {"render",       "sphere:500",  "--size", "16",
                                            "--background", "transparent", "-o",     folder.file("a.jpg")};
    const auto with = [&](const char* flag) {
        std::vector<std::string> arguments = scene;
        arguments.emplace_back(flag);
        return run(arguments).err;
    };
    CHECK(contains(run(scene).err, "halflit: warning: " + folder.file("a.jpg") + ": this format has no transparency"));
    CHECK(with("-q").empty());
    CHECK(with("--quiet").empty());
    for (const char* part :
         {"transparency", "camera: the file's, front", "exposure: 1, +0.00 stops", "lights: 2", "16x16", "ms: load", "wrote"})
        CHECK(contains(with("-v"), part));
    CHECK(run({"render", "missing.glb", "-q"}).err.starts_with("halflit: error: "));
    CHECK(
        !contains(run({"render", "sphere:500", "--size", "16", "--background", "transparent", "-o", folder.file("a.png")}).err, "warning"));
}

TEST_CASE("command line: flags of messages may come before the scene, too", "[cli]") {
    const TemporaryFolder folder;
    const Outcome outcome = run({"-q", "sphere:500", "--size", "8", "-o", folder.file("a.png")});
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
}

TEST_CASE("command line: a folder that is missing is found before the scene is read", "[cli]") {
    const TemporaryFolder folder;
    const Outcome outcome = run({"render", "missing.glb", "-o", folder.file("no/a.png")});
    CHECK(outcome.code == 4);
    CHECK(contains(outcome.err, "no/a.png: the folder " + folder.file("no/") + ": No such file or directory"));
}

TEST_CASE("command line: more threads than cores may be asked for", "[cli]") {
    const TemporaryFolder folder;
    const Outcome outcome = run({"sphere:500", folder.file("a.png"), "--size", "64", "--threads", "33", "--report", "-"});
    CHECK(outcome.code == 0);
    CHECK(outcome.err == "halflit: wrote " + folder.file("a.png") + "\n");
    const auto threads = nlohmann::json::parse(outcome.out)["threads"].get<int>();
    CHECK(threads >= 1);
    CHECK(threads <= 33);
}

TEST_CASE("camera: frame sees the whole scene, whatever the file's camera", "[cli][camera]") {
    CHECK(drawn({"sphere:500", "--size", "40", "--camera", "frame"}).rgba8 ==
          drawn({"sphere:500", "--size", "40", "--azimuth", "35"}).rgba8);
    CHECK(drawn({"sphere:500", "--size", "40", "--camera", "frame"}).rgba8 != drawn({"sphere:500", "--size", "40"}).rgba8);
}

TEST_CASE("camera: placed on the axis of a sphere, it sees as much of it as the angle says", "[cli][camera]") {
    // From distance d a sphere of radius 1 has the angular radius asin(1 / d), so its picture has the radius tan(asin(1 / d)) / tan(fov /
    // 2) in half pictures: 0.5 for d = 2.2361 = sqrt(5) and 90 degrees.
    const Picture picture =
        drawn({"sphere:20000", "--size", "200", "--camera-position", "0,0,2.2360680", "--fov", "90", "--contact-shadow", "0"});
    const double expected = 3.14159265 * 50 * 50;
    CHECK(static_cast<double>(pixels_drawn(picture)) == Approx(expected).epsilon(0.03));  // measured 1 %: partly covered pixels count
    const Picture aside =
        drawn({"sphere:20000", "--size", "200", "--camera-position", "0,0,2.2360680", "--camera-target", "9,0,2.2360680"});
    CHECK(pixels_drawn(aside) == 0);
    // From inside, back faces are culled and the near plane is not behind the camera.
    CHECK(drawn({"sphere:500", "--size", "20", "--camera-position", "0,0,0"}).width == 20);
}

TEST_CASE("camera: bounds are the file's whatever axis points up, and views go by it", "[cli][camera]") {
    const TemporaryFolder folder;
    write_triangle(folder.file("t.gltf"));  // in the plane of x and y; its front looks along +z
    const std::vector<std::pair<std::string, std::string>> cases = {{"y", "front"},  {"-y", "back"}, {"x", "front"},
                                                                    {"-x", "front"}, {"z", "top"},   {"-z", "bottom"}};
    for (const auto& [axis, side] : cases) {
        INFO(axis);
        const auto info = nlohmann::json::parse(run({"info", folder.file("t.gltf"), "--up", axis, "--json"}).out);
        CHECK(info["bounds"]["min"] == std::vector<double>{0, 0, 0});
        CHECK(info["bounds"]["max"] == std::vector<double>{1, 2, 0});
        for (const char* view : {"front", "back", "top", "bottom"}) {
            const Picture seen = drawn({folder.file("t.gltf"), "--size", "20", "--view", view, "--up", axis, "--contact-shadow", "0",
                                        "--background", "transparent"});
            CHECK((pixels_drawn(seen) > 0) == (view == side));
        }
    }
    CHECK(run({"info", folder.file("t.gltf"), "--up=+Z"}).out == run({"info", folder.file("t.gltf"), "--up", "z"}).out);
}

TEST_CASE("camera: a scene turned with its camera and lights gives the same picture", "[cli][camera]") {
    // Quarter turns are exact, and the environment's absence leaves no direction that is not turned.
    const std::vector<int> upright = drawn({"sphere:2000", "--size", "60"}).pixel(30, 20);
    for (const char* axis : {"x", "z", "-x", "-y", "-z"}) {
        INFO(axis);
        const std::vector<int> pixel = drawn({"sphere:2000", "--size", "60", "--up", axis}).pixel(30, 20);
        for (std::size_t c = 0; c < 4; ++c) CHECK(std::abs(pixel[c] - upright[c]) <= 1);  // sums in another order
    }
}

TEST_CASE("terminal: errors are coloured there and nowhere else, unless NO_COLOR is set", "[cli][terminal]") {
    if (!abilities().terminals) HALFLIT_SKIP("no terminal without a screen here");
    const std::string red = "halflit: \x1b[1;31merror\x1b[0m: ";
    CHECK(run({"rendr"}, {.terminal_columns = 80}).out.starts_with(red));
    CHECK(run({"rendr"}, {.environment = {{"NO_COLOR", "1"}}, .terminal_columns = 80}).out.starts_with("halflit: error: "));
    CHECK(run({"rendr"}, {.environment = {{"TERM", "dumb"}}, .terminal_columns = 80}).out.starts_with("halflit: error: "));
    CHECK(run({"rendr"}).err.starts_with("halflit: error: "));
}

TEST_CASE("terminal: the program alone prints its help there", "[cli][terminal]") {
    if (!abilities().terminals) HALFLIT_SKIP("no terminal without a screen here");
    const Outcome outcome = run({}, {.terminal_columns = 80});
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.out, "Usage: halflit SCENE"));
}

TEST_CASE("terminal: a short run shows no progress, and a quiet one none at all", "[cli][terminal]") {
    if (!abilities().terminals) HALFLIT_SKIP("no terminal without a screen here");
    const TemporaryFolder folder;
    CHECK(!contains(run({"sphere:500", folder.file("a.png"), "--size", "16"}, {.terminal_columns = 80}).out, "%"));
    // 16 million pixels of 8 samples by the scalar kernels take seconds.
    const std::vector<std::string> slow = {"sphere:500", folder.file("a.png"), "--size", "4000", "--samples", "8", "--isa",
                                           "scalar",     "--threads",          "1"};
    std::vector<std::string> quiet = slow;
    quiet.emplace_back("-q");
    CHECK(contains(run(slow, {.terminal_columns = 80}).out, " %"));
    CHECK(run(quiet, {.terminal_columns = 80}).out.empty());
}
