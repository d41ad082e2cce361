#include "apps/io/file_access.hpp"

#include "apps/io/detail/uri.hpp"
#include "tests/io/gltf_builder.hpp"

#include "tests/support/catch.hpp"

#include <filesystem>
#include <fstream>

#include <sys/stat.h>
#include <unistd.h>

using namespace halflit;
using namespace halflit::io;
using namespace halflit::test;
namespace fs = std::filesystem;

namespace {

/// A folder of its own for a test, removed at its end.
struct TemporaryFolder {
    fs::path path;
    TemporaryFolder() {
        std::string name = (fs::temp_directory_path() / "halflit-test-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        path = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
    void write(const std::string& name, std::string_view text) const {
        fs::create_directories((path / name).parent_path());
        std::ofstream(path / name, std::ios::binary) << text;
    }
};

}  // namespace

TEST_CASE("model folder: files below it are read, whatever leads elsewhere is not", "[io]") {
    const TemporaryFolder outside, folder;
    outside.write("secret.bin", "secret");
    folder.write("a.bin", "abc");
    folder.write("sub/with space.bin", "defg");
    fs::create_symlink("a.bin", folder.path / "inner-link.bin");
    fs::create_symlink(outside.path / "secret.bin", folder.path / "link.bin");
    fs::create_symlink(outside.path, folder.path / "linked-folder");
    REQUIRE(::mkfifo((folder.path / "fifo").c_str(), 0600) == 0);
    const ModelFolder model(folder.path.string());

    CHECK(model.read("a.bin", 100)->size() == 3);
    CHECK(model.read("sub/with space.bin", 100)->size() == 4);
    CHECK(model.read("./sub/../a.bin", 100)->size() == 3);
    const std::string up = "../" + outside.path.filename().string() + "/secret.bin";
    for (const std::string& name :
         {up, std::string("sub/../../") + outside.path.filename().string() + "/secret.bin", (outside.path / "secret.bin").string(),
          std::string("link.bin"), std::string("linked-folder/secret.bin"), std::string("fifo"), std::string("sub"), std::string("."),
          std::string(""), std::string("missing.bin"), std::string("a.bin/"), std::string("sub\\with space.bin"), std::string("a.bin\0", 6),
          std::string("/dev/zero"), std::string(5000, 'x')}) {
        INFO(name);
        const auto read = model.read(name, 100);
        REQUIRE(!read);
        CHECK(read.error().code == ErrorCode::bad_input);
    }
    CHECK(model.read("a.bin", 2).error().code == ErrorCode::limit);
    CHECK(ModelFolder().read("a.bin", 100).error().code == ErrorCode::bad_input);

    const ModelFolder wider(folder.path.string(), {outside.path.string()});
    CHECK(wider.read("secret.bin", 100)->size() == 6);
    CHECK(wider.read("a.bin", 100)->size() == 3);
}

TEST_CASE("read file: errors of the file system are io errors", "[io]") {
    const TemporaryFolder folder;
    folder.write("a.bin", "abc");
    CHECK(read_file((folder.path / "a.bin").string())->size() == 3);
    CHECK(read_file((folder.path / "none.bin").string()).error().code == ErrorCode::io);
    CHECK(read_file(folder.path.string()).error().code == ErrorCode::io);
    CHECK(read_file("/dev/null").error().code == ErrorCode::io);
    CHECK(read_file((folder.path / "a.bin").string(), 2).error().code == ErrorCode::limit);
}

TEST_CASE("uri: data URIs decode as RFC 4648 says, and broken ones are refused", "[io]") {
    using io::detail::decode_data_uri;
    const auto decode = [](const std::string& uri) {
        const auto bytes = decode_data_uri(uri, 1000);
        return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "error: " + bytes.error().message;
    };
    CHECK(decode("data:;base64,") == "");
    CHECK(decode("data:;base64,Zg==") == "f");
    CHECK(decode("data:application/octet-stream;base64,Zm8=") == "fo");
    CHECK(decode("data:image/png;base64,Zm9v") == "foo");
    CHECK(decode("DATA:x;charset=utf-8;base64,Zm9vYmFy") == "foobar");
    CHECK(decode("data:;base64,Zm8") == "fo");  // padding left out
    CHECK(decode("data:,a%20b") == "a b");
    for (const char* bad : {"data:", "data:;base64", "data:;base64,Z", "data:;base64,Zm9v!", "data:;base64,Zm=v",
                            "data:;base64,Zg=", "data:;base64,Zm 9v", "data:,%2", "data:,%zz"})
        CHECK(!decode_data_uri(bad, 1000));
    CHECK(decode_data_uri("data:;base64,Zm9vYmFy", 5).error().code == ErrorCode::limit);
    for (std::size_t size = 0; size < 50; ++size) {
        Bytes bytes(size);
        for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * 89 + size * 31);
        CHECK(*decode_data_uri("data:;base64," + base64(bytes), 1000) == bytes);
    }
}

TEST_CASE("uri: names are percent-decoded once, addresses are refused", "[io]") {
    using io::detail::decode_file_uri;
    CHECK(*decode_file_uri("a%20b.png") == "a b.png");
    CHECK(*decode_file_uri("a b.png") == "a b.png");
    CHECK(*decode_file_uri("%E4%BD%A0.png") == "\xE4\xBD\xA0.png");
    CHECK(*decode_file_uri("a%2520b") == "a%20b");
    CHECK(*decode_file_uri("..%2fx") == "../x");  // refused later, by ModelFolder
    for (const char* bad : {"http://example.org/a.bin", "file:///etc/passwd", "C:/a.bin", "a%", "a%2", "a%zz", "a%00b"})
        CHECK(!decode_file_uri(bad));
}
