#include "apps/io/files/file_access.hpp"

#include "apps/io/files/uri.hpp"
#include "tests/io/gltf_builder.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/system.hpp"

#include <bit>
#include <filesystem>
#include <span>
#include <string>

using namespace halflit;
using namespace halflit::io;
using namespace halflit::test;
namespace fs = std::filesystem;

TEST_CASE("model folder: files below it are read, whatever leads elsewhere is not", "[io]") {
    const TemporaryFolder outside, folder;
    outside.write("secret.bin", "secret");
    folder.write("a.bin", "abc");
    folder.write("sub/with space.bin", "defg");
    // Where the system makes none, these names lead nowhere.
    (void)make_link(outside / "secret.bin", folder / "link.bin");
    (void)make_link(outside.path(), folder / "linked-folder");
    (void)make_pipe(folder / "fifo");
#ifndef _WIN32
    REQUIRE(fs::is_fifo(folder / "fifo"));
#endif
    ModelFolder model(folder.path());

    CHECK(model.read("a.bin", 100)->size() == 3);
    CHECK(model.read("sub/with space.bin", 100)->size() == 4);
    CHECK(model.read("./sub/../a.bin", 100)->size() == 3);
    const std::string up = "../" + fs::path(outside.path()).filename().string() + "/secret.bin";
    for (const std::string& name :
         {up, std::string("sub/../../") + fs::path(outside.path()).filename().string() + "/secret.bin", outside.file("secret.bin"),
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

    ModelFolder wider(folder.path(), {outside.path()});
    CHECK(wider.read("secret.bin", 100)->size() == 6);
    CHECK(wider.read("a.bin", 100)->size() == 3);
}

TEST_CASE("model folder: a name may lead into a folder that is allowed, and into no other", "[io]") {
    if (!abilities().follows_links) HALFLIT_SKIP("names do not pass through links on this system");
    const TemporaryFolder root;
    root.write("models/a.bin", "abc");
    root.write("textures/x.png", "texture");
    root.write("textures/deep/y.png", "deeper");
    root.write("textures-of-others/x.png", "secret");
    root.write("secret.bin", "secret");
    const std::string models = root.file("models"), textures = root.file("textures");
    REQUIRE(make_link(root / "secret.bin", root / "textures/out.png"));
    REQUIRE(make_link(root.path(), root / "textures/up"));
    REQUIRE(make_link("deep/y.png", root / "textures/inner.png"));
    REQUIRE(make_link(root / "textures", root / "models/linked"));
    REQUIRE(make_link(root / "textures", root / "other-name"));
    REQUIRE(make_link(root / "models", root / "linked-models"));

    for (const std::string& given : {textures, textures + "/", models + "/../textures", root.file("other-name")}) {
        INFO(given);
        ModelFolder folder(models, {given});
        CHECK(folder.check());
        for (const char* name : {"../textures/x.png", "./../textures/deep/../x.png", "x.png", "linked/x.png", "sub/../../textures/x.png",
                                 "../models/../textures/x.png", "../../../../../../../../../../../textures/../../x.png"}) {
            INFO(name);
            const bool beyond_root = std::string(name).starts_with("../../..");
            const auto read = folder.read(name, 100);
            CHECK(read.has_value() == !beyond_root);
            if (read) CHECK(read->size() == 7);
        }
        CHECK(folder.read("../textures/deep/y.png", 100)->size() == 6);
        CHECK(folder.read("../textures/inner.png", 100)->size() == 6);
        for (const char* name : {"../textures/out.png", "../textures/up/secret.bin", "../secret.bin", "../textures-of-others/x.png",
                                 "../textures", "../textures/", "../textures/x.png/", "linked/out.png", "linked/up/secret.bin", "..", "../",
                                 "../models/../secret.bin", "../textures/../secret.bin", "linked/../../secret.bin"}) {
            INFO(name);
            const auto read = folder.read(name, 100);
            REQUIRE(!read);
            CHECK(read.error().code == ErrorCode::bad_input);
        }
    }
    CHECK(ModelFolder(models, {root.file("other-name")}).read("../other-name/x.png", 100)->size() == 7);
    CHECK(ModelFolder(root.file("linked-models"), {textures}).read("../textures/x.png", 100)->size() == 7);
    CHECK(!ModelFolder(models).read("../textures/x.png", 100));
    CHECK(ModelFolder(models).read("../models/a.bin", 100)->size() == 3);
}

TEST_CASE("model folder: without links, a name leads up and into a folder that is allowed, and into no other", "[io]") {
    const TemporaryFolder root;
    root.write("models/a.bin", "abc");
    root.write("textures/deep/x.png", "texture");
    root.write("textures-of-others/x.png", "secret");
    root.write("secret.bin", "secret");
    const std::string models = root.file("models"), textures = root.file("textures");
    for (const std::string& given : {textures, textures + "/", models + "/../textures"}) {
        INFO(given);
        ModelFolder folder(models, {given});
        CHECK(folder.check());
        for (const char* name : {"../textures/deep/x.png", "./../textures/./deep/x.png", "deep/x.png", "sub/../../textures/deep/x.png"}) {
            INFO(name);
            const auto read = folder.read(name, 100);
            REQUIRE(read);
            CHECK(read->size() == 7);
        }
        for (const char* name : {"../secret.bin", "../textures-of-others/x.png", "../textures", "../textures/", "..", "../",
                                 "../models/../secret.bin", "../textures/../secret.bin"}) {
            INFO(name);
            CHECK(!folder.read(name, 100));
        }
    }
    CHECK(!ModelFolder(models).read("../textures/deep/x.png", 100));
    CHECK(ModelFolder(models).read("../models/a.bin", 100)->size() == 3);
}

TEST_CASE("model folder: an allowed folder that is not there is an error that names it", "[io]") {
    const TemporaryFolder root;
    root.write("file.bin", "abc");
    for (const std::string& missing : {root.file("none"), root.file("file.bin"), std::string()}) {
        ModelFolder folder(root.path(), {root.path(), missing});
        REQUIRE(!folder.check());
        CHECK(folder.check().error().code == ErrorCode::usage);
        CHECK(folder.check().error().message.find("\"" + missing + "\"") != std::string::npos);
    }
    LoadOptions options;
    options.allow_external = {root.file("none")};
    root.write("model.gltf", R"({"asset":{"version":"2.0"}})");
    const auto loaded = load_gltf(root.file("model.gltf"), options);
    REQUIRE(!loaded);
    CHECK(loaded.error().code == ErrorCode::usage);
    CHECK(loaded.error().message.find(options.allow_external[0]) != std::string::npos);
}

TEST_CASE("read file: errors of the file system are io errors", "[io]") {
    const TemporaryFolder folder;
    folder.write("a.bin", "abc");
    CHECK(read_file(folder.file("a.bin"))->size() == 3);
    CHECK(read_file(folder.file("none.bin")).error().code == ErrorCode::io);
    CHECK(read_file(folder.path()).error().code == ErrorCode::io);
    CHECK(read_file("/dev/null").error().code == ErrorCode::io);                                      // on Windows there is none
    CHECK(read_file("NUL").error().code == ErrorCode::io);                                            // elsewhere there is none
    CHECK(read_file(folder.file("a.bin") + std::string("\0.bin", 5)).error().code == ErrorCode::io);  // not a.bin
    CHECK(read_file(folder.file("a.bin"), 2).error().code == ErrorCode::limit);
}

TEST_CASE("read file: a model whose bytes are given back while they are read is that of bytes that stay", "[io]") {
    // Two parts of what is given back at once, and a rest.
    constexpr std::uint32_t kTriangles = 400'000;
    std::string stl(84 + 50 * std::size_t{kTriangles}, '\0');
    const auto put = [&](std::size_t at, std::uint32_t value) {
        for (int k = 0; k < 4; ++k) stl[at + static_cast<std::size_t>(k)] = static_cast<char>(value >> (8 * k) & 0xffu);
    };
    put(80, kTriangles);
    for (std::uint32_t t = 0; t < kTriangles; ++t) {
        const auto x = static_cast<float>(t % 632), y = static_cast<float>(t / 632);
        const float corners[9] = {x, y, 0, x + 1, y, 0, x, y + 1, 1};
        for (std::size_t i = 0; i < 9; ++i) put(84 + 50 * std::size_t{t} + 12 + 4 * i, std::bit_cast<std::uint32_t>(corners[i]));
    }
    const TemporaryFolder folder;
    folder.write("grid.stl", stl);
    const std::string whole = stl;
    const auto from_file = load_model(folder.file("grid.stl"));
    const auto from_memory = load_model_bytes(std::as_bytes(std::span(stl)), "grid.stl", "", {});
    REQUIRE((from_file && from_memory));
    CHECK(from_file->scene.meshes[0].positions == from_memory->scene.meshes[0].positions);
    CHECK(from_file->scene.meshes[0].indices == from_memory->scene.meshes[0].indices);
    CHECK((stl == whole));
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
    for (const char* loose : {" Zm9v\n\tYmFy\r\n", "Zm9v%20YmFy%0A", "Zm9vYmE%3D", "Zm9vYm$y"}) {
        bool mended = false;
        const std::string uri = std::string("data:;base64,") + loose;
        CHECK(!decode_data_uri(uri, 1000));
        const auto bytes = decode_data_uri(uri, 1000, &mended);
        CHECK(bytes.has_value() == mended);
        CHECK(mended == (uri.find('$') == std::string::npos));
    }
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
    CHECK(*decode_file_uri("file:///home/me/a%20b.png", true) == "///home/me/a b.png");
    CHECK(*decode_file_uri("FILE:C:\\x.png", true) == "C:\\x.png");
    CHECK(*decode_file_uri("C:/x.png", true) == "C:/x.png");
    CHECK(*decode_file_uri("100%.png", true) == "100%.png");
    CHECK(!decode_file_uri("http://host/x.png", true));
    CHECK(*decode_file_uri("..%2fx") == "../x");  // refused later, by ModelFolder
    for (const char* bad : {"http://example.org/a.bin", "file:///etc/passwd", "C:/a.bin", "a%", "a%2", "a%zz", "a%00b"})
        CHECK(!decode_file_uri(bad));
}
