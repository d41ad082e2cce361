#include "apps/io/files/atomic_file.hpp"

#include "apps/io/files/file_access.hpp"
#include "apps/io/platform/files.hpp"
#include "apps/io/platform/handles.hpp"
#include "apps/io/platform/paths.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/system.hpp"

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

using namespace halflit;
using namespace halflit::io;
using namespace halflit::test;
namespace fs = std::filesystem;

namespace {

Result<void> write(const std::string& path, std::string_view text) {
    return write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string text_of(const std::string& path) {
    const auto bytes = read_file(path);
    REQUIRE(bytes);
    return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

}  // namespace

TEST_CASE("write file: a new file and one that is replaced have the bytes, and nothing else is left", "[io]") {
    const TemporaryFolder folder;
    for (const std::string name : {"a.png", "\xC3\xA9\xE4\xBD\xA0\xF0\x9F\x8E\xA8.png", "with space"}) {
        INFO(name);
        const std::size_t before = folder.names().size();
        for (const std::string text : {"first", "", "the second\r\n\x1a is longer\n"}) {
            REQUIRE(write(folder.file(name), text));
            CHECK(text_of(folder.file(name)) == text);
            CHECK(folder.names().size() == before + 1);
        }
    }
}

TEST_CASE("write file: who reads the old file while it is replaced reads it to its end", "[io]") {
    if (!abilities().replaces_open_files) HALFLIT_SKIP("files that are open are not replaced here");
    const TemporaryFolder folder;
    REQUIRE(write(folder.file("a"), "the old one"));
    const platform::Handle old = platform::open_to_read(folder.file("a"));
    REQUIRE(old.is_open());
    std::array<char, 32> part{};
    REQUIRE(platform::read_some(old.get(), part.data(), 4) == 4);
    REQUIRE(write(folder.file("a"), "new"));
    CHECK(text_of(folder.file("a")) == "new");
    CHECK(platform::read_some(old.get(), part.data() + 4, 20) == 7);
    CHECK(std::string(part.data()) == "the old one");
}

TEST_CASE("write file: a path of more than 260 letters is written and read", "[io]") {
    const TemporaryFolder folder;
    std::string name;
    for (int i = 0; i < 12; ++i) name += (i == 0 ? "" : "/") + std::string(30, static_cast<char>('a' + i));
    std::error_code error;
    // The standard library has its own limit on Windows.
    std::string made = folder.file("");
    for (std::size_t at = 0; at < name.size(); at += 31) {
        const std::string below = folder.file(name.substr(0, at + 30));
        fs::create_directory(platform::to_path(below), error);
        if (error) break;
        made = below + "/";
    }
    const std::string file = made + std::string(100, 'x');
    REQUIRE(write(file, "far down"));
    CHECK(text_of(file) == "far down");
    REQUIRE(write(file, "far down again"));
    CHECK(text_of(file) == "far down again");
}

TEST_CASE("write file: a folder, and a file in a folder that is not there, are io errors that name the path", "[io]") {
    const TemporaryFolder folder;
    for (const std::string& path : {folder.file(""), folder.path(), folder.file("none/a.png")}) {
        INFO(path);
        const auto written = write(path, "x");
        REQUIRE(!written);
        CHECK(written.error().code == ErrorCode::io);
        CHECK(written.error().message.starts_with(path));
    }
    CHECK(!write("", "x"));
    CHECK(folder.names().size() == 0);
}
