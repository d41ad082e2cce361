// KTX2 textures: the pixels of Basis Universal's transcoder, and plain ones under each compression of the container.
#include "tests/io/ktx2_files.hpp"
#include "tests/io/png_maker.hpp"
#include "tests/support/skip.hpp"

#include "apps/io/files/optional_libraries.hpp"
#include "apps/io/files/uri.hpp"
#include "apps/io/pictures/image_reader.hpp"

#include <chrono>
#include <random>

#if HALFLIT_HAS_KTX2
#include <zstd.h>
#endif

using namespace halflit;
using namespace halflit::test;

namespace {

Bytes decoded(const char* base64) {
    auto bytes = io::detail::decode_data_uri(std::string("data:;base64,") + base64, 1 << 16);
    REQUIRE(bytes);
    return *bytes;
}

struct Ktx2Maker {
    std::uint32_t format = 0, width = 0, height = 0, layers = 0, scheme = 0, model = 0;
    Bytes level{}, globals{}, pairs{};
    std::size_t unpacked = 0;

    [[nodiscard]] Bytes file() const {
        constexpr std::uint32_t kAt = 104, kDescriptor = 44;
        Bytes out = to_bytes("\xABKTX 20\xBB\r\n\x1A\n");
        const auto size = [](const Bytes& part) { return static_cast<std::uint32_t>(part.size()); };
        const std::uint32_t pairs_at = kAt + kDescriptor, globals_at = pairs_at + size(pairs), level_at = globals_at + size(globals);
        append<std::uint32_t>(out, {format, 1, width, height, 0, layers, 1, 1, scheme, kAt, kDescriptor, pairs_at, size(pairs)});
        append<std::uint64_t>(out, {globals_at, size(globals), level_at, size(level), unpacked});
        append<std::uint32_t>(out, {kDescriptor, 0, 40u << 16 | 2, model, 0, 0, 0, 0, 0, 0, 0});
        for (const Bytes* part : {&pairs, &globals, &level}) out.insert(out.end(), part->begin(), part->end());
        return out;
    }
};

constexpr std::uint32_t kEtc1s = 163, kUastc = 166, kBasisLz = 1, kZstd = 2, kZlib = 3;

Ktx2Maker uastc() { return {.width = 76, .height = 4, .model = kUastc, .level = decoded(kUastcBlocks), .unpacked = 304}; }

/// A model whose base colour is `image` by KHR_texture_basisu, which it requires unless it has another picture, of 3 x 3 pixels.
Bytes model_of(const Bytes& image, bool has_other) {
    const std::string texture = R"("extensions":{"KHR_texture_basisu":{"source":0}})", used = R"(,"extensionsUsed":["KHR_texture_basisu"])";
    if (!has_other) return textured(image, "image/ktx2", texture, used + R"(,"extensionsRequired":["KHR_texture_basisu"])");
    const Bytes other = make_png(PngSpec{3, 3, 8, 6, false, {}, {}}, [](auto, auto, int) { return 0u; });
    return textured(image, "image/ktx2", "\"source\":1," + texture, used, R"(,{"uri":"data:image/png;base64,)" + base64(other) + "\"}");
}

#if HALFLIT_HAS_KTX2

Ktx2Maker etc1s() {
    return {
        .width = 22, .height = 18, .scheme = kBasisLz, .model = kEtc1s, .level = decoded(kEtc1sLevel), .globals = decoded(kEtc1sGlobals)};
}

Bytes pixels_of(const Bytes& file) {
    const auto image = io::decode_image(file);
    INFO((image ? "" : image.error().message));
    REQUIRE(image);
    const auto bytes = std::as_bytes(std::span(image->rgba8));
    return {bytes.begin(), bytes.end()};
}

#endif

}  // namespace

#if HALFLIT_HAS_KTX2

TEST_CASE("ktx2: each mode of UASTC has the pixels of Basis Universal's transcoder", "[io]") {
    CHECK(pixels_of(uastc().file()) == decoded(kUastcPixels));
}

TEST_CASE("ktx2: an ETC1S texture with alpha has the pixels of Basis Universal's transcoder", "[io]") {
    CHECK(pixels_of(etc1s().file()) == decoded(kEtc1sPixels));
    Ktx2Maker opaque = etc1s();
    for (std::size_t i = 0; i < 8; ++i) opaque.globals[20 + 12 + i] = {};  // no slice of alpha
    Bytes expected = decoded(kEtc1sPixels);
    for (std::size_t i = 3; i < expected.size(); i += 4) expected[i] = std::byte{255};
    CHECK(pixels_of(opaque.file()) == expected);
}

