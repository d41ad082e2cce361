// The program's window, driven without a person: by SDL's own display that shows nothing, or by the display that
// HALFLIT_WINDOW_DRIVER names (x11 under Xvfb).
#include "tests/cli/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <set>

using namespace halflit::test;

namespace {

using Json = nlohmann::json;

Outcome view(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "view");
    const char* const driver = std::getenv("HALFLIT_WINDOW_DRIVER");
    RunSettings settings;
    settings.environment = {{"SDL_VIDEODRIVER", driver != nullptr ? driver : "dummy"}};
    return run(arguments, settings);
}

/// Different colours in a part of a picture.
std::size_t colors(const Picture& picture, int left, int right) {
    std::set<std::vector<int>> found;
    for (int y = 0; y < picture.height; ++y)
        for (int x = left; x < right; ++x) found.insert(picture.pixel(x, y));
    return found.size();
}

bool lacks_libraries(const Outcome& outcome) { return outcome.code == 2 && outcome.err.find("needs the librar") != std::string::npos; }

}  // namespace

TEST_CASE("window: an orbit is drawn, measured and shown with the panel", "[viewer][window]") {
    const TemporaryFolder folder;
    const Outcome outcome = view({"sphere:20000", "--size", "320x240", "--orbit", "20", "--click", "160,120", "--screenshot",
                                  folder.file("window.png"), "--report", "-"});
    if (lacks_libraries(outcome)) HALFLIT_SKIP("no SDL2 or Dear ImGui: " + outcome.err);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const Json report = Json::parse(outcome.out);
    INFO(report.dump(2));
    CHECK(report["size"] == Json({320, 240}));
    CHECK(report["frames"] == 20);
    CHECK(report["median_ms"] > 0);
    CHECK(report["worst_ms"] >= report["median_ms"]);
    CHECK(report["frames_per_second"] > 0);
    CHECK(report["pixel"]["surface"]["material"] == "clay");
    CHECK(report["pixel"]["lights"].size() == 2);
    const Picture window = read_picture(contents(folder.file("window.png")));
    REQUIRE(window.width > 320);
    REQUIRE(window.height == 240);
    CHECK(colors(window, 0, 320) > 200);                                   // the shaded sphere
    CHECK(colors(window, 320, window.width) > 10);                         // the panel
    CHECK(window.pixel(2, 2) == std::vector<int>{0x2c, 0x30, 0x36, 255});  // the usual background
}

TEST_CASE("window: at rest it shows the pixels of render", "[viewer][window]") {
    const TemporaryFolder folder;
    const std::vector<std::string> flags{"demo", "--size", "200x150", "--lobe", "valve", "--env", "studio"};
    std::vector<std::string> shown = flags, drawn = flags;
    shown.insert(shown.end(), {"--screenshot", folder.file("window.png")});
    const Outcome outcome = view(shown);
    if (lacks_libraries(outcome)) HALFLIT_SKIP("no SDL2 or Dear ImGui: " + outcome.err);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    drawn.insert(drawn.begin(), "render");
    drawn.insert(drawn.end(), {"-o", folder.file("picture.png")});
    REQUIRE(run(drawn).code == 0);
    const Picture window = read_picture(contents(folder.file("window.png"))), picture = read_picture(contents(folder.file("picture.png")));
    int different = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) different += window.pixel(x, y) != picture.pixel(x, y);
    CHECK(different == 0);
}

TEST_CASE("window: wrong flags and missing displays are one line", "[viewer][window]") {
    const Outcome outcome = view({"demo", "--size", "64x64", "--click", "64,2"});
    if (lacks_libraries(outcome)) HALFLIT_SKIP("no SDL2 or Dear ImGui: " + outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.err == "halflit: error: --click: expected a pixel of the 64x64 picture\n");
    CHECK(view({"demo", "--click", "a,2"}).code == 2);
    CHECK(view({"demo", "--tab", "plam"}).err.find("did you mean plan?") != std::string::npos);
    RunSettings settings;
    settings.environment = {{"SDL_VIDEODRIVER", "no-such-driver"}};
    const Outcome nothing = run({"view", "sphere:12", "--report", "-"}, settings);
    CHECK(nothing.code == 2);
    CHECK(nothing.err.find("halflit: error: view: no display: ") == 0);
    CHECK(nothing.out.empty());
}
