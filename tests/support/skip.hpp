// Skipped tests: a test that needs something the machine lacks is reported as skipped, never as passed.
#pragma once

#include <string>
#include <vector>

namespace halflit::test {

/// "test: reason" of each test that was skipped in this process.
std::vector<std::string>& skipped_tests();

}  // namespace halflit::test

/// Ends the test case as skipped: HALFLIT_SKIP("no AVX2 on this CPU"). Use it only in the body of a test case, before any section and
/// outside of sections. ctest lists the test as skipped; a program that runs many tests prints a line for each.
#define HALFLIT_SKIP(reason)                                                                                                       \
    do {                                                                                                                           \
        ::halflit::test::skipped_tests().push_back(::Catch::getResultCapture().getCurrentTestName() + ": " + std::string(reason)); \
        SUCCEED("skipped");                                                                                                        \
        return;                                                                                                                    \
    } while (false)
