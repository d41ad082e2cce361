// --timeout and --max-memory, and pictures of which only a part is drawn.
#include "tests/cli/program.hpp"

#include "halflit/image.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <tuple>

using namespace halflit;
using namespace halflit::test;

namespace {

std::string content(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Width and height of a PNG file.
std::pair<std::uint32_t, std::uint32_t> png_size(const std::string& png) {
    const auto number = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(png.at(at + i));
        return value;
    };
    return {number(16), number(20)};
}

}  // namespace

TEST_CASE("limits: a scene that takes longer than --timeout ends with 5, a report and no picture", "[cli]") {
    const TemporaryFolder folder;
    const Outcome outcome =
        run({"sphere:1000000", "--size", "4096x4096", "--timeout", "0.01", "-o", folder.file("a.png"), "--report", folder.file("a.json")});
    CHECK(outcome.code == 5);
    CHECK(outcome.err.find("time limit") != std::string::npos);
    CHECK(folder.names() == std::vector<std::string>{"a.json"});
    CHECK(content(folder.file("a.json")).find("\"code\": 5") != std::string::npos);
    CHECK(run({"sphere:100", "--size", "16x16", "--timeout", "600", "-o", folder.file("b.png")}).code == 0);
}

namespace {

/// A Radiance picture of long runs: 2.1 MB for 8192 x 4096 pixels. The rows nearest to a pole are bright: a sun of many pixels.
std::string long_runs(int width, int height, int bright_rows, const std::string& order) {
    std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + order + "\n";
    for (int y = 0; y < height; ++y) {
        file += std::string{2, 2, static_cast<char>(width >> 8), static_cast<char>(width & 255)};
        for (int component = 0; component < 4; ++component)
            for (int x = 0; x < width;) {
                const int run = std::min(127, width - x);
                file += static_cast<char>(128 + run);
                file += static_cast<char>(component < 3 ? 128 : y < bright_rows ? 140 : 126);
                x += run;
            }
    }
    return file;
}

}  // namespace

TEST_CASE("limits: --timeout is kept while an environment is read and analysed", "[cli][slow]") {
    const TemporaryFolder folder;
    for (const auto& [width, height, bright, order] :
         {std::tuple{8192, 4096, 0, "-Y 4096 +X 8192"}, {8192, 4096, 60, "-Y 4096 +X 8192"}, {8192, 4096, 0, "+X 8192 +Y 4096"}}) {
        INFO(order << ", " << bright << " bright rows");
        const std::string sky = folder.file("sky.hdr");
        std::ofstream(sky, std::ios::binary) << (order[0] == '-' ? long_runs(width, height, bright, order)
                                                                 : long_runs(height, width, bright, order));
        for (const char* limit : {"0.25", "0.75"}) {
            const auto start = std::chrono::steady_clock::now();
            const double before = processor_s_of_children();
            const Outcome outcome = run({"sphere:100", "--env", sky, "--timeout", limit, "--size", "64", "-o", folder.file("a.png")});
            const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            const double processor = processor_s_of_children() - before;
            CHECK(outcome.code == 5);
            CHECK(outcome.err.find("time limit") != std::string::npos);
            // Other programs lengthen the clock's time. The analysis uses one thread: without a limit 2 to 6 s on a Xeon of 2023.
            if (processor > 0)
                CHECK(processor < std::stod(limit) + 1.0);
            else
                CHECK(passed < std::stod(limit) + 6.0);
        }
        CHECK(run({"env", sky, "--timeout", "0.25"}).code == 5);
    }
}