TEST_CASE("ktx2: a mode and a pattern that UASTC does not have give the colour of errors", "[io]") {
    Bytes magenta;
    for (int i = 0; i < 16; ++i) append<std::uint8_t>(magenta, {255, 0, 255, 255});
    Ktx2Maker maker = uastc();
    maker.width = 4;
    maker.level[0] = std::byte{0x45};
    CHECK(pixels_of(maker.file()) == magenta);
    maker.level.erase(maker.level.begin(), maker.level.begin() + 3 * 16);
    maker.level[2] |= std::byte{0xF0};  // mode 3 has 11 patterns
    CHECK(pixels_of(maker.file()) == magenta);
}

TEST_CASE("ktx2: plain channels come as Vulkan's formats have them, under each compression", "[io]") {
    struct Case {
        std::uint32_t format;
        std::size_t channels;
        std::string sees;  ///< which channel each of RGBA is
    };
    for (const Case& c : {Case{9, 1, "r001"}, Case{15, 1, "r001"}, Case{16, 2, "rg01"}, Case{23, 3, "rgb1"}, Case{29, 3, "rgb1"},
                          Case{30, 3, "bgr1"}, Case{37, 4, "rgba"}, Case{43, 4, "rgba"}, Case{50, 4, "bgra"}}) {
        Ktx2Maker maker{.format = c.format, .width = 5, .height = 3};
        for (std::size_t i = 0; i < 15 * c.channels; ++i) maker.level.push_back(static_cast<std::byte>(7 * i + 1));
        maker.unpacked = maker.level.size();
        Bytes expected;
        for (std::size_t i = 0; i < 15; ++i)
            for (const char channel : c.sees) {
                const std::size_t at = std::string("rgba").find(channel);
                expected.push_back(channel == '0' ? std::byte{0} : channel == '1' ? std::byte{255} : maker.level[c.channels * i + at]);
            }
        INFO("format " << c.format);
        CHECK(pixels_of(maker.file()) == expected);
        Ktx2Maker deflated = maker;
        deflated.scheme = kZlib, deflated.level = zlib_stored(maker.level);
        CHECK(pixels_of(deflated.file()) == expected);
        Ktx2Maker packed = maker;
        packed.scheme = kZstd, packed.layers = 2;  // the first of two equal layers
        maker.level.insert(maker.level.end(), maker.level.begin(), maker.level.end());
        packed.unpacked = maker.level.size();
        packed.level.resize(ZSTD_compressBound(maker.level.size()));
        packed.level.resize(ZSTD_compress(packed.level.data(), packed.level.size(), maker.level.data(), maker.level.size(), 3));
        CHECK(pixels_of(packed.file()) == expected);
    }
    // A frame of unknown length, with a window of 8 MB, and with one of 128 MB, which so small a level cannot need.
    Ktx2Maker frame = uastc();
    const Bytes blocks = frame.level;
    for (const auto& [window, is_read] : {std::pair(0x68, true), {0x88, false}}) {
        frame.scheme = kZstd;
        frame.level.clear();
        append<std::uint32_t>(frame.level, {0xFD2FB528u});
        append<std::uint8_t>(frame.level, {0, static_cast<std::uint8_t>(window)});
        append<std::uint16_t>(frame.level, {static_cast<std::uint16_t>(blocks.size() << 3 | 1)});
        append<std::uint8_t>(frame.level, {0});
        frame.level.insert(frame.level.end(), blocks.begin(), blocks.end());
        CHECK(io::decode_image(frame.file()).has_value() == is_read);
    }
}

TEST_CASE("ktx2: KTXswizzle chooses the channels of a plain picture", "[io]") {
    Ktx2Maker maker{.format = 16, .width = 1, .height = 1, .level = to_bytes("\x11\x22"), .unpacked = 2};
    append_u32(maker.pairs, 10);  // a pair that is not asked for, and what fills its last four bytes
    for (const std::byte b : to_bytes(std::string_view("KTXother\0x\0\0", 12))) maker.pairs.push_back(b);
    append_u32(maker.pairs, 16);
    for (const std::byte b : to_bytes(std::string_view("KTXswizzle\0rrrg", 16))) maker.pairs.push_back(b);
    CHECK(pixels_of(maker.file()) == to_bytes("\x11\x11\x11\x22"));
}

