// The self-test of the program with tables that are wrong.
#include "apps/halflit/golden/self_test.hpp"
#include "tests/support/catch.hpp"

#include <cstdio>

using namespace halflit::cli;

TEST_CASE("self-test: a picture of another hash is named with both hashes, and the test fails", "[self_test]") {
    const SelfTestScene right = self_test_scenes().back();
    SelfTestScene wrong = right;
    wrong.expected ^= 1;
    const SelfTestScene table[] = {right, wrong};
    const SelfTest test = run_self_test(table);
    INFO(test.text);
    CHECK(!test.passed);
    char line[100];
    std::snprintf(line, sizeof line, "DIFFERENT expected %016llx found %016llx by scalar\n",
                  static_cast<unsigned long long>(wrong.expected), static_cast<unsigned long long>(right.expected));
    CHECK(test.text.find(line) != std::string::npos);
    CHECK(test.text.find(" ok\n") != std::string::npos);
}

TEST_CASE("self-test: a scene that cannot be drawn fails with its error", "[self_test]") {
    const SelfTestScene table[] = {{"huge", "sphere:1", "--size 8x8", 0}};
    const SelfTest test = run_self_test(table);
    CHECK(!test.passed);
    CHECK(test.text.find("FAILED ") != std::string::npos);
}
