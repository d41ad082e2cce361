#include "apps/io/pictures/picture_reader.hpp"

#include "halflit/image.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <string>

using namespace halflit;

namespace {

constexpr int kWidth = 37, kHeight = 5;

/// Every third pixel repeats, so that run lengths and single pixels both occur.
Image pattern() {
    Image image{kWidth, kHeight, {}, {}};
    for (int i = 0; i < kWidth * kHeight; ++i)
        for (int c = 0; c < 4; ++c) image.rgba8.push_back(static_cast<std::uint8_t>((i / 3) * (7 + 2 * c) + 31 * c));
    return image;
}

Result<Image> decode(const std::string& bytes, std::string_view name, const io::ImageLimits& limits = {}) {
    return io::decode_picture(std::as_bytes(std::span(bytes)), name, limits);
}

std::string encoded(const Image& image, OutputFormat format) {
    const auto bytes = encode_image(image, format);
    REQUIRE(bytes);
    return {bytes->begin(), bytes->end()};
}

std::string little_endian(std::uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i, value >>= 8) text += static_cast<char>(value & 255);
    return text;
}

/// A BMP of 24 bits; a negative height has its first row on top.
std::string bmp_of(int width, int height, const std::string& rows) {
    return "BM" + little_endian(0, 8) + little_endian(54, 4) + little_endian(40, 4) + little_endian(static_cast<std::uint32_t>(width), 4) +
           little_endian(static_cast<std::uint32_t>(height), 4) + little_endian(1, 2) + little_endian(24, 2) + little_endian(0, 24) + rows;
}

std::string tga_of(int type, int width, int height, int bits, int order, const std::string& pixels) {
    return std::string(2, '\0') + static_cast<char>(type) + std::string(9, '\0') + little_endian(static_cast<std::uint32_t>(width), 2) +
           little_endian(static_cast<std::uint32_t>(height), 2) + static_cast<char>(bits) + static_cast<char>(order) + pixels;
}

}  // namespace

TEST_CASE("pictures: PNG, BMP and TGA come back as they were written, alpha too", "[io][picture]") {
    const Image image = pattern();
    for (const auto& [format, name] :
         {std::pair{OutputFormat::png, "a.png"}, std::pair{OutputFormat::bmp, "a.bmp"}, std::pair{OutputFormat::tga, "a.TGA"}}) {
        INFO(name);
        const auto decoded = decode(encoded(image, format), name);
        REQUIRE(decoded);
        CHECK(decoded->width == kWidth);
        CHECK(decoded->height == kHeight);
        CHECK(decoded->rgba8 == image.rgba8);
    }
}

TEST_CASE("pictures: HDR becomes the nearest sRGB codes, light above 1 becomes 255", "[io][picture]") {
    Image image{16, 1, {}, {}};
    for (int i = 0; i < 16; ++i) {
        const float light = static_cast<float>(i) / 8.0f;  // exact in RGBE
        image.rgba_linear.insert(image.rgba_linear.end(), {light, light / 4, 0.0f, 1.0f});
    }
    const auto decoded = decode(encoded(image, OutputFormat::hdr), "a.hdr");
    REQUIRE(decoded);
    const auto code = [](double v) {
        return static_cast<int>(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(std::min(v, 1.0), 1 / 2.4) - 0.055) + 0.5);
    };
    for (std::size_t i = 0; i < 16; ++i) {
        INFO("light " << static_cast<double>(i) / 8);
        CHECK(decoded->rgba8[4 * i] == code(static_cast<double>(i) / 8));
        CHECK(decoded->rgba8[4 * i + 1] == code(static_cast<double>(i) / 32));
        CHECK(decoded->rgba8[4 * i + 2] == 0);
        CHECK(decoded->rgba8[4 * i + 3] == 255);
    }
}

