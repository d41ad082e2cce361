// --aov: the files beside a picture.
#include "tests/cli/program.hpp"

#include "apps/io/pictures/float_image.hpp"
#include "apps/io/pictures/image_reader.hpp"
#include "halflit/image.hpp"
#include "tests/support/base64.hpp"
#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>

using namespace halflit::test;

namespace {

const std::string kAll =
    "depth,normal,albedo,position,id,coverage,lights,ray,view_normal,barycentric,uv,part,mesh,material,triangle,"
    "depth16";

std::span<const std::byte> bytes_of(const std::string& file) { return {reinterpret_cast<const std::byte*>(file.data()), file.size()}; }

const std::string kFloats = halflit::has_exr() ? ".exr" : ".pfm";

/// Pixel of a file of floats. Negative values are read as 0, as light.
std::vector<float> floats_at(const std::string& path, int x, int y) {
    const std::string file = contents(path);
    const auto image = halflit::io::decode_float_image(bytes_of(file));
    REQUIRE(image);
    const std::size_t at = 3 * static_cast<std::size_t>(y * image->width + x);
    return {image->rgb[at], image->rgb[at + 1], image->rgb[at + 2]};
}

/// Pixel of a PNG of 16 bits.
int number_at(const std::string& path, int x, int y) {
    const std::string file = contents(path);
    const auto header = halflit::io::read_image_header(bytes_of(file));
    REQUIRE(header);
    CHECK(header->bits == 16);
    const auto image = halflit::io::decode_image(bytes_of(file), {}, true);
    REQUIRE(image);
    return image->rgba16[4 * static_cast<std::size_t>(y * image->width + x)];
}

/// A glTF file of one triangle in a plane z, with corners at (x - 1, -1), (x + 1, -1) and (x, 1).
std::string triangle_at(float x, float z) {
    std::vector<std::uint8_t> bytes;
    for (const float value : {x - 1, -1.0f, z, x + 1, -1.0f, z, x, 1.0f, z}) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
    }
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[)" +
           std::to_string(x - 1) + ",-1," + std::to_string(z) + R"(],"max":[)" + std::to_string(x + 1) + ",1," + std::to_string(z) +
           R"(]}],"bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)" +
           encode_base64(bytes) + "\"}]}";
}

}  // namespace

TEST_CASE("aov: files beside the picture show a sphere as its formula does", "[cli]") {
    const TemporaryFolder folder;
    const Outcome outcome = run({"render", "sphere:200000", "--size", "101x101", "--samples", "1", "--camera-position", "0,0,5",
                                 "--camera-target", "0,0,0", "--aov", kAll, "-o", folder.file("s.png"), "--report", "-"});
    REQUIRE(outcome.code == 0);
    CHECK(folder.names() == std::vector<std::string>{"s.albedo" + kFloats, "s.barycentric" + kFloats, "s.coverage.png", "s.depth" + kFloats,
                                                     "s.depth16.json", "s.depth16.png", "s.id.png", "s.lights.png", "s.material.png",
                                                     "s.mesh.png", "s.names.json", "s.normal" + kFloats, "s.part.png", "s.png",
                                                     "s.position" + kFloats, "s.ray" + kFloats, "s.triangle.png", "s.uv" + kFloats,
                                                     "s.view_normal" + kFloats});
    const auto report = nlohmann::json::parse(outcome.out);
    CHECK(report["aov"].size() == 18);
    CHECK(report["aov"]["id"] == folder.file("s.id.png"));
    // The middle of the sphere of radius 1: the point (0, 0, 1).
    const auto near = [](const std::vector<float>& found, double x, double y, double z) {
        return std::abs(static_cast<double>(found[0]) - x) < 2e-3 && std::abs(static_cast<double>(found[1]) - y) < 2e-3 &&
               std::abs(static_cast<double>(found[2]) - z) < 2e-3;
    };
    CHECK(near(floats_at(folder.file("s.depth" + kFloats), 50, 50), 4, 4, 4));
    CHECK(near(floats_at(folder.file("s.position" + kFloats), 50, 50), 0, 0, 1));
    CHECK(near(floats_at(folder.file("s.normal" + kFloats), 50, 50), 0, 0, 1));
    CHECK(near(floats_at(folder.file("s.albedo" + kFloats), 50, 50), 0.8, 0.75, 0.7));
    CHECK(number_at(folder.file("s.id.png"), 50, 50) == 1);
    CHECK(number_at(folder.file("s.coverage.png"), 50, 50) == 65535);
    CHECK(number_at(folder.file("s.lights.png"), 50, 50) >= 1);
    CHECK(floats_at(folder.file("s.depth" + kFloats), 0, 0)[0] == 1e30f);  // infinity, as it is read
    CHECK(floats_at(folder.file("s.position" + kFloats), 0, 0) == std::vector<float>{0, 0, 0});
    for (const char* name : {"s.id.png", "s.coverage.png", "s.lights.png"}) CHECK(number_at(folder.file(name), 0, 0) == 0);
}

