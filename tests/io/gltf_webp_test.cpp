// EXT_texture_webp: pictures of libwebp's encoder, compared with the same pictures as PNG.
#include "tests/io/gltf_builder.hpp"
#include "tests/io/png_maker.hpp"
#include "tests/support/skip.hpp"

#include "apps/io/files/optional_libraries.hpp"
#include "apps/io/pictures/image_reader.hpp"

#include <chrono>
#include <cstdlib>
#include <random>

#if HALFLIT_HAS_WEBP
#include <webp/encode.h>
#endif

using namespace halflit;
using namespace halflit::test;

namespace {

constexpr const char* kWebpSource = R"("extensions":{"EXT_texture_webp":{"source":0}})";
constexpr const char* kRequired = R"(,"extensionsUsed":["EXT_texture_webp"],"extensionsRequired":["EXT_texture_webp"])";

#if HALFLIT_HAS_WEBP

constexpr int kWidth = 37, kHeight = 21;

/// Gradients and stripes, with alpha from 0 to 255.
std::vector<std::uint8_t> picture() {
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (const int v : {7 * x, 12 * y, x / 4 % 2 == 0 ? 200 : 40, 255 * y / (kHeight - 1)})
                rgba.push_back(static_cast<std::uint8_t>(v));
    return rgba;
}

Bytes png() {
    const std::vector<std::uint8_t> rgba = picture();
    PngSpec spec;
    spec.width = kWidth, spec.height = kHeight;
    return make_png(spec, [&](std::uint32_t x, std::uint32_t y, int c) {
        return std::uint32_t{rgba[4 * (y * kWidth + x) + static_cast<std::uint32_t>(c)]};
    });
}

/// quality: 0 to 100, or -1 for a picture without loss.
Bytes webp(float quality) {
    WebPConfig config;
    REQUIRE(WebPConfigInit(&config) != 0);
    config.lossless = quality < 0;
    config.exact = 1;  // keeps colours where alpha is 0
    config.quality = quality < 0 ? 50 : quality;
    WebPPicture source;
    REQUIRE(WebPPictureInit(&source) != 0);
    source.use_argb = config.lossless;
    source.width = kWidth, source.height = kHeight;
    WebPMemoryWriter writer;
    WebPMemoryWriterInit(&writer);
    source.writer = WebPMemoryWrite;
    source.custom_ptr = &writer;
    REQUIRE(WebPPictureImportRGBA(&source, picture().data(), 4 * kWidth) != 0);
    REQUIRE(WebPEncode(&config, &source) != 0);
    const auto* bytes = reinterpret_cast<const std::byte*>(writer.mem);
    Bytes out(bytes, bytes + writer.size);
    WebPPictureFree(&source);
    WebPMemoryWriterClear(&writer);
    return out;
}

#endif

}  // namespace

#if HALFLIT_HAS_WEBP

TEST_CASE("webp: a model with a picture without loss has the texture of its twin with a PNG", "[io]") {
    const LoadedScene plain = load_ok(textured(png(), "image/png", "\"source\":0"));
    const LoadedScene compressed = load_ok(textured(webp(-1), "image/webp", kWebpSource, kRequired));
    CHECK(compressed.warnings.empty());
    REQUIRE(plain.scene.textures.size() == 1);
    REQUIRE(compressed.scene.textures.size() == 1);
    CHECK(compressed.scene.textures[0].width() == kWidth);
    CHECK(std::ranges::equal(plain.scene.textures[0].data(), compressed.scene.textures[0].data()));
}

TEST_CASE("webp: alpha stays straight, and lossy pictures are near the original", "[io]") {
    const auto image = io::decode_image(webp(95));
    REQUIRE(image);
    const std::vector<std::uint8_t> original = picture();
    double sum = 0;
    for (std::size_t i = 0; i < original.size(); ++i) {
        const int difference = std::abs(int{original[i]} - int{image->rgba8[i]});
        sum += difference;
        if (i % 4 == 3) CHECK(difference == 0);  // alpha is stored without loss
    }
    // Chroma has half the resolution: the stripes' edges are off by tens of codes, the mean is not.
    CHECK(sum / static_cast<double>(original.size()) < 8);
}

TEST_CASE("webp: limits hold by the header, before pixels are decoded", "[io]") {
    const Bytes file = webp(-1);
    CHECK(io::read_image_header(file)->width == kWidth);
    CHECK(io::read_image_header(file)->height == kHeight);
    CHECK(io::read_image_header(file, {.max_side = kWidth - 1}).error().code == ErrorCode::limit);
    CHECK(io::decode_image(file, {.max_pixels = kWidth * kHeight - 1}).error().code == ErrorCode::limit);
    LoadOptions options;
    options.strict = true;
    options.limits.max_texture_bytes = kWidth * kHeight * 10;
    CHECK(load(textured(file, "image/webp", kWebpSource, kRequired), options).error().code == ErrorCode::limit);
}

TEST_CASE("webp: each cut of a file is refused, and a picture that moves", "[io]") {
    for (const float quality : {-1.0f, 80.0f}) {
        const Bytes file = webp(quality);
        for (std::size_t size = 0; size + 2 < file.size(); ++size)  // the last byte may be padding
            CHECK(io::decode_image(std::span(file).first(size)).error().code == ErrorCode::bad_input);
    }
    Bytes moving = to_bytes("RIFF");
    append_u32(moving, 22);
    for (const std::byte b : to_bytes("WEBPVP8X")) moving.push_back(b);
    append_u32(moving, 10);
    append_u32(moving, 2);  // animation
    append<std::uint8_t>(moving, {36, 0, 0, 20, 0, 0});
    CHECK(io::decode_image(moving).error().message.find("animated") != std::string::npos);
}

TEST_CASE("webp: two thousand damaged pictures end with a picture or an error, within the limits", "[io]") {
    std::mt19937 random(7);
    const Bytes sound[] = {webp(-1), webp(80)};
    const io::ImageLimits limits{.max_side = 512, .max_pixels = 1 << 16};
    int refused = 0;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 2000; ++i) {
        Bytes file = sound[i % 2];
        for (unsigned k = 0; k < 1 + random() % 4; ++k)
            file[random() % std::min<std::size_t>(file.size(), random() % 2 == 0 ? 60 : file.size())] = static_cast<std::byte>(random());
        const auto image = io::decode_image(file, limits);
        refused += !image;
        if (image) CHECK(image->rgba8.size() == std::size_t{4} * static_cast<std::size_t>(image->width * image->height));
    }
    CHECK(refused > 200);
    CHECK(refused < 2000);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
}

#endif

TEST_CASE("webp: a build without libwebp draws the other picture, and the strict rules refuse it by name", "[io]") {
    if (io::has_webp()) HALFLIT_SKIP("built with libwebp");
    LoadOptions strict;
    strict.strict = true;
    const auto required = load(textured({}, "image/webp", kWebpSource, kRequired), strict);
    REQUIRE(!required);
    CHECK(required.error().message.find("libwebp") != std::string::npos);
}
