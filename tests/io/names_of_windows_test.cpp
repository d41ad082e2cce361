// The rules by which names of a model's files are refused on Windows. They are text alone, so they are tested on every system.
#include "apps/io/platform/windows/names.hpp"

#include "tests/support/catch.hpp"

#include <string>

using halflit::platform::fault_of_part;
using halflit::platform::fault_of_parts;

TEST_CASE("names of Windows: ordinary names pass, also those that look like devices", "[io][windows]") {
    for (const char* name :
         {"a.bin", "with space.png", "\xC3\xA9\xE2\x82\xAC.png", ".hidden", "a.b.c", "..a", "CONSOLE.png", "COM.png", "COM10.txt", "LPTX",
          "NULL", "auxiliary.bin", "a+b=c;d,e@f[g]{h}'i~1!.png", "sub/deep/x.png", "./a", "../a", "a/"}) {
        INFO(name);
        CHECK(fault_of_parts(name).empty());
    }
}

TEST_CASE("names of Windows: devices are found in any case, with any extension and with spaces before it", "[io][windows]") {
    for (const std::string device : {"CON", "PRN", "AUX", "NUL", "COM0", "COM1", "COM9", "LPT0", "LPT1", "LPT9", "COM\xC2\xB9",
                                     "LPT\xC2\xB3", "CONIN$", "CONOUT$", "CLOCK$", "con", "nUl", "com3"})
        for (const std::string ending : {"", ".png", ".tar.gz", " .png", "   .x"}) {
            INFO(device + ending);
            CHECK(fault_of_part(device + ending) == "names a device of Windows");
            CHECK(!fault_of_parts("textures/" + device + ending).empty());
            CHECK(!fault_of_parts(device + ending + "/x.png").empty());
        }
}

TEST_CASE("names of Windows: streams, drives, other separators, wildcards and names that Windows shortens are refused", "[io][windows]") {
    for (const char* name : {"a.bin:stream", "a.bin::$DATA", ":x",  "C:a.bin", "C:",  "c:/a.bin", "a\\b",   "\\\\server\\share",
                             "\\\\?\\C:\\a", "a?",           "a*",  "a<b",     "a>b", "a|b",      "a\"b",   "a\x01",
                             "a\x1f.png",    "a.",           "a..", "a ",      "a. ", "... ",     "sub./x", "sub /x"}) {
        INFO(name);
        CHECK(!fault_of_parts(name).empty());
    }
}
