#include "tests/support/skip.hpp"

namespace halflit::test {

std::vector<std::string>& skipped_tests() {
    static std::vector<std::string> tests;
    return tests;
}

}  // namespace halflit::test
