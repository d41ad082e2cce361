// Runner of all test programs: Catch2's, with exit codes that ctest can tell apart. Catch2 2 returns the number of failed assertions, which
// could equal the code for "skipped".
#define CATCH_CONFIG_RUNNER
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

#include <cstdio>

namespace {

constexpr int kFailed = 1;
constexpr int kSkipped = 4;  // SKIP_RETURN_CODE in tests/CMakeLists.txt

int tests_run = 0;

#if CATCH_VERSION_MAJOR >= 3
using Listener = Catch::EventListenerBase;
constexpr auto kNoTests = Catch::WarnAbout::UnmatchedTestSpec;
#else
using Listener = Catch::TestEventListenerBase;
constexpr auto kNoTests = Catch::WarnAbout::NoTests;
#endif

class CountTests : public Listener {
public:
    using Listener::Listener;
    void testCaseStarting(const Catch::TestCaseInfo&) override { ++tests_run; }
};
CATCH_REGISTER_LISTENER(CountTests)

}  // namespace

int main(int argc, char** argv) {
    Catch::Session session;
    // A test that compares nothing, and a filter that finds no test, fail.
    session.configData().warnings = static_cast<Catch::WarnAbout::What>(Catch::WarnAbout::NoAssertions | kNoTests);
    if (session.applyCommandLine(argc, argv) != 0) return kFailed;
    if (session.run() != 0) return kFailed;
    const auto& skipped = halflit::test::skipped_tests();
    for (const std::string& line : skipped) std::printf("skipped: %s\n", line.c_str());
    return !skipped.empty() && static_cast<int>(skipped.size()) == tests_run ? kSkipped : 0;
}