TEST_CASE("ktx2: formats that are not read are refused by name, and sizes above the limits", "[io]") {
    const auto message = [](const Ktx2Maker& maker) {
        const auto image = io::decode_image(maker.file());
        REQUIRE(!image);
        CHECK(image.error().code == ErrorCode::bad_input);
        return image.error().message;
    };
    Ktx2Maker maker = uastc();
    maker.format = 145;  // BC7
    CHECK(message(maker).find("vkFormat 145") != std::string::npos);
    maker = uastc(), maker.model = 167;
    CHECK(message(maker).find("colour model 167") != std::string::npos);
    maker = uastc(), maker.scheme = kBasisLz;
    CHECK(message(maker).find("does not go with") != std::string::npos);
    maker = uastc(), maker.height = 0;
    CHECK(message(maker).find("76x0") != std::string::npos);
    const Bytes sound = uastc().file();
    CHECK(io::read_image_header(sound)->width == 76);
    CHECK(io::read_image_header(sound, {.max_side = 75}).error().code == ErrorCode::limit);
    CHECK(io::decode_image(sound, {.max_pixels = 303}).error().code == ErrorCode::limit);
}

TEST_CASE("ktx2: each cut of a file is refused, and its rows in front of the cut are kept", "[io]") {
    for (const Bytes& file : {etc1s().file(), uastc().file()})
        for (std::size_t size = 0; size < file.size(); ++size) {
            const auto image = io::decode_image(std::span(file).first(size));
            REQUIRE(!image);
            CHECK(image.error().code == ErrorCode::bad_input);
        }
    struct Rows : io::RowSink {
        int count = 0;
        void add_row(const std::uint8_t*) override { ++count; }
        void add_row(const std::uint16_t*) override {}
    } rows;
    const Bytes file = etc1s().file();
    CHECK(!io::decode_rows(std::span(file).first(file.size() - 12), {.keep_damaged = true}, false, rows));
    CHECK(rows.count >= 4);
    CHECK(rows.count < 18);
}

TEST_CASE("ktx2: four thousand damaged textures end with a picture or an error, within the limits", "[io]") {
    std::mt19937 random(11);
    const Bytes sound[] = {etc1s().file(), uastc().file()};
    const io::ImageLimits limits{.max_side = 512, .max_pixels = 1 << 16};
    int refused = 0;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 4000; ++i) {
        Bytes file = sound[i % 2];
        for (unsigned k = 0; k < 1 + random() % 4; ++k)
            file[random() % std::min<std::size_t>(file.size(), random() % 4 == 0 ? 150 : file.size())] = static_cast<std::byte>(random());
        const auto image = io::decode_image(file, limits);
        refused += !image;
        if (image) CHECK(image->rgba8.size() == std::size_t{4} * static_cast<std::size_t>(image->width * image->height));
    }
    CHECK(refused > 400);
    CHECK(refused < 4000);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
}

TEST_CASE("ktx2: a model that requires KHR_texture_basisu has its texture, also beside another picture", "[io]") {
    for (const bool has_other : {false, true}) {
        const LoadedScene loaded = load_ok(model_of(etc1s().file(), has_other));
        CHECK(loaded.warnings.empty());
        REQUIRE(loaded.scene.textures.size() == 1);
        CHECK(loaded.scene.textures[0].width() == 22);
        const auto image = io::decode_image(etc1s().file());
        const auto expected = Texture::from_rgba8(image->rgba8, 22, 18, ColorSpace::srgb);
        CHECK(std::ranges::equal(loaded.scene.textures[0].data(), expected->data()));
    }
}

#endif

TEST_CASE("ktx2: a build without libzstd draws the other picture or none, and refuses by the strict rules", "[io]") {
    if (io::has_ktx2()) HALFLIT_SKIP("built with libzstd");
    CHECK(load_ok(model_of(uastc().file(), false)).scene.textures.empty());
    LoadOptions strict;
    strict.strict = true;
    const auto required = load(model_of(uastc().file(), false), strict);
    REQUIRE(!required);
    CHECK(required.error().message.find("libzstd") != std::string::npos);
    CHECK(load_ok(model_of(uastc().file(), true)).scene.textures[0].width() == 3);
}