TEST_CASE("pictures: rows and columns of BMP and TGA are put in order", "[io][picture]") {
    const std::string top = "\x01\x02\x03\x04\x05\x06", bottom = "\x11\x12\x13\x14\x15\x16", pad(2, '\0');
    const std::vector<std::uint8_t> expected{3, 2, 1, 255, 6, 5, 4, 255, 0x13, 0x12, 0x11, 255, 0x16, 0x15, 0x14, 255};
    const std::string right_to_left = "\x04\x05\x06\x01\x02\x03\x14\x15\x16\x11\x12\x13";
    const std::pair<std::string, const char*> files[] = {
        {bmp_of(2, 2, bottom + pad + top + pad), "a.bmp"},   {bmp_of(2, -2, top + pad + bottom), "a.bmp"},  // the last padding is missing
        {tga_of(2, 2, 2, 24, 0, bottom + top), "a.tga"},     {tga_of(2, 2, 2, 24, 0x20, top + bottom), "a.tga"},
        {tga_of(2, 2, 2, 24, 0x30, right_to_left), "a.tga"}, {tga_of(10, 2, 2, 24, 0x20, "\x03" + top + bottom), "a.tga"}};
    for (const auto& [file, name] : files) {
        const auto decoded = decode(file, name);
        REQUIRE(decoded);
        CHECK(decoded->rgba8 == expected);
    }
    const auto grey = decode(tga_of(11, 3, 1, 8, 0x20, "\x82\x40"), "a.tga");
    REQUIRE(grey);
    CHECK(grey->rgba8 == std::vector<std::uint8_t>{64, 64, 64, 255, 64, 64, 64, 255, 64, 64, 64, 255});
}

TEST_CASE("pictures: every cut-off file is an error", "[io][picture]") {
    Image image = pattern();
    for (const std::uint8_t code : image.rgba8) image.rgba_linear.push_back(static_cast<float>(code) / 255.0f);
    for (const auto& [format, name] :
         {std::pair{OutputFormat::bmp, "a.bmp"}, std::pair{OutputFormat::tga, "a.tga"}, std::pair{OutputFormat::hdr, "a.hdr"}}) {
        const std::string file = encoded(image, format);
        // stb_image_write adds no footer, so the last byte belongs to a pixel.
        for (std::size_t size = 0; size < file.size(); ++size) {
            INFO(name << " of " << size << " bytes");
            const auto decoded = decode(file.substr(0, size), name);
            REQUIRE(!decoded);
            CHECK(decoded.error().code == ErrorCode::bad_input);
        }
    }
}

TEST_CASE("pictures: a size above the limits is refused by the header alone", "[io][picture]") {
    const std::pair<std::string, const char*> files[] = {{bmp_of(20000, 1, ""), "a.bmp"},
                                                         {bmp_of(10000, 10000, ""), "a.bmp"},
                                                         {tga_of(10, 65535, 1, 32, 0, ""), "a.tga"},
                                                         {tga_of(10, 16384, 16384, 32, 0, ""), "a.tga"},
                                                         {"#?RADIANCE\n\n-Y 1 +X 16385\n", "a.hdr"},
                                                         {"#?RADIANCE\n\n-Y 16384 +X 16384\n", "a.hdr"}};
    for (const auto& [file, name] : files) {
        const auto decoded = decode(file, name);
        REQUIRE(!decoded);
        CHECK(decoded.error().code == ErrorCode::limit);
    }
    CHECK(decode(bmp_of(0, 1, ""), "a.bmp").error().code == ErrorCode::bad_input);
    CHECK(decode(bmp_of(1, 0, ""), "a.bmp").error().code == ErrorCode::bad_input);
}

TEST_CASE("pictures: other kinds of BMP and TGA are refused", "[io][picture]") {
    std::string palette = bmp_of(1, 1, "\1\2\3");
    palette[28] = 8;
    CHECK(decode(palette, "a.bmp").error().message.find("found 8 bits") != std::string::npos);
    CHECK(decode(tga_of(1, 1, 1, 8, 0, "\1"), "a.tga").error().message.find("found type 1") != std::string::npos);
    CHECK(decode(tga_of(2, 1, 1, 16, 0, "\1\2"), "a.tga").error().message.find("16 bits") != std::string::npos);
    CHECK(decode(tga_of(10, 2, 1, 24, 0, "\x83\1\2\3"), "a.tga").error().message.find("past the end") != std::string::npos);
    CHECK(!decode(tga_of(2, 1, 1, 24, 0, "\1\2\3"), "a.png"));  // TGA has no mark of its own
}
