// Many scenes in one run: each has the picture that it has alone, a bad one does not stop the others, and what is there can be kept.
#include "tests/cli/program.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <filesystem>
#include <sstream>

using namespace halflit::test;

namespace {

std::string name_of(std::size_t i) {
    std::string name = std::to_string(i);
    return name.insert(0, 1, 'm');
}

}  // namespace

TEST_CASE("many: each scene has the picture that it has alone, and reports come in the order of the scenes", "[cli][many]") {
    const TemporaryFolder folder;
    const RunSettings here{.folder = folder.path()};
    std::vector<std::string> words{"render"};
    for (std::size_t i = 0; i < 40; ++i) {
        words.push_back(name_of(i) + ".gltf");
        if (i == 17)
            write_contents(folder.file(words.back()), "{\"asset\":");
        else
            write_triangle(folder.file(words.back()), std::to_string(1 + i) + ",1,1");
    }
    words.insert(words.end(), {"-o", "new/{stem}-{index:03}.png", "--size", "24x16", "--report", "lines.json", "--threads", "3"});
    const Outcome outcome = run(words, here);
    INFO(outcome.err);
    CHECK(outcome.code == 3);
    CHECK(outcome.err.starts_with("halflit: error: m17.gltf: "));
    CHECK(outcome.err.ends_with("\nhalflit: wrote 39 pictures, new/m0-000.png to new/m39-039.png; 1 could not be drawn, see above\n"));
    const auto lines = json_lines(contents(folder.file("lines.json")));
    REQUIRE(lines.size() == 40);
    for (std::size_t i = 0; i < 40; ++i) {
        const std::string name = name_of(i);
        CHECK(lines[i]["scene"] == name + ".gltf");
        CHECK(lines[i]["status"] == (i == 17 ? "error" : "ok"));
        const std::string digits = std::to_string(1000 + i).substr(1), picture = folder.file("new/" + name + "-" + digits + ".png");
        CHECK(std::filesystem::exists(picture) == (i != 17));
        if (i % 13 == 0) CHECK(contents(picture) == run({"render", name + ".gltf", "--size", "24x16", "-o", "-"}, here).out);
    }
    // Large pictures, which all threads draw, among small ones.
    const Outcome large = run({"render", "sphere:500", "m1.gltf", "lights:3", "--size", "2048x1024", "--out-dir", "large", "-q"}, here);
    CHECK(large.code == 0);
    CHECK(contents(folder.file("large/m1.png")) == run({"m1.gltf", "--size", "2048x1024", "-o", "-"}, here).out);
}

TEST_CASE("many: scenes are read from a list, and pictures that are there can be kept", "[cli][many]") {
    const TemporaryFolder folder;
    const RunSettings here{.folder = folder.path()};
    write_contents(folder.file("list.txt"), "sphere:500\r\n\nlights:2\n");
    std::vector<std::string> words{"render", "--files-from", "list.txt", "--out-dir", "out", "--size", "16", "-q"};
    CHECK(run(words, here).code == 0);
    const std::string sphere = contents(folder.file("out/sphere.png")), lights = contents(folder.file("out/lights.png"));
    write_contents(folder.file("out/sphere.png"), "mine");
    std::filesystem::remove(folder.file("out/lights.png"));
    words.insert(words.end(), {"--skip-existing", "--report", "-"});
    const auto lines = json_lines(run(words, here).out);
    REQUIRE(lines.size() == 2);
    CHECK(lines[0]["status"] == "skipped");
    CHECK(lines[1]["status"] == "ok");
    CHECK(contents(folder.file("out/sphere.png")) == "mine");
    CHECK(contents(folder.file("out/lights.png")) == lights);
    words.erase(std::find(words.begin(), words.end(), "-q"));
    CHECK(run(words, here).err == "halflit: nothing to do: all 2 pictures are there\n");
    // A list from standard input; without --skip-existing all is drawn anew.
    CHECK(
        run({"render", "--files-from", "-", "-o", "out/", "--size", "16", "-q"}, {.input = "sphere:500\n", .folder = folder.path()}).code ==
        0);
    CHECK(contents(folder.file("out/sphere.png")) == sphere);
}

