// halflit --self-test, against pictures that halflit render draws by the same flags. HALFLIT_UPDATE_GOLDEN=1 renews the hashes of
// self_test_scenes.def; the program must be built again after that.
#include "tests/cli/program.hpp"

#include "halflit/isa.hpp"
#include "halflit/version.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/isas.hpp"

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>

using namespace halflit::test;

namespace {

struct Row {
    std::string name, scene, flags, expected;  ///< expected: 16 hexadecimal digits
};

const char* const kRows = HALFLIT_SOURCE_DIR "/apps/halflit/golden/self_test_scenes.def";

std::string digits(unsigned long long hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", hash);
    return text;
}

std::vector<Row> rows() {
    return {
#define HALFLIT_SELF_TEST(name, scene, flags, expected) {name, scene, flags, digits(expected)},
#include "apps/halflit/golden/self_test_scenes.def"
#undef HALFLIT_SELF_TEST
    };
}

/// The hash that the report of halflit render has.
std::string hash_of(const Row& row, const std::string& isa) {
    const TemporaryFolder folder;
    std::vector<std::string> arguments = {"render", row.scene, "--isa", isa, "-o", folder.file("a.png"), "--report", "-", "--quiet"};
    std::istringstream words(row.flags);
    for (std::string word; words >> word;) arguments.push_back(word);
    const Outcome outcome = run(arguments);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const std::string key = "\"pixel_hash\": \"";
    const std::size_t start = outcome.out.find(key);
    REQUIRE(start != std::string::npos);
    return outcome.out.substr(start + key.size(), 16);
}

/// Writes the hash into the row of this name.
void renew(const Row& row, const std::string& found) {
    std::string text = contents(kRows);
    const std::size_t at = text.find("HALFLIT_SELF_TEST(\"" + row.name + "\"");
    REQUIRE(at != std::string::npos);
    const std::size_t end = text.find(')', at);  // the hash is last
    REQUIRE(end != std::string::npos);
    write_contents(kRows, text.replace(end - 16, 16, found));
    std::cout << "renewed: " << row.name << " 0x" << found << '\n';
}

}  // namespace

TEST_CASE("self-test: its hashes are those of halflit render with the same flags", "[cli][self_test]") {
    const bool update = std::getenv("HALFLIT_UPDATE_GOLDEN") != nullptr;
    for (const Row& row : rows()) {
        INFO(row.name << ": " << row.scene << " " << row.flags);
        const std::string found = hash_of(row, "scalar");
        if (update && found != row.expected)
            renew(row, found);
        else
            CHECK(found == row.expected);
    }
}

TEST_CASE("self-test: every scene passes by every instruction set of the machine", "[cli][self_test]") {
    const Outcome outcome = run({"--self-test"});
    INFO(outcome.out);
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    for (const Row& row : rows()) {
        const std::size_t at = outcome.out.find("\n" + row.name + " ");
        REQUIRE(at != std::string::npos);
        const std::string line = outcome.out.substr(at + 1, outcome.out.find('\n', at + 1) - at - 1);
        CHECK(line == row.name + std::string(13 - row.name.size(), ' ') + "ok");
    }
    std::string sets = "\ninstruction sets: ";
    for (const halflit::Isa isa : available_isas()) sets += (sets.back() == ' ' ? "" : ", ") + std::string(halflit::isa_name(isa));
    CHECK(outcome.out.find(sets + "; in use: ") != std::string::npos);
    CHECK(outcome.out.starts_with("halflit " + std::string(halflit::version()) + "\npixel epoch: " + std::to_string(halflit::kPixelEpoch)));
    for (const char* label : {"\nprocessor: ", "\ncompiler: ", "\nsystem: ", "\nthreads: "})
        CHECK(outcome.out.find(label) != std::string::npos);
}

TEST_CASE("self-test: an instruction set that the machine lacks makes it end with 1", "[cli][self_test]") {
    const Outcome outcome = run({"--self-test"}, {.environment = {{"HALFLIT_KERNEL", "mmx"}}});
    INFO(outcome.out);
    CHECK(outcome.code == 1);
    CHECK(outcome.out.find("in use: none, ") != std::string::npos);
}
