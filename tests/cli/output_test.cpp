#include "tests/cli/program.hpp"

#include "apps/io/pictures/float_image.hpp"
#include "halflit/image.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace halflit::test;

namespace {

const std::string kOld = "the old file";

std::vector<std::string> small(const std::string& output) { return {"render", "sphere:500", "--size", "40x30", "-o", output}; }

}  // namespace

TEST_CASE("output: - is PNG on standard output, and nothing else is", "[cli]") {
    const Outcome outcome = run(small("-"));
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    const Picture picture = read_picture(outcome.out);
    CHECK(picture.width == 40);
    CHECK(picture.height == 30);
}

TEST_CASE("output: without -o the file is named after the scene, and is the same as standard output", "[cli]") {
    const TemporaryFolder folder;
    const Outcome outcome = run({"render", "sphere:500", "--size", "40x30"}, {.folder = folder.path()});
    CHECK(outcome.code == 0);
    CHECK(outcome.out.empty());
    CHECK(outcome.err == "halflit: wrote sphere.png\n");
    CHECK(folder.names() == std::vector<std::string>{"sphere.png"});
    CHECK(contents(folder.file("sphere.png")) == run(small("-")).out);
}

TEST_CASE("output: each format begins with its own mark", "[cli]") {
    const TemporaryFolder folder;
    for (const auto& [name, mark] : std::vector<std::pair<std::string, std::string>>{
             {"a.png", "\x89PNG"}, {"a.JPG", "\xff\xd8\xff"}, {"a.jpeg", "\xff\xd8\xff"}, {"a.bmp", "BM"}, {"a.hdr", "#?RADIANCE"}}) {
        INFO(name);
        CHECK(run(small(folder.file(name))).code == 0);
        CHECK(contents(folder.file(name)).starts_with(mark));
    }
    CHECK(run(small(folder.file("a.tga"))).code == 0);
    const std::string tga = contents(folder.file("a.tga"));
    REQUIRE(tga.size() > 18);  // no mark: 40 x 30 at fixed places in the header
    CHECK(static_cast<int>(tga[12]) == 40);
    CHECK(static_cast<int>(tga[14]) == 30);
}

TEST_CASE("output: a PFM file has the same bytes for every instruction set, thread count and tile size, and an EXR file its floats",
          "[cli]") {
    const TemporaryFolder folder;
    const auto draw = [&](const std::string& name, const std::vector<std::string>& flags) {
        std::vector<std::string> all = {"render", "demo", "--size", "64x40", "-o", folder.file(name)};
        all.insert(all.end(), flags.begin(), flags.end());
        REQUIRE(run(all).code == 0);
        return contents(folder.file(name));
    };
    const std::string pfm = draw("a.pfm", {});
    CHECK(pfm.size() == std::string("PF\n64 40\n-1.0\n").size() + 64 * 40 * 12);
    CHECK(pfm.starts_with("PF\n64 40\n-1.0\n"));
    CHECK(draw("a.pfm", {"--isa", "scalar", "--threads", "1", "--tile", "16"}) == pfm);
    if (!halflit::has_exr()) {
        const Outcome refused = run({"render", "demo", "-o", folder.file("a.exr")});
        CHECK(refused.code == 2);
        CHECK(refused.err.find("OpenEXR") != std::string::npos);
        return;
    }
    draw("a.exr", {});
    const auto floats = [&](const std::string& name) {
        const std::string file = contents(folder.file(name));
        const auto image = halflit::io::decode_float_image({reinterpret_cast<const std::byte*>(file.data()), file.size()});
        REQUIRE(image);
        return image->rgb;
    };
    CHECK(floats("a.exr") == floats("a.pfm"));
    // As environments, both give the same picture.
    CHECK(run({"render", "sphere:500", "--size", "30x30", "--env", folder.file("a.exr"), "-o", "-"}).out ==
          run({"render", "sphere:500", "--size", "30x30", "--env", folder.file("a.pfm"), "-o", "-"}).out);
    write_contents(folder.file("cut.exr"), contents(folder.file("a.exr")).substr(0, 400));
    const Outcome cut = run({"render", "sphere:500", "--env", folder.file("cut.exr"), "-o", folder.file("b.png")});
    CHECK(cut.code == 3);
    CHECK(cut.err.find("cut.exr: ") != std::string::npos);
    CHECK(std::count(cut.err.begin(), cut.err.end(), '\n') == 1);
}