namespace {

std::string number32(std::uint32_t value) {
    std::string text;
    for (int shift = 0; shift < 32; shift += 8) text += static_cast<char>(value >> shift & 255u);
    return text;
}

/// A GLB of a tetrahedron whose faces are there `copies` times, in so many instances at one place.
std::string heap_of_triangles(int copies, int instances) {
    std::string bin;
    for (const float value : {-1.f, -1.f, 0.f, 1.f, -1.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f}) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, 4);
        bin += number32(bits);
    }
    for (int i = 0; i < copies; ++i)
        for (const int corner : {0, 1, 3, 1, 2, 3, 2, 0, 3, 0, 2, 1}) bin += std::string{static_cast<char>(corner), '\0'};
    std::string json =
        R"({"asset":{"version":"2.0"},"extensionsUsed":["EXT_mesh_gpu_instancing"],"scene":0,"scenes":[{"nodes":[0]}],)"
        R"("nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":2}}}}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],"materials":[{"doubleSided":true}],)"
        R"("bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":)" +
        std::to_string(24 * copies) +
        R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-1,-1,0],"max":[1,1,1]},)"
        R"({"bufferView":1,"componentType":5123,"count":)" +
        std::to_string(12 * copies) + R"(,"type":"SCALAR"},{"componentType":5126,"type":"VEC3","count":)" + std::to_string(instances) +
        R"(}],"buffers":[{"byteLength":)" + std::to_string(bin.size()) + "}]}";
    while (json.size() % 4 != 0) json += ' ';
    while (bin.size() % 4 != 0) bin += '\0';
    return "glTF" + number32(2) + number32(static_cast<std::uint32_t>(28 + json.size() + bin.size())) +
           number32(static_cast<std::uint32_t>(json.size())) + "JSON" + json + number32(static_cast<std::uint32_t>(bin.size())) +
           std::string("BIN\0", 4) + bin;
}

}  // namespace

TEST_CASE("limits: a small file cannot take long, and --timeout ends it", "[cli]") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    HALFLIT_SKIP("sanitizers take ten times as long");
#endif
    const TemporaryFolder folder;
    const std::string heap = folder.file("heap.glb"), sky = folder.file("sky.hdr");
    write_contents(heap, heap_of_triangles(1500, 200));
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8192 +X 16384\n";
    write_contents(sky, head + std::string("\1\1\1\1", 4) + std::string(90000, '\1'));  // old runs: one pixel many times
    const double before = processor_s_of_children();
    const Outcome by_work = run({heap, "--size", "256", "-o", folder.file("a.png")});
    const Outcome by_pixels = run({"sphere:100", "--env", sky, "--size", "64", "-o", folder.file("a.png")});
    CHECK(processor_s_of_children() - before < 10.0);
    CHECK(by_work.code == 5);
    CHECK(by_work.err.find("takes more work than max_work allows") != std::string::npos);
    CHECK(by_pixels.code == 5);
    CHECK(by_pixels.err.find("the limit is") != std::string::npos);
    const auto start = std::chrono::steady_clock::now();
    const Outcome by_time = run({heap, "--size", "256", "--max-work", "1000000000000000", "--timeout", "1", "-o", folder.file("a.png")});
    CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < 1.5);
    CHECK(by_time.code == 5);
    CHECK(by_time.err.find("time limit") != std::string::npos);
    CHECK(run({heap, "--size", "16", "--shadows", "off", "-o", folder.file("b.png")}).code == 0);  // fewer pixels are less work
    CHECK(folder.names() == std::vector<std::string>{"b.png", "heap.glb", "sky.hdr"});
}

TEST_CASE("limits: --timeout ends a float64 reference below a sky within half a second", "[cli]") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    HALFLIT_SKIP("sanitizers take ten times as long");
#endif
    const TemporaryFolder folder;
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = run({"sphere:200", "--size", "256", "--env", "sky", "--accuracy", "reference", "--timeout", "1", "--threads",
                                 "1", "-o", folder.file("a.png")});
    CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < 1.5);
    CHECK(outcome.code == 5);
}

TEST_CASE("limits: surfaces whose triangles cross are compared within 10 s of processor", "[cli][slow]") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    HALFLIT_SKIP("sanitizers take ten times as long");
#endif
    const TemporaryFolder folder;
    std::string soup = "solid soup\n";
    std::uint32_t state = 1;
    const auto next = [&] { return static_cast<int>((state = state * 1664525u + 1013904223u) >> 16) % 1000; };
    for (int i = 0; i < 12000; ++i) {
        soup += "facet normal 0 0 0 outer loop";
        for (int k = 0; k < 3; ++k) soup += fmt::format(" vertex {} {} {}", next(), next(), next());
        soup += " endloop endfacet\n";
    }
    write_contents(folder.file("soup.stl"), soup + "endsolid soup\n");
    const double before = processor_s_of_children();
    const Outcome outcome = run({"compare", folder.file("soup.stl"), folder.file("soup.stl"), "--size", "64", "--json", "-"});
    CHECK(processor_s_of_children() - before < 10.0);
    CHECK(outcome.code == 0);
}