TEST_CASE("aov: the picture keeps its bytes, and the files have theirs for every way of computing them", "[cli]") {
    const TemporaryFolder folder;
    const auto draw = [&](const std::string& name, const std::vector<std::string>& flags) {
        std::vector<std::string> all = {"render", "demo", "--size", "96x64", "-o", folder.file(name + ".png")};
        all.insert(all.end(), flags.begin(), flags.end());
        REQUIRE(run(all).code == 0);
    };
    draw("bare", {});
    draw("a", {"--aov", kAll});
    draw("b", {"--aov", kAll, "--isa", "scalar", "--threads", "1", "--tile", "16"});
    CHECK(contents(folder.file("a.png")) == contents(folder.file("bare.png")));
    for (const std::string& name : folder.names())
        if (name.starts_with("a.")) CHECK(contents(folder.file(name)) == contents(folder.file(std::string("b").append(name, 1))));
    CHECK(folder.names().size() == 39);
}

TEST_CASE("aov: a scene that is moved and scaled for drawing has the file's own distances and positions", "[cli]") {
    const TemporaryFolder folder;
    write_contents(folder.file("far.gltf"), triangle_at(1048576.0f, 4096.0f));
    REQUIRE(run({"render", folder.file("far.gltf"), "--size", "41x41", "--camera-position", "1048576,0,4106", "--camera-target",
                 "1048576,0,4096", "--aov", "depth,position", "-o", folder.file("far.png")})
                .code == 0);
    CHECK(floats_at(folder.file("far.depth" + kFloats), 20, 20) == std::vector<float>{10, 10, 10});
    const std::vector<float> position = floats_at(folder.file("far.position" + kFloats), 20, 20);
    CHECK(position[0] == 1048576.0f);
    CHECK(position[2] == 4096.0f);
    CHECK(floats_at(folder.file("far.position" + kFloats), 0, 0) == std::vector<float>{0, 0, 0});
}

