#include "tests/cli/program.hpp"
#include "tests/cli/small_models.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <filesystem>

using namespace halflit::test;

namespace {

using Json = nlohmann::json;

void write_list(const TemporaryFolder& folder, const std::vector<std::string>& flags) {
    const Json scene{{"name", "m"}, {"scene", "m.stl"}, {"flags", flags}};
    write_contents(folder.file("golden.json"), Json{{"schema", "halflit.golden-list/1"}, {"scenes", {scene}}}.dump());
}

struct Change {
    double share = 0;
    std::string camera;
};

/// The only scene's pixels that differ.
Change changed(const TemporaryFolder& folder) {
    const Outcome outcome = run({"golden", "check", folder.path(), "--json"});
    const Json report = Json::parse(outcome.out, nullptr, false);
    INFO(outcome.err);
    REQUIRE(!report.is_discarded());
    const Json& scene = report["scenes"][0];
    const double share = scene.contains("difference") ? scene["difference"]["share_above"].get<double>() : 0.0;
    return {share, scene["camera"].get<std::string>()};
}

const std::vector<std::string> kFlags{"--size", "160x120"};

}  // namespace

TEST_CASE("golden: a spike changes its own pixels, because the camera was recorded", "[cli][golden]") {
    // The spike's share of the picture is about 2 %. Framed anew, the whole sphere would be smaller: 40 % of the pixels.
    // The whole scene hides the sky from a surface or from the ground, so such shadows are left out.
    const std::vector<std::string> views[] = {{}, {"--view", "front", "--ortho"}, {"--view", "top"}, {"--view", "iso", "--fit", "4"}};
    for (const std::vector<std::string>& view : views) {
        const TemporaryFolder folder;
        std::vector<std::string> flags = kFlags;
        flags.insert(flags.end(), view.begin(), view.end());
        flags.insert(flags.end(), {"--sky-shadows", "0", "--contact-shadow", "0"});
        INFO(Json(flags).dump());
        write_list(folder, flags);
        write_contents(folder.file("m.stl"), stl_of(sphere_with_spike(1)));
        REQUIRE(run({"golden", "update", folder.path()}).code == 0);
        REQUIRE(std::filesystem::exists(folder.file("cameras.txt")));
        write_contents(folder.file("m.stl"), stl_of(sphere_with_spike(1.6)));
        const Change kept = changed(folder);
        CHECK(kept.camera == "recorded");
        CHECK(kept.share > 0.001);
        CHECK(kept.share < 0.035);
        std::filesystem::remove(folder.file("cameras.txt"));
        const Change framed = changed(folder);
        CHECK(framed.camera == "framed");
        CHECK(framed.share > 0.3);
    }
}

TEST_CASE("golden: a recorded camera draws the pixels that render draws", "[cli][golden]") {
    const TemporaryFolder folder;
    write_list(folder, kFlags);
    write_contents(folder.file("m.stl"), stl_of(sphere_with_spike(1.3)));
    REQUIRE(run({"golden", "update", folder.path()}).code == 0);
    CHECK(contents(folder.file("m.png")) == run({"render", folder.file("m.stl"), "--size", "160x120", "-o", "-"}).out);
    CHECK(run({"golden", "check", folder.path()}).code == 0);
}

TEST_CASE("golden: update keeps the camera unless --reframe, and other flags get another camera", "[cli][golden]") {
    const TemporaryFolder folder;
    write_list(folder, kFlags);
    write_contents(folder.file("m.stl"), stl_of(sphere_with_spike(1)));
    REQUIRE(run({"golden", "update", folder.path()}).code == 0);
    const std::string first = contents(folder.file("cameras.txt"));
    write_contents(folder.file("m.stl"), stl_of(sphere_with_spike(2)));
    REQUIRE(run({"golden", "update", folder.path()}).code == 0);
    CHECK(contents(folder.file("cameras.txt")) == first);
    const std::string kept = contents(folder.file("m.png"));
    REQUIRE(run({"golden", "update", folder.path(), "--reframe"}).code == 0);
    CHECK(contents(folder.file("cameras.txt")) != first);
    const std::string framed = run({"render", folder.file("m.stl"), "--size", "160x120", "-o", "-"}).out;
    CHECK(kept != framed);
    CHECK(contents(folder.file("m.png")) == framed);
    write_list(folder, {"--size", "160x120", "--azimuth", "80"});
    CHECK(changed(folder).camera == "framed");
    REQUIRE(run({"golden", "update", folder.path()}).code == 0);
    CHECK(contents(folder.file("m.png")) == run({"render", folder.file("m.stl"), "--size", "160x120", "--azimuth", "80", "-o", "-"}).out);
    CHECK(run({"golden", "check", folder.path(), "--reframe"}).code == 2);
}

TEST_CASE("golden: a spike that reaches beyond the recorded near plane is drawn whole", "[cli][golden]") {
    // Seen along the spike its tip hides the sphere's middle. A near plane that cut it off would show the inside.
    for (const char* const rays : {"--ortho", "--fov=35"}) {
        const TemporaryFolder folder;
        write_list(folder, {"--size", "160x120", "--view", "right", rays});
        write_contents(folder.file("m.stl"), stl_of(sphere_with_spike(1)));
        REQUIRE(run({"golden", "update", folder.path()}).code == 0);
        write_contents(folder.file("m.stl"), stl_of(sphere_with_spike(2.9)));
        REQUIRE(run({"golden", "check", folder.path(), "-o", folder.file("out")}).code == 1);
        const Picture picture = read_picture(contents(folder.file("out/m-actual.png")));
        const Picture before = read_picture(contents(folder.file("out/m-expected.png")));
        // Around the spike's axis there is a surface, not the background of the corner.
        INFO(rays);
        CHECK(picture.pixel(80, 60) != picture.pixel(0, 0));
        CHECK(picture.pixel(80, 60) != before.pixel(80, 60));
    }
}

TEST_CASE("golden: a camera of flags or of the file is not recorded", "[cli][golden]") {
    const TemporaryFolder folder;
    write_list(folder, {"--size", "32x18", "--camera-position", "1,2,3"});
    write_contents(folder.file("m.stl"), stl_of(sphere_with_spike(1)));
    REQUIRE(run({"golden", "update", folder.path()}).code == 0);
    CHECK(!std::filesystem::exists(folder.file("cameras.txt")));
    CHECK(changed(folder).camera == "given");
}

TEST_CASE("golden: a faulty cameras.txt is refused with its line", "[cli][golden]") {
    const TemporaryFolder folder;
    write_list(folder, kFlags);
    write_contents(folder.file("m.stl"), stl_of(sphere_with_spike(1)));
    REQUIRE(run({"golden", "update", folder.path()}).code == 0);
    const std::string sound = contents(folder.file("cameras.txt"));
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = sound;
        text.replace(text.find(from), from.size(), to);
        return text;
    };
    for (const std::string& text : {with(" eye=", " eye=nan,"), with(" near=", " far="), with(" right=", " right=1e99,"),
                                    with("  m ", "  m"), sound + sound, with("\n", "\nx\n"), with(" point_size=", " more=1 point_size=")}) {
        write_contents(folder.file("cameras.txt"), text);
        const Outcome outcome = run({"golden", "check", folder.path()});
        INFO(text);
        CHECK(outcome.code == 3);
        CHECK(outcome.err.find("cameras.txt: line ") != std::string::npos);
    }
}
