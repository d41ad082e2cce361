// halflit playground: the page that the program carries, or what is missing.
#include "tests/cli/program.hpp"

#include "tests/support/catch.hpp"

#include <filesystem>

using namespace halflit::test;

TEST_CASE("playground: writes the page, or says what the program was built without", "[cli]") {
    const TemporaryFolder folder;
    const std::string output = folder.file("page.html");
    const auto result = run({"playground", "-o", output});
    if (result.code == 0) {
        CHECK(contents(output).starts_with("<!doctype html>"));
        CHECK(run({"playground", "-o", "-"}).out == contents(output));
        return;
    }
    CHECK(result.code == 4);
    CHECK(result.err.find("HALFLIT_PLAYGROUND_PAGE") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(output));
}
