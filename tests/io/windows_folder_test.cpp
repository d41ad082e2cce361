// A model's folder on Windows: names that lead elsewhere there.
#include "apps/io/files/file_access.hpp"
#include "apps/io/platform/files.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/system.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

using namespace halflit;
using namespace halflit::io;
using namespace halflit::test;
namespace fs = std::filesystem;

TEST_CASE("model folder on Windows: devices, streams, drives, other computers and changed names are refused as such", "[io][windows]") {
    const TemporaryFolder folder;
    folder.write("a.bin", "abc");
    folder.write("sub/b.bin", "abc");
    ModelFolder model(folder.path());
    REQUIRE(model.read("a.bin", 100));
    for (const std::string& name : std::vector<std::string>{"CON",
                                                            "con.txt",
                                                            "NUL",
                                                            "nul .png",
                                                            "AUX.bin",
                                                            "PRN",
                                                            "COM1",
                                                            "com\xC2\xB9.txt",
                                                            "LPT9.x",
                                                            "CONIN$",
                                                            "sub/NUL",
                                                            "NUL/x",
                                                            "a.bin::$DATA",
                                                            "a.bin:stream",
                                                            "sub:x/b.bin",
                                                            "C:a.bin",
                                                            "C:/windows/win.ini",
                                                            "c:",
                                                            folder.path() + "/a.bin",
                                                            "//server/share/a.bin",
                                                            "//?/C:/windows/win.ini",
                                                            "//./pipe/x",
                                                            "\\\\server\\share\\a.bin",
                                                            "\\\\?\\C:\\windows\\win.ini",
                                                            "\\a.bin",
                                                            "sub\\b.bin",
                                                            "/a.bin",
                                                            "a.bin.",
                                                            "a.bin ",
                                                            "sub./b.bin",
                                                            "sub /b.bin",
                                                            "a?bin",
                                                            "*.bin",
                                                            "a.bin\x01"}) {
        INFO(name);
        const auto read = model.read(name, 100);
        REQUIRE(!read);
        CHECK(read.error().code == ErrorCode::bad_input);
        CHECK(read.error().message.find("no such file") == std::string::npos);
        std::string found;
        const auto alike = model.read_like(name, 100, found);
        // The last part of a name of another computer may lie beside the model; no other file is read.
        if (alike) CHECK((found == "a.bin" || found == "sub/b.bin" || found == "b.bin" || found == "win.ini"));
    }
}

TEST_CASE("model folder on Windows: letters of another case and names in UTF-8 lead to the same file", "[io][windows]") {
    const TemporaryFolder folder;
    folder.write("Sub/A.bin", "abc");
    folder.write("\xC3\xA9t\xC3\xA9/\xE4\xBD\xA0\xF0\x9F\x8E\xA8.bin", "defg");
    ModelFolder model(folder.path());
    CHECK(model.read("sub/a.BIN", 100)->size() == 3);
    CHECK(model.read("\xC3\xA9t\xC3\xA9/\xE4\xBD\xA0\xF0\x9F\x8E\xA8.bin", 100)->size() == 4);
    CHECK(!model.read("\xC3\xA9t\xC3\xA9/\xFF.bin", 100));  // no UTF-8
    CHECK(read_file(folder.path() + "/\xC3\xA9t\xC3\xA9/\xE4\xBD\xA0\xF0\x9F\x8E\xA8.bin")->size() == 4);
}

TEST_CASE("model folder on Windows: the folder may be named with backslashes, and of the root of a drive nothing above it is read",
          "[io][windows]") {
    const TemporaryFolder folder;
    folder.write("models/a.bin", "abc");
    folder.write("secret.bin", "secret");
    ModelFolder model((folder / "models").string() + "\\");
    CHECK(model.read("a.bin", 100)->size() == 3);
    CHECK(model.read("../models/a.bin", 100)->size() == 3);
    CHECK(!model.read("../secret.bin", 100));
    CHECK(!model.read("../MODELS-of-others/a.bin", 100));
    CHECK(folder_of("C:/a.glb") == "C:/");
    CHECK(folder_of("models\\a.glb") == "models");
}

TEST_CASE("model folder on Windows: no junction and no symbolic link is followed, also where it stays inside", "[io][windows]") {
    const TemporaryFolder outside, folder;
    outside.write("secret.bin", "secret");
    folder.write("sub/a.bin", "abc");
    const std::string line =
        "cmd /c mklink /J \"" + (folder / "door").string() + "\" \"" + fs::path(outside.path()).make_preferred().string() + "\" >NUL 2>&1";
    (void)std::system(line.c_str());
    const bool has_junction = platform::is_link((folder / "door").string());
    const bool has_link = make_link(outside / "secret.bin", folder / "link.bin");
    if (!has_junction && !has_link) HALFLIT_SKIP("this system makes neither junctions nor symbolic links");
    (void)make_link("sub", folder / "inside");
    ModelFolder model(folder.path(), {outside.path()});
    for (const char* name : {"door/secret.bin", "link.bin", "inside/a.bin", "sub/../link.bin"}) {
        INFO(name);
        CHECK(!model.read(name, 100));
    }
    CHECK(model.read("sub/a.bin", 100)->size() == 3);
}
