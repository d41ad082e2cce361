#include "tests/support/system.hpp"

#include "apps/io/platform/paths.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>

namespace halflit::test {
namespace {

namespace fs = std::filesystem;

fs::path new_folder() {
    static std::random_device random;
    for (;;) {
        auto path = fs::temp_directory_path() / ("halflit-test-" + std::to_string(random()));
        std::error_code error;
        if (fs::create_directory(path, error)) return path;
        REQUIRE(!error);  // otherwise the name is taken
    }
}

}  // namespace

TemporaryFolder::TemporaryFolder() : path_(new_folder()) {}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

std::string TemporaryFolder::path() const { return platform::to_name(path_); }

std::string TemporaryFolder::file(const std::string& name) const { return platform::to_name(*this / name); }

fs::path TemporaryFolder::operator/(const std::string& name) const { return path_ / platform::to_path(name); }

std::vector<std::string> TemporaryFolder::names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_)) names.push_back(platform::to_name(entry.path().filename()));
    std::sort(names.begin(), names.end());
    return names;
}

void TemporaryFolder::write(const std::string& name, std::string_view text) const {
    const fs::path file = *this / name;
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    REQUIRE(fs::file_size(file) == text.size());
}

std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace halflit::test