TEST_CASE("output: a folder that is not there, a folder as file, no right to write end with 4 and the reason", "[cli]") {
    const TemporaryFolder folder;
    CHECK(run(small(folder.file("no/where.png"))).err.find("No such file or directory") != std::string::npos);
    CHECK(run(small(folder.file("no/where.png"))).code == 4);
    std::filesystem::create_directory(folder.file("folder.png"));
    const Outcome is_folder = run(small(folder.file("folder.png")));
    CHECK(is_folder.code == 4);
    CHECK(is_folder.err.find("Is a directory") != std::string::npos);
    CHECK(folder.names() == std::vector<std::string>{"folder.png"});
    CHECK(run(small(folder.path())).code == 4);
}

TEST_CASE("output: a file that outgrows the disk leaves the old one and no temporary", "[cli]") {
    if (!abilities().limits_of_files) HALFLIT_SKIP("no limit of a file's size here");
    const TemporaryFolder folder;
    write_contents(folder.file("old.png"), kOld);
    const Outcome outcome = run(small(folder.file("old.png")), {.largest_file = 300});
    CHECK(outcome.code == 4);
    CHECK(outcome.err.find("File too large") != std::string::npos);
    CHECK(contents(folder.file("old.png")) == kOld);
    CHECK(folder.names() == std::vector<std::string>{"old.png"});
}

TEST_CASE("output: a failed run leaves the old file", "[cli]") {
    const TemporaryFolder folder;
    write_contents(folder.file("old.png"), kOld);
    CHECK(run({"render", "missing.glb", "-o", folder.file("old.png")}).code == 4);
    CHECK(contents(folder.file("old.png")) == kOld);
    CHECK(run(small(folder.file("old.png"))).code == 0);
    CHECK(read_picture(contents(folder.file("old.png"))).width == 40);
}

TEST_CASE("output: a symbolic link is followed, a device written in place", "[cli]") {
    const TemporaryFolder folder;
    write_contents(folder.file("real.png"), kOld);
    if (!make_link("real.png", folder.file("link.png"))) HALFLIT_SKIP("no symbolic links here");
    REQUIRE(make_link("../" + std::filesystem::path(folder.path()).filename().string() + "/new.png", folder.file("dangling.png")));
    CHECK(run({"sphere:200", "-o", folder.file("dangling.png"), "--size", "8"}).code == 0);
    CHECK(std::filesystem::is_symlink(folder.file("dangling.png")));
    CHECK(std::filesystem::is_regular_file(folder.file("new.png")));
    CHECK(run(small(folder.file("link.png"))).code == 0);
    CHECK(std::filesystem::is_symlink(folder.file("link.png")));
    CHECK(read_picture(contents(folder.file("real.png"))).width == 40);
    if (!std::filesystem::exists("/dev/full")) return;
    REQUIRE(make_link("/dev/full", folder.file("full.png")));
    const Outcome full = run(small(folder.file("full.png")));
    CHECK(full.code == 4);
    CHECK(full.err.find("No space left on device") != std::string::npos);
}

TEST_CASE("output: the scene itself is never overwritten", "[cli]") {
    const TemporaryFolder folder;
    write_contents(folder.file("scene.png"), kOld);  // its content does not matter: the check comes before it is read
    CHECK(run({"render", folder.file("scene.png"), "-o", folder.file("scene.png")}).code == 4);
    CHECK(run({"render", folder.file("scene.png"), "-o", "-", "--report", folder.file("scene.png")}).code == 4);
    CHECK(contents(folder.file("scene.png")) == kOld);
}

TEST_CASE("output: a closed standard output is an error, a closed standard error is not", "[cli]") {
    const TemporaryFolder folder;
    CHECK(run(small("-"), {.closed = 1}).code == 4);
    CHECK(run(small(folder.file("a.png")), {.closed = 2}).code == 0);
    CHECK(read_picture(contents(folder.file("a.png"))).width == 40);
}

TEST_CASE("output: a run that waits for its input ends by SIGINT and SIGTERM, with its report", "[cli]") {
    if (!abilities().signals) HALFLIT_SKIP("no signals to other processes here");
    for (const int signal : {SIGINT, SIGTERM}) {
        const TemporaryFolder folder;
        // Called once the program has read the first byte and waits for the next one.
        const auto now = [&]() { return std::optional(signal); };
        const Outcome outcome = run({"render", "-", "-o", folder.file("a.png"), "--report", folder.file("r.json")},
                                    {.input = "{", .signal = now, .hold_input_open = true});
        INFO("signal " << signal << ": " << outcome.err);
        CHECK(outcome.code == 128 + signal);
        CHECK(folder.names() == std::vector<std::string>{"r.json"});
        CHECK(contents(folder.file("r.json")).find("\"status\": \"error\"") != std::string::npos);
    }
}

