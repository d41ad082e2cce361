// Pages for agents: docs/SKILL.md and llms.txt.
#include "tests/cli/mcp_server.hpp"

#include "tests/support/catch.hpp"

#include <filesystem>
#include <sstream>

using namespace halflit::test;

namespace {

const std::string kRoot = HALFLIT_SOURCE_DIR;

}  // namespace

TEST_CASE("agent pages: docs/SKILL.md and llms.txt are the output of the program", "[cli][help]") {
    CHECK(run({"flags", "--skill"}).out == contents(kRoot + "/docs/SKILL.md"));
    CHECK(run({"flags", "--llms"}).out == contents(kRoot + "/llms.txt"));
    CHECK(contents(kRoot + "/llms.txt").starts_with("# halflit\n\n> "));
    CHECK(contents(kRoot + "/docs/SKILL.md").starts_with("---\nname: halflit\ndescription: "));
}

TEST_CASE("agent pages: llms.txt names every page of docs, and no file that is not there", "[cli][help]") {
    const std::string page = contents(kRoot + "/llms.txt");
    int links = 0;
    for (std::size_t at = page.find("]("); at != std::string::npos; at = page.find("](", at + 1)) {
        const std::string path = page.substr(at + 2, page.find_first_of("#)", at + 2) - at - 2);
        INFO(path);
        CHECK(std::filesystem::is_regular_file(kRoot + "/" + path));
        ++links;
    }
    CHECK(links > 20);
    for (const auto& entry : std::filesystem::directory_iterator(kRoot + "/docs")) {
        if (entry.path().extension() != ".md") continue;
        INFO(entry.path().string());
        CHECK(page.find("(docs/" + entry.path().filename().string() + ")") != std::string::npos);
    }
}

TEST_CASE("agent pages: the command lines of docs/SKILL.md work", "[cli][help]") {
    const TemporaryFolder folder;
    write_contents(folder.file("part.stl"), box_stl(10, 10, 10));
    write_contents(folder.file("old.stl"), box_stl(10, 10, 10));
    write_contents(folder.file("new.stl"), box_stl(10, 12, 10));
    write_contents(folder.file("assembly.gltf"), assembly_gltf());
    std::istringstream page(contents(kRoot + "/docs/SKILL.md"));
    int lines = 0;
    for (std::string line; std::getline(page, line);) {
        if (!line.starts_with("    halflit ")) continue;
        const std::vector<std::string> words = words_of_line(line);
        const Outcome outcome = run(words, {.folder = folder.path()});
        INFO(line << "\n" << outcome.err);
        // Versions differ.
        const bool negative = words[0] == "compare";
        CHECK(outcome.code == (negative ? 1 : 0));
        ++lines;
    }
    CHECK(lines > 10);
    for (const char* const name :
         {"look.png", "look.json", "certificate.json", "cut.png", "compare.json", "comment.md", "sides.png", "close.png"})
        CHECK(std::filesystem::file_size(folder.file(name)) > 0);
}
