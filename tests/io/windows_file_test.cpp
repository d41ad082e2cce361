// Files on Windows: what takes the place of POSIX's rules.
#include "apps/io/files/atomic_file.hpp"
#include "apps/io/platform/files.hpp"
#include "apps/io/platform/paths.hpp"
#include "apps/io/platform/process.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/system.hpp"

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

using namespace halflit;
using namespace halflit::test;
namespace fs = std::filesystem;

namespace {

Result<void> write(const fs::path& path) {
    const std::uint8_t byte = 'x';
    return io::write_file(platform::to_name(path), {&byte, 1});
}

}  // namespace

TEST_CASE("write file on Windows: a file that is marked as read only is not replaced", "[io][windows]") {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.png";
    std::ofstream(file) << "old";
    fs::permissions(file, fs::perms::owner_write, fs::perm_options::remove);
    CHECK(!write(file));
    CHECK(fs::file_size(file) == 3);
    fs::permissions(file, fs::perms::owner_write, fs::perm_options::add);
    CHECK(write(file));
    CHECK(fs::file_size(file) == 1);
}

TEST_CASE("write file on Windows: what a killed process left is removed after an hour, and what a living one writes is not",
          "[io][windows]") {
    const TemporaryFolder folder;
    const auto left = [&](const std::string& process, int hours) {
        const fs::path path = folder / (".a.png.halflit-" + process + ".tmp");
        std::ofstream(path) << "half";
        fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(hours));
        return path;
    };
    // Numbers of processes are multiples of four.
    const fs::path dead = left("99999998", 2), fresh = left("99999994", 0), other = folder / ".b.png.halflit-99999998.tmp";
    std::ofstream(other) << "half";
    fs::last_write_time(other, fs::file_time_type::clock::now() - std::chrono::hours(2));
    CHECK(write(folder / "a.png"));
    CHECK(!fs::exists(dead));
    CHECK(fs::exists(fresh));
    CHECK(platform::may_be_running(platform::process_id()));
    CHECK(!platform::may_be_running(99999998));
    CHECK(fs::exists(other));
}

TEST_CASE("paths on Windows: separators, drives and what is no file of this machine", "[io][windows]") {
    using namespace platform;
    CHECK(last_separator("a\\b/c") == 3);
    CHECK(last_separator("a/b\\c") == 3);
    CHECK(is_absolute("C:/x"));
    CHECK(is_absolute("C:\\x"));
    CHECK(is_absolute("/x"));
    CHECK(!is_absolute("C:x"));
    CHECK(!is_absolute("x/C:/y"));
    CHECK(fault_of_path("C:/models/a.glb").empty());
    CHECK(fault_of_path("models/a.glb").empty());
    for (const char* path :
         {"//server/share/a.glb", "//./COM1", "//?/C:/a.glb", "C:a.glb", "NUL", "models/con.glb", "a.glb:stream", "a.glb."}) {
        INFO(path);
        CHECK(!fault_of_path(path).empty());
    }
}

TEST_CASE("paths on Windows: the whole path has the disk's own letters, also of what is not there", "[io][windows]") {
    const TemporaryFolder folder;
    fs::create_directory(folder / "Sub");
    const std::string top = platform::real_path(folder.path());
    CHECK(platform::whole_path(folder.file("sub")) == top + "/Sub");
    CHECK(platform::whole_path(folder.file("sub/../SUB/none/x.png")) == top + "/Sub/none/x.png");
    platform::FileStatus first, second;
    CHECK(platform::status_of(folder.file("sub"), first) == 0);
    CHECK(platform::status_of(folder.file("SUB"), second) == 0);
    CHECK(first.id == second.id);
    CHECK(platform::status_of(folder.file("none"), first) == ENOENT);
}
