#include "tests/support/system.hpp"

#include "tests/support/catch.hpp"

#include <random>

namespace halflit::test {

std::filesystem::path new_folder() {
    static std::random_device random;
    for (;;) {
        auto path = std::filesystem::temp_directory_path() / ("halflit-test-" + std::to_string(random()));
        std::error_code error;
        if (std::filesystem::create_directory(path, error)) return path;
        REQUIRE(!error);  // otherwise the name is taken
    }
}

}  // namespace halflit::test