TEST_CASE("aov: numbers beyond 65,535, points of triangles and depths of 16 bits are those of a sphere", "[cli]") {
    const TemporaryFolder folder;
    const Outcome outcome =
        run({"render", "sphere:200000", "--size", "101x101", "--samples", "1", "--camera-position", "0,0,5", "--camera-target", "0,0,0",
             "--aov", "triangle,barycentric,depth,ray,depth16,position", "-o", folder.file("s.png"), "--report", "-"});
    REQUIRE(outcome.code == 0);
    const auto report = nlohmann::json::parse(outcome.out);
    const auto range = nlohmann::json::parse(contents(folder.file("s.depth16.json")));
    CHECK(report["depth16"][0] == range["depth_of_1"]);
    CHECK(report["depth16"][1] == range["depth_of_65535"]);
    const auto image = halflit::io::decode_image(bytes_of(contents(folder.file("s.triangle.png"))), {}, false);
    REQUIRE(image);
    const auto number = [&](int x, int y) {
        const std::uint8_t* const p = &image->rgba8[4 * static_cast<std::size_t>(y * 101 + x)];
        return p[0] + 256 * p[1] + 65536 * p[2] + 16777216 * p[3];
    };
    CHECK(number(0, 0) == 0);
    CHECK(number_at(folder.file("s.depth16.png"), 0, 0) == 0);
    int most = 0, least_code = 65536, most_code = 0;
    const double near = range["depth_of_1"], step = (range["depth_of_65535"].get<double>() - near) / 65534;
    for (int y = 0; y < 101; y += 2)
        for (int x = 0; x < 101; x += 2) {
            const int code = number_at(folder.file("s.depth16.png"), x, y);
            CHECK((code == 0) == (number(x, y) == 0));
            if (code == 0) continue;
            most = std::max(most, number(x, y));
            least_code = std::min(least_code, code), most_code = std::max(most_code, code);
            const auto depth = static_cast<double>(floats_at(folder.file("s.depth" + kFloats), x, y)[0]);
            CHECK(std::abs(near + (code - 1) * step - depth) < 0.51 * step + 1e-6);
            const std::vector<float> at = floats_at(folder.file("s.barycentric" + kFloats), x, y);
            CHECK(at[0] + at[1] <= 1.000001f);
            CHECK(at[2] == 0.0f);
        }
    CHECK(most > 65535);
    CHECK(least_code < 100);
    CHECK(most_code > 60000);
    CHECK(std::abs(floats_at(folder.file("s.ray" + kFloats), 50, 50)[0] - floats_at(folder.file("s.depth" + kFloats), 50, 50)[0]) < 1e-6f);
}

TEST_CASE("aov: numbers of parts, meshes and materials are those of the table of names", "[cli]") {
    const TemporaryFolder folder;
    std::string model = triangle_at(0, 0);
    const std::string nodes = R"("nodes":[{"mesh":0}],)";
    model.replace(model.find(nodes), nodes.size(),
                  R"("nodes":[{"name":"nothing"},{"name":"wing","mesh":0}],"materials":[{"name":"tin"}],)");
    model.replace(model.find(R"("nodes":[0])"), 11, R"("nodes":[0,1])");
    model.replace(model.find(R"("POSITION":0}})"), 14, R"("POSITION":0},"material":0})");
    write_contents(folder.file("wing.gltf"), model);
    REQUIRE(run({"render", folder.file("wing.gltf"), "--size", "41x41", "--aov", "id,part,mesh,material", "-o", folder.file("w.png"),
                 "--camera-position", "0,0,5", "--camera-target", "0,0,0"})
                .code == 0);
    const auto names = nlohmann::json::parse(contents(folder.file("w.names.json")));
    const auto at = [&](const char* plane) {
        return static_cast<std::size_t>(number_at(folder.file(std::string("w.") + plane + ".png"), 20, 20));
    };
    REQUIRE(at("id") == 1);
    CHECK(at("part") == 1);  // the node that places nothing is no part
    CHECK(at("mesh") == 1);
    CHECK(at("material") == 1);
    CHECK(names["parts"][at("part") - 1] == "wing");
    CHECK(names["materials"][at("material") - 1] == "tin");
    const auto& instance = names["instances"][at("id") - 1];
    CHECK((instance["part"] == at("part") && instance["mesh"] == at("mesh") && instance["material"] == at("material")));
    CHECK(number_at(folder.file("w.part.png"), 0, 0) == 0);
}

TEST_CASE("aov: names that are not known, a picture without a name, and files of others are refused", "[cli]") {
    const TemporaryFolder folder;
    CHECK(run({"render", "demo", "--aov", "depht", "-o", folder.file("a.png")}).err.find("did you mean depth?") != std::string::npos);
    CHECK(run({"render", "demo", "--aov", "depth", "-o", "-"}).code == 2);
    CHECK(run({"render", "demo", "--aov", "id", "-o", folder.file("a.png"), "--report", folder.file("a.id.png")}).code == 2);
    CHECK(folder.names().empty());
    // The scene has the name of a file that would be written.
    write_contents(folder.file("a.id.png"), triangle_at(0, 0));
    const Outcome itself = run({"render", folder.file("a.id.png"), "--aov", "id", "-o", folder.file("a.png")});
    CHECK(itself.code == 4);
    CHECK(itself.err.find("is the scene itself") != std::string::npos);
    CHECK(folder.names() == std::vector<std::string>{"a.id.png"});
}

