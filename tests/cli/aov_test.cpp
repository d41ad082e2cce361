// --aov: the files beside a picture.
#include "tests/cli/program.hpp"

#include "apps/io/pictures/float_image.hpp"
#include "apps/io/pictures/image_reader.hpp"
#include "halflit/image.hpp"
#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <cstdint>

using namespace halflit::test;

namespace {

const std::string kAll = "depth,normal,albedo,position,id,coverage,lights";

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

std::string base64(const std::string& bytes) {
    const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {  // a multiple of 3
        unsigned n = 0;
        for (std::size_t k = 0; k < 3; ++k) n = n << 8 | static_cast<unsigned char>(bytes[i + k]);
        for (int shift = 18; shift >= 0; shift -= 6) text += digits[n >> shift & 63];
    }
    return text;
}

/// A glTF file of one triangle in a plane z, with corners at (x - 1, -1), (x + 1, -1) and (x, 1).
std::string triangle_at(float x, float z) {
    std::string bytes;
    for (const float value : {x - 1, -1.0f, z, x + 1, -1.0f, z, x, 1.0f, z}) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        for (int i = 0; i < 4; ++i) bytes += static_cast<char>(bits >> (8 * i));
    }
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[)" +
           std::to_string(x - 1) + ",-1," + std::to_string(z) + R"(],"max":[)" + std::to_string(x + 1) + ",1," + std::to_string(z) +
           R"(]}],"bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)" +
           base64(bytes) + "\"}]}";
}

}  // namespace

TEST_CASE("aov: files beside the picture show a sphere as its formula does", "[cli]") {
    const TemporaryFolder folder;
    const Outcome outcome = run({"render", "sphere:200000", "--size", "101x101", "--samples", "1", "--camera-position", "0,0,5",
                                 "--camera-target", "0,0,0", "--aov", kAll, "-o", folder.file("s.png"), "--report", "-"});
    REQUIRE(outcome.code == 0);
    CHECK(folder.names() == std::vector<std::string>{"s.albedo" + kFloats, "s.coverage.png", "s.depth" + kFloats, "s.id.png",
                                                     "s.lights.png", "s.normal" + kFloats, "s.png", "s.position" + kFloats});
    const auto report = nlohmann::json::parse(outcome.out);
    CHECK(report["aov"].size() == 7);
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
    CHECK(folder.names().size() == 17);
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
