// Runner of all test programs: Catch2's, with exit codes that ctest can tell apart. Catch2 2 returns the number of failed assertions, which
// could equal the code for "skipped".
#define CATCH_CONFIG_RUNNER
#include "tests/support/skip.hpp"

#include <catch2/catch.hpp>

#include <cstdio>

namespace {

constexpr int kFailed = 1;
constexpr int kSkipped = 4;  // SKIP_RETURN_CODE in tests/CMakeLists.txt

int tests_run = 0;

class CountTests : public Catch::TestEventListenerBase {
public:
    using TestEventListenerBase::TestEventListenerBase;
    void testCaseStarting(const Catch::TestCaseInfo&) override { ++tests_run; }
};
CATCH_REGISTER_LISTENER(CountTests)

}  // namespace

int main(int argc, char** argv) {
    Catch::Session session;
    // A test that compares nothing, and a filter that finds no test, fail.
    session.configData().warnings = static_cast<Catch::WarnAbout::What>(Catch::WarnAbout::NoAssertions | Catch::WarnAbout::NoTests);
    if (session.applyCommandLine(argc, argv) != 0) return kFailed;
    if (session.run() != 0) return kFailed;
    const auto& skipped = halflit::test::skipped_tests();
    for (const std::string& line : skipped) std::printf("skipped: %s\n", line.c_str());
    return !skipped.empty() && static_cast<int>(skipped.size()) == tests_run ? kSkipped : 0;
}