TEST_CASE("many: pictures in which nothing is seen are named", "[cli][many]") {
    const TemporaryFolder folder;
    const RunSettings here{.folder = folder.path()};
    write_triangle(folder.file("seen.gltf"), "1,1,1");
    write_contents(folder.file("empty.gltf"), R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{}]})");
    const Outcome outcome = run({"render", "seen.gltf", "empty.gltf", "-o", "./", "--size", "16", "--blank-check", "--report", "-"}, here);
    CHECK(outcome.code == 1);
    CHECK(contains(outcome.err, "halflit: warning: empty.gltf: nothing is seen in its picture"));
    const auto lines = json_lines(outcome.out);
    REQUIRE(lines.size() == 2);
    CHECK_FALSE(lines[0].contains("blank"));
    CHECK(lines[1]["blank"] == true);
    CHECK(run({"seen.gltf", "--size", "16", "-o", "a.png", "--blank-check"}, here).code == 0);
    CHECK(run({"seen.gltf", "--size", "16", "-o", "a.png", "--blank-check", "--camera-position", "9,9,9", "--camera-target", "20,20,20"},
              here)
              .code == 1);
    CHECK(run({"empty.gltf", "--size", "16", "-o", "a.png"}, here).code == 0);
}

TEST_CASE("many: names that cannot be pictures are refused before anything is drawn", "[cli][many]") {
    const TemporaryFolder folder;
    const RunSettings here{.folder = folder.path()};
    const auto error = [&](std::vector<std::string> words) {
        words.insert(words.begin(), "render");
        const Outcome outcome = run(words, here);
        CHECK(outcome.code == 2);
        return outcome.err;
    };
    CHECK(contains(error({"sphere:9", "lights:1", "-o", "{name}.png"}), "expected {stem}, {folder}, {index} or {index:04}, found {name}"));
    CHECK(contains(error({"sphere:9", "lights:1", "-o", "{stem.png"}), "found {stem.png"));
    CHECK(contains(error({"sphere:9", "lights:1", "-o", "one.png"}), "several scenes need -o FOLDER/"));
    CHECK(contains(error({"sphere:9", "lights:1", "-o", "{index:x}.png"}), "found {index:x}"));
    CHECK(contains(error({"sphere:9", "-o", "a.png", "--skip-existing"}), "--skip-existing: expected a folder"));
    CHECK(contains(error({"sphere:9", "-o", "a.png", "--out-dir", "b"}), "--out-dir: cannot be combined with -o"));
    CHECK(contains(error({"sphere:9", "lights:1", "-o", "{stem}.png", "--report", "lights.png"}), "--report: expected another file"));
    CHECK(contains(error({"sphere:9", "-o", "a", "--format", "gif"}), "expected png, bmp, tga, jpg, webp, hdr, pfm or exr, found 'gif'"));
    CHECK(folder.names().empty());
}

TEST_CASE("many: file managers' thumbnailers get a PNG of any name", "[cli][many]") {
    // The line of the entry, as a file manager fills it in.
    const std::string entry = contents(std::string(HALFLIT_SOURCE_DIR) + "/cmake/desktop/halflit.thumbnailer");
    const std::size_t at = entry.find("Exec=halflit ", entry.find("TryExec=") + 8) + 13;
    const TemporaryFolder folder;
    write_triangle(folder.file("a model.gltf"), "1,1,1");
    std::istringstream line(entry.substr(at, entry.find('\n', at) - at));
    std::vector<std::string> words;
    for (std::string word; line >> word;)
        words.push_back(word == "%i"   ? folder.file("a model.gltf")
                        : word == "%o" ? folder.file("thumbnail.X7a")
                        : word == "%s" ? "48"
                                       : word);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    HALFLIT_SKIP("sanitizers take terabytes of addresses");
#endif
    const Outcome outcome = run(words);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(outcome.err.empty());
    const Picture picture = read_picture(contents(folder.file("thumbnail.X7a")));
    CHECK(picture.width == 48);
    CHECK(picture.height == 48);
    CHECK(picture.pixel(0, 0) != picture.pixel(24, 24));
    write_contents(folder.file("a model.gltf"), "no model");
    CHECK(run(words).code == 3);
}
