// Help texts, manual pages and completions, which are made from one set of tables.
#include "tests/cli/program.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
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

}  // namespace

TEST_CASE("help: it folds to the width of the terminal or of COLUMNS, up to 120", "[cli][help]") {
    for (const std::string command : {"render", "bench", "trade"}) {
        INFO(command);
        CHECK(longest_line(run({command, "--help"}).out) <= 80);
        if (abilities().terminals) CHECK(longest_line(run({command, "--help"}, {.terminal_columns = 90}).out) <= 90);
        CHECK(longest_line(run({command, "--help"}, {.environment = {{"COLUMNS", "100"}}}).out) <= 100);
        const std::size_t wide = longest_line(run({command, "--help"}, {.environment = {{"COLUMNS", "1000"}}}).out);
        CHECK(wide <= 120);
        CHECK(wide > 80);
    }
}

TEST_CASE("help: limits are shown by --help-all alone", "[cli][help]") {
    CHECK(!contains(run({"render", "--help"}).out, "--max-json-depth"));
    CHECK(contains(run({"render", "--help"}).out, "--help-all"));
    CHECK(contains(run({"render", "--help-all"}).out, "--max-json-depth"));
}

TEST_CASE("help: the program's help names the commands that its list leaves out, and --self-test", "[cli][help]") {
    const std::string help = run({"--help"}).out;
    for (const char* part : {"halflit man", "halflit completion", "halflit flags", "--self-test"}) CHECK(contains(help, part));
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
