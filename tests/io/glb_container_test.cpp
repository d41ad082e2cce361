#include "tests/io/gltf_builder.hpp"

#include "tests/support/catch.hpp"

using namespace halflit;
using namespace halflit::test;

namespace {

void put_u32(Bytes& file, std::size_t at, std::uint32_t value) { put(file, at, value); }

ErrorCode code_of(const Bytes& file) {
    const auto loaded = load(file);
    INFO((loaded ? std::string("loaded") : loaded.error().message));
    return loaded ? ErrorCode::negative_result : loaded.error().code;
}

Bytes with_chunk(Bytes file, std::uint32_t type, std::size_t size) {
    append_u32(file, static_cast<std::uint32_t>(size));
    append_u32(file, type);
    file.resize(file.size() + size);
    put_u32(file, 8, static_cast<std::uint32_t>(file.size()));
    return file;
}

}  // namespace

TEST_CASE("glb: a container without BIN, and one with unknown chunks, loads", "[io]") {
    const std::string empty_scene = std::string("{") + kAsset + "}";
    CHECK(load_ok(glb(empty_scene)).scene.instances.empty());
    const TriangleFile triangle;
    const LoadedScene loaded = load_ok(with_chunk(triangle.file(), 0x12345678, 8));
    CHECK(loaded.scene.instances.size() == 1);
    CHECK(loaded.warnings.size() == 1);
}

TEST_CASE("glb: a broken header, chunk, order or length is refused", "[io]") {
    const Bytes good = TriangleFile().file();
    REQUIRE(code_of(good) == ErrorCode::negative_result);
    const std::size_t json_size = u32_of(good, 12);
    const std::size_t bin_header = 20 + json_size;
    const auto changed = [&](std::size_t at, std::uint32_t value) {
        Bytes file = good;
        put_u32(file, at, value);
        return code_of(file);
    };
    CHECK(changed(0, 0x46546C68) == ErrorCode::bad_input);  // magic: the file is then read as JSON, and begins with garbage
    CHECK(changed(4, 1) == ErrorCode::bad_input);           // version
    CHECK(changed(4, 3) == ErrorCode::bad_input);
    CHECK(changed(8, static_cast<std::uint32_t>(good.size() - 4)) == ErrorCode::bad_input);
    CHECK(changed(8, 0xFFFFFFFF) == ErrorCode::bad_input);
    CHECK(changed(12, 0) == ErrorCode::bad_input);  // JSON length
    CHECK(changed(12, 0xFFFFFFFC) == ErrorCode::bad_input);
    CHECK(changed(12, static_cast<std::uint32_t>(json_size - 1)) == ErrorCode::bad_input);
    CHECK(changed(16, 0x004E4942) == ErrorCode::bad_input);          // first chunk is not JSON
    CHECK(changed(bin_header, 0xFFFFFFFC) == ErrorCode::bad_input);  // BIN length
    CHECK(changed(bin_header, 32) == ErrorCode::bad_input);
    CHECK(changed(bin_header + 4, 0x4E4F534A) == ErrorCode::bad_input);       // two JSON chunks
    CHECK(changed(bin_header + 4, 0x12345678) == ErrorCode::bad_input);       // no BIN for the buffer
    CHECK(code_of(with_chunk(good, 0x004E4942, 4)) == ErrorCode::bad_input);  // two BIN chunks
    Bytes longer = good;
    longer.resize(good.size() + 3);
    CHECK(load_ok(longer).warnings == std::vector<std::string>{"GLB: 3 bytes after the length that the header gives, ignored"});
    for (std::size_t length = 0; length < good.size(); ++length)
        if (code_of(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length))) != ErrorCode::bad_input)
            FAIL("cut to " << length);
}

TEST_CASE("glb: BIN may be up to three bytes longer than its buffer, and not shorter", "[io]") {
    TriangleFile triangle;
    const std::string json = triangle.json();
    const auto with_length = [&](const char* length) {
        std::string text = json;
        text = replaced(text, "\"byteLength\":36}],", std::string("\"byteLength\":") + length + "}],");
        return code_of(glb(text, triangle.bin));
    };
    CHECK(with_length("36") == ErrorCode::negative_result);
    CHECK(with_length("37") == ErrorCode::bad_input);
    CHECK(with_length("35") == ErrorCode::bad_input);  // the view no longer fits
    triangle.bin.resize(39);
    CHECK(code_of(glb(json, triangle.bin)) == ErrorCode::negative_result);
}