TEST_CASE("limits: --timeout is kept among many names of a model", "[cli][slow]") {
    const TemporaryFolder folder;
    const auto list = [](std::size_t count, const char* each) {
        std::string text;
        for (std::size_t i = 0; i < count; ++i) text += each + std::to_string(i);
        return text;
    };
    const std::string head = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{}],"extensionsUsed":["a)";
    for (const auto& [name, text] :
         {std::pair{"libraries.obj", "mtllib" + list(1'000'000, " a") + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
          {"extensions.gltf", head + list(2'000'000, "\",\"e") + "\"]}"}}) {
        INFO(name);
        const std::string model = folder.file(name);
        std::ofstream(model, std::ios::binary) << text;
        for (const bool described : {false, true}) {
            const auto start = std::chrono::steady_clock::now();
            const Outcome outcome = described ? run({"info", model, "--json", "--timeout", "0.3"})
                                              : run({model, "--timeout", "0.3", "--size", "64", "-o", folder.file("a.png")});
            CHECK(outcome.code == 5);
            CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < 3.0);
        }
    }
}

TEST_CASE("limits: an environment takes little more memory than its picture", "[cli][slow]") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    HALFLIT_SKIP("sanitizers take terabytes of addresses");
#endif
    const TemporaryFolder folder;
    const std::string sky = folder.file("sky.hdr");
    std::ofstream(sky, std::ios::binary) << long_runs(8192, 4096, 0, "-Y 4096 +X 8192");
    // 403 MB of floats.
    const Outcome outcome = run({"sphere:100", "--env", sky, "--max-memory", "700", "--size", "64", "-o", folder.file("a.png")});
    INFO(outcome.err);
    CHECK(outcome.code == 0);
}

TEST_CASE("output: a pipe that nobody reads is an error, not a wait for ever", "[cli][slow]") {
    const TemporaryFolder folder;
    const std::string pipe = folder.file("pipe.png");
    if (!make_pipe(pipe)) HALFLIT_SKIP("no pipes with names in folders");
    const Outcome outcome = run({"sphere:100", "--size", "16", "-o", pipe});
    CHECK(outcome.code == 4);
    CHECK(outcome.err.find("nobody reads this pipe") != std::string::npos);
}

TEST_CASE("limits: --timeout ends the wait for standard input", "[cli]") {
    const TemporaryFolder folder;
    const Outcome outcome = run({"render", "-", "--timeout", "0.2", "-o", folder.file("a.png"), "--report", folder.file("a.json")},
                                {.input = "{", .hold_input_open = true});
    CHECK(outcome.code == 5);
    CHECK(outcome.err.find("--timeout") != std::string::npos);
    CHECK(folder.names() == std::vector<std::string>{"a.json"});
}

TEST_CASE("limits: a scene that needs more than --max-memory ends with 5, a report and no picture", "[cli]") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    HALFLIT_SKIP("sanitizers take terabytes of addresses");
#endif
    if (!abilities().limits_of_memory) HALFLIT_SKIP("no limit of a process's memory here");
    const TemporaryFolder folder;
    const Outcome outcome = run({"sphere:1000000", "--max-memory", "64", "-o", folder.file("a.png"), "--report", folder.file("a.json")});
    CHECK(outcome.code == 5);
    CHECK(outcome.err.find("memory") != std::string::npos);
    CHECK(outcome.err.find("--max-memory") != std::string::npos);
    CHECK(folder.names() == std::vector<std::string>{"a.json"});
    CHECK(run({"sphere:1000000", "--size", "64x64", "--max-memory", "1000", "-o", folder.file("b.png")}).code == 0);
    CHECK(run({"demo", "--max-memory", "31"}).code == 2);
}

