// The floating-point environment and the compiler flags of a host change no pixel, from the file on.
#include "apps/io/platform/process.hpp"
#include "halflit/auto_setup.hpp"
#include "halflit/image.hpp"
#include "tests/io/host_picture.hpp"
#include "tests/io/rich_file.hpp"
#include "tests/support/assets.hpp"

#include "tests/support/catch.hpp"

#include <cfenv>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <system_error>
#include <vector>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace halflit::test {
namespace {

/// Up to 21 models: those of the assets if they are here, and one of the test's own.
std::vector<std::string> models() {
    static const struct OwnFile {
        std::filesystem::path path = std::filesystem::temp_directory_path() /
                                     ("halflit_host_flags_" + std::to_string(platform::process_id()) + ".glb");  // tests run side by side
        ~OwnFile() {
            std::error_code ignored;
            std::filesystem::remove(path, ignored);
        }
    } file_of_test;
    const std::filesystem::path& own = file_of_test.path;
    const Bytes file = rich_file();
    std::ofstream(own, std::ios::binary).write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
    std::vector<std::string> paths{own.string()};
    if (const auto folder = asset_dir()) {
        std::map<std::uintmax_t, std::string> by_size;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder / "models"))
            if (const auto ending = entry.path().extension(); ending == ".glb" || ending == ".gltf")
                by_size[entry.file_size()] = entry.path().string();
        for (const auto& [size, path] : by_size)
            if (paths.size() < 21) paths.push_back(path);
    }
    return paths;
}

/// The host's floating-point environment, whole: the C library of mingw-w64 leaves out the bits of flushed denormals.
class SavedEnvironment {
public:
    SavedEnvironment() { std::fegetenv(&saved_); }
    void put_back() const {
        std::fesetenv(&saved_);
#if defined(__SSE__)
        _mm_setcsr(csr_);
#endif
    }

private:
    std::fenv_t saved_{};
#if defined(__SSE__)
    unsigned csr_ = _mm_getcsr();
#endif
};

struct Mode {
    const char* name;
    std::function<void()> set;
};

std::vector<Mode> modes() {
    std::vector<Mode> all;
    for (const auto& [name, mode] : {std::pair{"upward", FE_UPWARD}, {"downward", FE_DOWNWARD}, {"toward zero", FE_TOWARDZERO}})
        all.push_back({name, [mode = mode] { std::fesetround(mode); }});
#if defined(__SSE__)
    all.push_back({"flush to zero", [] { _mm_setcsr(_mm_getcsr() | 0x8040); }});
#endif
    return all;
}

}  // namespace

TEST_CASE("host: rounding modes and flushed denormals change no pixel, from the file on", "[io][host]") {
    int drawn = 0;
    for (const std::string& path : models()) {
        INFO(path);
        const std::uint64_t expected = picture_of_usual_host(path);
        drawn += expected != 0 ? 1 : 0;
        for (const Mode& mode : modes()) {
            INFO(mode.name);
            const SavedEnvironment before;
            mode.set();
            const int rounding = std::fegetround();
            const std::uint64_t found = picture_of_usual_host(path);
            const int rounding_after = std::fegetround();
            before.put_back();
            CHECK(found == expected);
            CHECK(rounding_after == rounding);
        }
    }
    CHECK(drawn >= 1);
}

TEST_CASE("host: an environment's picture is the same in every rounding mode", "[io][host]") {
    const auto level = [] { return environment_level(*make_environment(built_in_sky()).value()); };
    const double expected = level();
    for (const Mode& mode : modes()) {
        INFO(mode.name);
        const SavedEnvironment before;
        mode.set();
        const double found = level();
        before.put_back();
        CHECK(found == expected);
    }
}

TEST_CASE("host: the usual settings are the same in every rounding mode", "[io][host]") {
    const Settings expected = usual_settings();
    for (const Mode& mode : modes()) {
        INFO(mode.name);
        const SavedEnvironment before;
        mode.set();
        const Settings found = usual_settings();
        before.put_back();
        CHECK(found.background_linear.x == expected.background_linear.x);
        CHECK(found.background_linear.y == expected.background_linear.y);
        CHECK(found.background_linear.z == expected.background_linear.z);
    }
}

TEST_CASE("host: -Ofast in a host's own code changes no pixel", "[io][host]") {
    int drawn = 0;
    for (const std::string& path : models()) {
        INFO(path);
        const std::uint64_t expected = picture_of_usual_host(path);
        drawn += expected != 0 ? 1 : 0;
        CHECK(picture_of_fast_host(path) == expected);
    }
    CHECK(drawn >= 1);
}

}  // namespace halflit::test