TEST_CASE("output: interrupted while it writes, a run leaves the old file or the new one, and nothing else", "[cli]") {
    if (!abilities().signals) HALFLIT_SKIP("no signals to other processes here");
    const TemporaryFolder folder;
    write_contents(folder.file("a.png"), kOld);
    const auto when_writing = [&]() { return folder.names().size() > 1 ? std::optional(SIGINT) : std::nullopt; };
    const Outcome outcome =
        run({"render", "sphere:500", "--size", "1500x1500", "--samples", "1", "-o", folder.file("a.png")}, {.signal = when_writing});
    CHECK(folder.names() == std::vector<std::string>{"a.png"});
    if (outcome.code == 0 || contents(folder.file("a.png")) != kOld)
        CHECK(read_picture(contents(folder.file("a.png"))).width == 1500);
    else
        CHECK(outcome.code == 128 + SIGINT);
}

TEST_CASE("output: a file that the scene was read from is not overwritten", "[cli]") {
    const TemporaryFolder folder;
    REQUIRE(run({"demo", "--size", "8x8", "-o", folder.file("crate.png")}).code == 0);
    const std::string before = contents(folder.file("crate.png"));
    std::ofstream(folder.file("crate.gltf"))
        << R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":)"
        << R"({"POSITION":0,"TEXCOORD_0":1},"material":0}]}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)"
        << R"("textures":[{"source":0}],"images":[{"uri":"crate.png"}],"accessors":[{"componentType":5126,"count":3,"type":"VEC3"},)"
        << R"({"componentType":5126,"count":3,"type":"VEC2"}]})";
    const auto kept = [&] {
        std::ifstream file(folder.file("crate.png"), std::ios::binary);
        return std::string((std::istreambuf_iterator<char>(file)), {}) == before;
    };
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"crate.gltf"},
                                                      {"crate.gltf", "-o", "crate.png"},
                                                      {"crate.gltf", "-o", "./crate.png"},
                                                      {"crate.gltf", "-o", "new.png", "--report", "crate.png"}}) {
        const Outcome outcome = run(arguments, {.folder = folder.path()});
        CHECK(outcome.code == (arguments.back() == "crate.png" && arguments.size() == 5 ? 2 : 4));  // a report is refused before loading
        CHECK(outcome.err.find("crate.png") != std::string::npos);
        CHECK(kept());
        CHECK(folder.names() == std::vector<std::string>{"crate.gltf", "crate.png"});
    }
    CHECK(run({"crate.gltf", "-o", "new.png", "-q"}, {.folder = folder.path()}).code == 0);
    // Nor one that a model names and does not draw.
    std::ofstream(folder.file("crate.mtl")) << "newmtl a\nmap_Kd crate.png\n";
    std::ofstream(folder.file("ambient.mtl")) << "newmtl a\nmap_Ka -s 2 2 2 crate.png\nnewmtl b\nmap_Ns crate.png\n";
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", points =
                                                                             "element vertex 3\nproperty float x\nproperty float y\n"
                                                                             "property float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
    for (const std::string& text : {"mtllib crate.mtl\n" + triangle, "mtllib ambient.mtl\nusemtl a\n" + triangle,
                                    "ply\nformat ascii 1.0\ncomment TextureFile crate.png\n" + points}) {
        std::ofstream(folder.file("crate.obj")) << text;
        const Outcome outcome = run({"crate.obj"}, {.folder = folder.path()});
        CHECK(outcome.code == 4);
        CHECK(outcome.err.find("crate.png: the scene refers to it") != std::string::npos);
        CHECK(kept());
    }
    for (const char* name : {"crate.obj", "crate.mtl", "ambient.mtl"}) std::filesystem::remove(folder.file(name));
    // Of several scenes, one may refer to a file that another's picture would replace, and that nothing draws.
    std::ofstream(folder.file("plain.gltf"))
        << R"({"asset":{"version":"2.0"},"images":[{"uri":"crate.png"}],"nodes":[{}],"scenes":[{"nodes":[0]}]})";
    std::filesystem::rename(folder.file("crate.gltf"), folder.file("box.gltf"));
    std::filesystem::copy_file(folder.file("plain.gltf"), folder.file("crate.glb"));
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"crate.glb", "box.gltf", "-o", "./"},
                                                      {"plain.gltf", "crate.glb", "-o", "./"},
                                                      {"crate.glb", "-o", "./"}}) {
        const Outcome outcome = run(arguments, {.folder = folder.path()});
        CHECK(outcome.code == 4);
        CHECK(outcome.err.find("crate.png: ") != std::string::npos);
        CHECK(kept());
    }
    // A texture that is missing does not become the picture of a neighbour.
    std::filesystem::remove(folder.file("crate.png"));
    CHECK(run({"crate.glb", "box.gltf", "-o", "./"}, {.folder = folder.path()}).code == 4);
    CHECK(folder.names() == std::vector<std::string>{"box.gltf", "crate.glb", "new.png", "plain.gltf"});
}
