// Importers: programs that turn files into glTF, what they may do, and how their failures are told.
#include "halflit/model.hpp"

#include "tests/io/gltf_builder.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/system.hpp"

#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

using namespace halflit;
using namespace halflit::test;
using Catch::Contains;

namespace {

constexpr const char* kOdd = HALFLIT_ODD_IMPORTER;

LoadOptions by_odd() {
    LoadOptions options;
    options.importers = {{".odd", kOdd}};
    return options;
}

/// The error of a file whose importer does as its first line says.
Error error_of(const std::string& order, const LoadOptions& options = by_odd()) {
    const auto loaded = load_model_bytes(to_bytes(order + "\n"), "x.odd", "", options);
    return loaded ? Error{ErrorCode::internal, "was loaded"} : loaded.error();
}

/// True where the kernel filters calls, which qemu and some containers do not.
bool has_seccomp() {
#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__))
    const std::uint32_t action = 0x00050000;  // an error
    return ::syscall(SYS_seccomp, 2 /* is it there */, 0, &action) == 0;
#else
    return false;
#endif
}

bool has_landlock() { return ::syscall(444, nullptr, 0, 1) >= 1; }

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

TEST_CASE("importer: its glTF is the scene, in bytes and files, and other files of the folder are not read", "[io][importer]") {
    const std::string triangle = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"made"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,
        "type":"VEC3","min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
    const auto loaded = load_model_bytes(to_bytes("gives\n" + triangle), "folder/Thing.ODD", "", by_odd());
    REQUIRE(loaded);
    CHECK(loaded->info.format == ".odd");
    CHECK(loaded->info.detail_px == by_odd().detail_px);
    CHECK(loaded->nodes.at(0).name == "made");
    CHECK(loaded->scene.meshes.at(0).positions.size() == 3);

    const TemporaryFolder folder;
    std::string outside = triangle;
    outside.replace(outside.find("data:"), outside.find("\"}]}") - outside.find("data:"), "other.bin");
    folder.write("other.bin", std::string(36, '\0'));
    folder.write("x.odd", "gives\n" + outside);
    CHECK_THAT(load_model(folder.file("x.odd"), by_odd()).error().message, Contains("other.bin"));
    // Without an importer it is what its content says.
    folder.write("y.gltf", triangle);
    CHECK(load_model(folder.file("y.gltf"), by_odd())->info.format == "glTF");
}

TEST_CASE("importer: it is told the version of the protocol and the fineness", "[io][importer]") {
    LoadOptions options = by_odd();
    options.detail_px = 4096;
    CHECK_THAT(error_of("words", options).message, Contains("halflit_odd_importer: 1 --pixels 4096"));
}

TEST_CASE("importer: the first one with the file's extension counts, and a form that is wrong is an error", "[io][importer]") {
    LoadOptions options = by_odd();
    options.importers.insert(options.importers.begin(), {".odd", "/nowhere/program"});
    CHECK_THAT(error_of("words", options).message, Contains("/nowhere/program cannot be run"));
    CHECK(error_of("words", options).code == ErrorCode::io);
    CHECK(Importer::from(".odd=" + std::string(kOdd)).value().extension == ".odd");
    for (const char* const wrong : {"", "odd", ".odd", ".odd=", "=/bin/sh", "odd=/bin/sh", ".odd=/nowhere/program", ".odd=/"})
        CHECK(Importer::from(wrong).error().code == ErrorCode::usage);
}

TEST_CASE("importer: of the user's file, and a fault of that is told", "[io][importer]") {
    const TemporaryFolder folder;
    const char* const before = std::getenv("XDG_CONFIG_HOME");
    const std::string kept = before == nullptr ? "" : before;
    ::setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
    folder.write("halflit/importers", "# mine\n\n  .odd=" + std::string(kOdd) + "\n");
    CHECK_THAT(error_of("words", {}).message, Contains("halflit_odd_importer: 1 --pixels 2048"));
    folder.write("halflit/importers", ".odd\n");
    CHECK_THAT(error_of("words", {}).message, Contains("halflit/importers: expected .EXTENSION=PROGRAM, found '.odd'"));
    before == nullptr ? ::unsetenv("XDG_CONFIG_HOME") : ::setenv("XDG_CONFIG_HOME", kept.c_str(), 1);
}

TEST_CASE("importer: its failures are the file's, with the reason that it told last", "[io][importer]") {
    CHECK(error_of("code 3").code == ErrorCode::bad_input);
    CHECK(error_of("code 3").message == "x.odd: halflit_odd_importer: the reason");
    CHECK(error_of("code 5").code == ErrorCode::limit);
    CHECK(error_of("code 77").code == ErrorCode::bad_input);
    CHECK_THAT(error_of("silent").message, Contains("exit code 3"));
    CHECK_THAT(error_of("crash").message, Contains("halflit_odd_importer ended by signal 6"));
    CHECK(error_of("crash").code == ErrorCode::bad_input);
    CHECK_THAT(error_of("talk").message, Contains("the last line"));
    CHECK_THAT(error_of("gives").message, Contains("x.odd: "));  // no glTF
    CHECK(error_of("gives").code == ErrorCode::bad_input);
}

TEST_CASE("importer: time, processor time, memory and output are limited, and a caller can stop it", "[io][importer]") {
    using Clock = std::chrono::steady_clock;
    LoadOptions short_work = by_odd();
    short_work.limits.max_work = 500'000'000;
    auto begin = Clock::now();
    CHECK(error_of("hang", short_work).code == ErrorCode::limit);
    CHECK_THAT(error_of("hang", short_work).message, Contains("took more than 1 s of a core"));
    LoadOptions short_time = by_odd();
    short_time.limits.time_limit_s = 0.3;
    begin = Clock::now();
    CHECK(error_of("sleep", short_time).code == ErrorCode::limit);
    CHECK(seconds_since(begin) < 5);
    LoadOptions small = by_odd();
    small.limits.max_file_bytes = 10'000'000;
    CHECK(error_of("flood", small).code == ErrorCode::limit);
    CHECK_THAT(error_of("flood", small).message, Contains("made more than 10000000 bytes"));
    begin = Clock::now();
    CHECK(error_of("closes", short_time).code == ErrorCode::limit);  // its streams, and lives on
    CHECK(seconds_since(begin) < 5);
    CHECK(error_of("memory").code == ErrorCode::limit);
    CHECK_THAT(error_of("memory").message, Contains("took "));
}

TEST_CASE("importer: it cannot write, remove, connect, start processes, or read what is not the system's", "[io][importer]") {
    const TemporaryFolder folder;
    folder.write("secret", "x");
    const std::string file = folder.file("secret"), other = folder.file("other");
    const std::string self = std::to_string(::getpid());
    for (const std::string& order : {"writes " + other, "writes " + file, "removes " + file, "renames " + file, "makes " + other,
                                     "kills " + self, "thread-kills " + self, "queues " + self, "limits " + self, "changes " + file,
                                     std::string("outlives"), std::string("socket"), std::string("forks")}) {
        INFO(order);
        if (has_seccomp()) CHECK_THAT(error_of(order).message, Contains(": refused"));
    }
    if (has_seccomp()) CHECK(folder.names() == std::vector<std::string>{"secret"});
    CHECK_THAT(error_of("thread").message, Contains(": allowed"));
    CHECK_THAT(error_of("descriptors").message, Contains(": 0"));
    ::setenv("HALFLIT_TEST_SECRET", "1", 1);
    CHECK(error_of("environment").message.find("SECRET") == std::string::npos);
    CHECK_THAT(error_of("reads /usr/bin/env").message, Contains(": allowed"));
    if (has_landlock()) CHECK_THAT(error_of("reads " + file).message, Contains(": refused"));
}

TEST_CASE("importer: it finds its streams where the host's own are closed", "[io][importer]") {
    const int input = ::dup(0);
    ::close(0);
    CHECK_THAT(error_of("words").message, Contains("1 --pixels"));
    ::dup2(input, 0);
    ::close(input);
}

TEST_CASE("importer: what it made is kept by the file's bytes and the fineness, where that is asked for", "[io][importer]") {
    const TemporaryFolder folder;
    const char* const before = std::getenv("XDG_CACHE_HOME");
    const std::string kept = before == nullptr ? "" : before;
    ::setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
    const std::string place = folder.file("halflit/import");
    const auto glbs = [&] {
        std::vector<std::string> found;
        for (const auto& entry : std::filesystem::directory_iterator(place))
            if (entry.path().extension() == ".glb") found.push_back(entry.path().string());
        return found;
    };
    const std::string nothing = R"({"asset":{"version":"2.0"}})";
    LoadOptions options = by_odd();
    const auto load = [&](const std::string& text) {
        return load_model_bytes(to_bytes("gives\n" + text), "x.odd", "", options).has_value();
    };
    CHECK(load(nothing));
    CHECK(folder.names().empty());
    options.import_cache = true;
    CHECK(load(nothing));
    CHECK(load(nothing));
    CHECK(glbs().size() == 1);
    // What was changed there is made again.
    for (const std::string& path : glbs()) std::ofstream(path) << "{";
    CHECK(load(nothing));
    for (const std::string& path : glbs()) CHECK(std::filesystem::file_size(path) == nothing.size() + 32);
    options.detail_px = 4096;
    CHECK(load(nothing));
    CHECK(load(nothing + " "));
    CHECK(glbs().size() == 3);
    CHECK(error_of("code 3", options).code == ErrorCode::bad_input);
    CHECK(glbs().size() == 3);
    before == nullptr ? ::unsetenv("XDG_CACHE_HOME") : ::setenv("XDG_CACHE_HOME", kept.c_str(), 1);
}
