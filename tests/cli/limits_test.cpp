// --timeout and --max-memory, and pictures of which only a part is drawn.
#include "tests/cli/program.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <fstream>
#include <sstream>

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
    const TemporaryFolder folder;
    const Outcome outcome = run({"sphere:1000000", "--max-memory", "64", "-o", folder.file("a.png"), "--report", folder.file("a.json")});
    CHECK(outcome.code == 5);
    CHECK(outcome.err.find("memory") != std::string::npos);
    CHECK(outcome.err.find("--max-memory") != std::string::npos);
    CHECK(folder.names() == std::vector<std::string>{"a.json"});
    CHECK(run({"sphere:1000000", "--size", "64x64", "--max-memory", "1000", "-o", folder.file("b.png")}).code == 0);
    CHECK(run({"demo", "--max-memory", "31"}).code == 2);
}

TEST_CASE("limits: of a picture with more pixels than an image may have, a region is drawn", "[cli]") {
    const TemporaryFolder folder;
    CHECK(run({"sphere:100", "--size", "32768x32768", "-o", folder.file("a.png")}).code == 5);
    CHECK(run({"sphere:100", "--size", "32768x32768", "--region", "16384,16384,40,30", "-o", folder.file("a.png")}).code == 0);
    CHECK(png_size(content(folder.file("a.png"))) == std::pair{40u, 30u});
    CHECK(run({"sphere:100", "--size", "32768x32768", "--region", "0,0,32768,32768", "-o", folder.file("b.png")}).code == 5);
}
