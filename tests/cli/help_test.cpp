// Help texts, manual pages and completions, which are made from one set of tables.
#include "tests/cli/mcp_server.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>

using namespace halflit::test;

namespace {

std::size_t longest_line(const std::string& text) {
    std::istringstream lines(text);
    std::size_t longest = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.ends_with('\r')) line.pop_back();
        longest = std::max(longest, line.size());
    }
    return longest;
}

using Words = std::vector<std::string>;

/// Commands that have the flags of a picture.
const Words kManyFlags{"render", "look", "compare", "info", "view", "sheet", "explain", "bench", "trade"};

void check_page(const std::string& page) {
    INFO(page);
    CHECK(longest_line(page) <= 80);
    CHECK(lines_of(page).size() <= 25);
    CHECK(!contains(page, "\n" + std::string(30, ' ')));  // where --help-all goes on with an explanation
}

/// Long names of the flags that have a line.
Words flags_of_help(const std::string& help) {
    Words flags;
    for (const std::string& line : lines_of(help)) {
        const std::size_t at = line.find("--");
        if (line.starts_with("  -") && !line.starts_with("  --help")) flags.push_back(line.substr(at, line.find_first_of(" \r", at) - at));
    }
    return flags;
}

}  // namespace

TEST_CASE("help: it folds to the width of the terminal or of COLUMNS, up to 120", "[cli][help]") {
    for (const std::string command : {"render", "bench", "trade"}) {
        INFO(command);
        CHECK(longest_line(run({command, "--help-all"}).out) <= 80);
        if (abilities().terminals) CHECK(longest_line(run({command, "--help-all"}, {.terminal_columns = 90}).out) <= 90);
        CHECK(longest_line(run({command, "--help-all"}, {.environment = {{"COLUMNS", "100"}}}).out) <= 100);
        const std::size_t wide = longest_line(run({command, "--help-all"}, {.environment = {{"COLUMNS", "1000"}}}).out);
        CHECK(wide <= 120);
        CHECK(wide > 80);
    }
}

TEST_CASE("help: --help is a page of 25 lines of 80 columns, and each flag has one line", "[cli][help]") {
    check_page(run({"--help"}).out);
    for (const std::string& command : kManyFlags) {
        INFO(command);
        const std::string page = run({command, "--help"}).out, all = run({command, "--help-all"}).out;
        check_page(page);
        CHECK(contains(page, "halflit " + command + " --help-all"));
        CHECK(contains(all, "--max-json-depth"));
        CHECK(!contains(page, "--max-json-depth"));
        const std::vector<std::string> flags = flags_of_help(page), known = flags_of_help(all);
        CHECK(flags.size() >= 8);
        CHECK(flags.size() <= 10);
        for (const std::string& flag : flags) {
            INFO(flag);
            CHECK(std::find(known.begin(), known.end(), flag) != known.end());
        }
    }
}

TEST_CASE("help: the program's help lists seven commands, --help-all every one", "[cli][help]") {
    const std::string page = run({"--help"}).out, all = run({"--help-all"}).out;
    for (const char* const name : {"render", "look", "compare", "info", "diff", "golden"})
        CHECK(contains(page, std::string("\n  ") + name + " "));
    CHECK(contains(page, "\n  view ") == contains(all, "\n  view "));
    CHECK(contains(page, "halflit --help-all"));
    for (const char* const name : {"bench", "sheet", "explain", "merge", "lobe", "env", "trade", "mcp"}) {
        INFO(name);
        CHECK(!contains(page, std::string("\n  ") + name + " "));
        CHECK(contains(all, std::string("\n  ") + name + " "));
    }
    for (const char* part : {"halflit man", "halflit completion", "halflit flags", "--self-test"}) CHECK(contains(all, part));
}

TEST_CASE("help: the examples work", "[cli][help]") {
    const TemporaryFolder folder;
    for (const char* const name : {"part.stl", "old.stl"}) write_contents(folder.file(name), box_stl(10, 10, 10));
    write_contents(folder.file("new.stl"), box_stl(10, 12, 10));
    write_contents(folder.file("model.glb"), contents(HALFLIT_SOURCE_DIR "/apps/examples/knot.glb"));
    for (const char* const name : {"models", "expected", "drawn"}) std::filesystem::create_directory(folder.file(name));
    write_contents(folder.file("models/part.stl"), box_stl(10, 10, 10));
    for (const char* const name : {"old.png", "new.png", "expected/a.png", "drawn/a.png"})
        write_contents(folder.file(name), png_of(1, 1, {10, 20, 30, 255}));
    int examples = 0;
    for (const std::string command : {"", "render", "look", "compare", "info", "diff", "golden", "sheet", "explain"}) {
        for (const std::string& line : lines_of(run(command.empty() ? Words{"--help"} : Words{command, "--help"}).out)) {
            if (!line.starts_with("  halflit ")) continue;
            ++examples;
            if (HALFLIT_HAS_WEBP_FILMS == 0 && contains(line, ".webp")) continue;
            const Outcome outcome = run(words_of_line(line), {.folder = folder.path()});
            INFO(line << "\n" << outcome.err);
            CHECK(outcome.code == (command == "compare" ? 1 : 0));  // versions differ
        }
    }
    CHECK(examples == 27);
}

TEST_CASE("help: docs/flags.md is the output of the program", "[cli][help]") {
    const std::string page = contents(HALFLIT_SOURCE_DIR "/docs/flags.md");
    CHECK(page.size() > 1000);
    CHECK(run({"flags", "--markdown"}).out == page);
}

TEST_CASE("help: manual pages and completions have every flag of the help", "[cli][help]") {
    const std::string help = run({"render", "--help-all"}).out, manual = run({"man", "render"}).out;
    const std::string bash = run({"completion", "bash"}).out, zsh = run({"completion", "zsh"}).out, fish = run({"completion", "fish"}).out;
    CHECK(run({"completion", "csh"}).code == 2);
    CHECK(run({"man"}).out.starts_with(".TH HALFLIT 1\n"));
    int flags = 0;
    std::istringstream words(help);
    for (std::string word; words >> word;) {
        if (!word.starts_with("--") || word.find_first_of(".,;:'") != std::string::npos || word.starts_with("--help")) continue;
        INFO(word);
        ++flags;
        std::string escaped;
        for (const char c : word) escaped += c == '-' ? std::string("\\-") : std::string(1, c);
        CHECK(contains(manual, escaped));
        CHECK(contains(bash, word));
        CHECK(contains(zsh, word));
        CHECK(contains(fish, " -l " + word.substr(2) + " "));
    }
    CHECK(flags > 40);
}