TEST_CASE("limits: textures and triangles of a small file take less than 1 GB together", "[cli][slow]") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    HALFLIT_SKIP("sanitizers take terabytes of addresses");
#endif
    if (!abilities().limits_of_memory) HALFLIT_SKIP("no limit of a process's memory here");
    const TemporaryFolder folder;
    constexpr int kSide = 5600, kGrid = 50, kNodes = 2000;
    const Image plain{kSide, kSide, std::vector<std::uint8_t>(std::size_t{4} * kSide * kSide, 255), {}};
    REQUIRE(write_image(folder.file("a.png"), plain));
    std::filesystem::copy_file(folder.file("a.png"), folder.file("b.png"));
    std::string bin;
    const auto number = [&](double value) { bin += number32(std::bit_cast<std::uint32_t>(static_cast<float>(value))); };
    for (const bool is_uv : {false, true})
        for (int y = 0; y <= kGrid; ++y)
            for (int x = 0; x <= kGrid; ++x) {
                number(x / 50.0), number(y / 50.0);
                if (!is_uv) number((x * y % 7) / 100.0);
            }
    for (int y = 0; y < kGrid; ++y)
        for (int x = 0; x < kGrid; ++x)
            for (const int corner : {0, 1, kGrid + 1, 1, kGrid + 2, kGrid + 1})
                bin += number32(static_cast<std::uint32_t>(y * (kGrid + 1) + x + corner));
    write_contents(folder.file("grid.bin"), bin);
    // A wall of grids that overlap.
    std::string nodes, list;
    for (int k = 0; k < kNodes; ++k) {
        nodes += fmt::format("{}{{\"mesh\":0,\"translation\":[{:.3f},{:.3f},{:.3f}]}}", k == 0 ? "" : ",", k % 64 * 0.306, k / 64 * 0.306,
                             k * 37 % 200 / 1000.0);
        list += (k == 0 ? "" : ",") + std::to_string(k);
    }
    constexpr int kVertices = (kGrid + 1) * (kGrid + 1), kIndices = 6 * kGrid * kGrid;
    write_contents(
        folder.file("wall.gltf"),
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + list + "]}],\"nodes\":[" + nodes +
            R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],)"
            R"("materials":[{"doubleSided":true,"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},)"
            R"("emissiveTexture":{"index":1},"emissiveFactor":[1,1,1]}],"textures":[{"source":0},{"source":1}],)"
            R"("images":[{"uri":"a.png"},{"uri":"b.png"}],)" +
            fmt::format(R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{0},"type":"VEC3"}},)"
                        R"({{"bufferView":1,"componentType":5126,"count":{0},"type":"VEC2"}},)"
                        R"({{"bufferView":2,"componentType":5125,"count":{1},"type":"SCALAR"}}],"bufferViews":[)"
                        R"({{"buffer":0,"byteLength":{2}}},{{"buffer":0,"byteOffset":{2},"byteLength":{3}}},)"
                        R"({{"buffer":0,"byteOffset":{4},"byteLength":{5}}}],"buffers":[{{"uri":"grid.bin","byteLength":{6}}}]}})",
                        kVertices, kIndices, 12 * kVertices, 8 * kVertices, 20 * kVertices, 4 * kIndices, bin.size()));
    const Outcome outcome = run({folder.file("wall.gltf"), "--max-memory", "800", "--threads", "2", "-o", folder.file("wall.jpg")});
    INFO(outcome.err);
    CHECK(outcome.code == 0);
}

TEST_CASE("limits: of a picture with more pixels than an image may have, a region is drawn", "[cli]") {
    const TemporaryFolder folder;
    CHECK(run({"sphere:100", "--size", "32768x32768", "-o", folder.file("a.png")}).code == 5);
    CHECK(run({"sphere:100", "--size", "32768x32768", "--region", "16384,16384,40,30", "-o", folder.file("a.png")}).code == 0);
    CHECK(png_size(content(folder.file("a.png"))) == std::pair{40u, 30u});
    CHECK(run({"sphere:100", "--size", "32768x32768", "--region", "0,0,32768,32768", "-o", folder.file("b.png")}).code == 5);
}