TEST_CASE("aov: several views, cameras and frames have the files of their pictures drawn alone", "[cli]") {
    const TemporaryFolder folder;
    const std::string aovs = "depth,view_normal,ray,position,part,triangle,depth16";
    const auto draw = [&](const std::vector<std::string>& flags, const std::string& output) {
        std::vector<std::string> all = {"render", "demo", "--size", "48x32", "--aov", aovs, "-o", folder.file(output), "--report", "-"};
        all.insert(all.end(), flags.begin(), flags.end());
        const Outcome outcome = run(all);
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        return outcome.out;
    };
    // Each of `names` must be the same file as that of `alone`.
    std::size_t compared = 0;
    const auto same_files = [&](const std::string& stem, const std::string& alone) {
        for (const std::string& name : folder.names())
            if (name.starts_with(alone + ".")) {
                INFO(stem << " and " << name);
                CHECK(contents(folder.file(stem + name.substr(alone.size()))) == contents(folder.file(name)));
                ++compared;
            }
    };
    const std::string report = draw({"--view", "front,top,22.5,-10"}, "v_{view}.png");
    CHECK(std::count(report.begin(), report.end(), '\n') == 3);
    const auto first = nlohmann::json::parse(report.substr(0, report.find('\n')));
    CHECK(first["aov"]["depth"] == folder.file("v_front.depth" + kFloats));
    CHECK(first["aov"].size() == 9);
    // All views of one run are framed together, so the cameras of the report draw the pictures alone.
    write_contents(folder.file("views.json"), report);
    for (const char* const index : {"0", "1", "2"})
        draw({"--camera-file", folder.file("views.json"), "--camera", index}, std::string("alone") + index + ".png");
    same_files("v_front", "alone0");
    same_files("v_top", "alone1");
    same_files("v_22.5,-10", "alone2");
    CHECK(compared == 3 * 10);
    draw({"--camera-file", folder.file("views.json"), "--camera", "all"}, "c_{view}.png");
    same_files("c_v_top", "alone1");
    const std::string film = draw({"--turntable", "3"}, "f_{:02}.png");
    write_contents(folder.file("film.json"), film);
    for (const char* const index : {"0", "2"}) {
        draw({"--camera-file", folder.file("film.json"), "--camera", index}, std::string("turn") + index + ".png");
        for (const std::string& name : {"depth" + kFloats, "ray" + kFloats, "position" + kFloats, "view_normal" + kFloats})
            CHECK(contents(folder.file(std::string("f_0") + index + "." + name)) ==
                  contents(folder.file(std::string("turn") + index + "." + name)));
        CHECK(contents(folder.file(std::string("f_0") + index + ".part.png")) ==
              contents(folder.file(std::string("turn") + index + ".part.png")));
    }
    CHECK(contents(folder.file("f_00.depth" + kFloats)) != contents(folder.file("f_02.depth" + kFloats)));
    // A view's name with a dot stays whole where --format gives the format.
    draw({"--view", "22.5,-10,22.6,-10", "--format", "png"}, "d_{view}");
    CHECK(contents(folder.file("d_22.5,-10.depth" + kFloats)) != contents(folder.file("d_22.6,-10.depth" + kFloats)));
    // Nothing that the scene needs is overwritten.
    write_contents(folder.file("m.gltf"), triangle_at(0, 0));
    std::filesystem::copy(folder.file("m.gltf"), folder.file("w_front.names.json"));
    const Outcome refused = run({"render", folder.file("w_front.names.json"), "--size", "8", "--view", "front,top", "--aov", "part", "-o",
                                 folder.file("w_{view}.png")});
    CHECK(refused.code == 4);
    CHECK(contents(folder.file("w_front.names.json")) == triangle_at(0, 0));
}
