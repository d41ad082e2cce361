#include "apps/io/pictures/picture_reader.hpp"

#include "halflit/image.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

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

namespace {

/// A TIFF of one strip, or of tiles: tags, their values behind them, then the data.
struct TiffMaker {
    bool big = false;
    std::uint32_t width = kWidth, height = kHeight, samples = 3, bits = 8, photometric = 2, compression = 1, predictor = 1, tile = 0;
    std::vector<std::uint16_t> palette{};
    std::vector<std::string> parts{};  ///< compressed

    [[nodiscard]] std::string number(std::uint32_t value, int bytes) const {
        std::string text = little_endian(value, bytes);
        if (big) std::reverse(text.begin(), text.end());
        return text;
    }
    [[nodiscard]] std::string file() const {
        std::string values, data, tags;
        std::uint32_t count = 0;
        const std::uint32_t entries = 12 + (palette.empty() ? 0 : 1), first_value = 8 + 2 + 12 * entries + 4;
        const auto tag = [&](std::uint32_t id, std::uint32_t type, const std::vector<std::uint32_t>& list) {
            std::string bytes;
            for (const std::uint32_t value : list) bytes += number(value, type == 3 ? 2 : 4);
            tags += number(id, 2) + number(type, 2) + number(static_cast<std::uint32_t>(list.size()), 4);
            if (bytes.size() <= 4) {
                tags += bytes + std::string(4 - bytes.size(), '\0');
            } else {
                tags += number(first_value + static_cast<std::uint32_t>(values.size()), 4);
                values += bytes;
            }
            ++count;
        };
        const std::uint32_t n = static_cast<std::uint32_t>(parts.size());
        std::vector<std::uint32_t> offsets, sizes;
        std::uint32_t at = first_value + 4 * samples + 8 * n + 2 * static_cast<std::uint32_t>(palette.size()) + 64;
        for (const std::string& part : parts) {
            offsets.push_back(at);
            sizes.push_back(static_cast<std::uint32_t>(part.size()));
            at += sizes.back();
        }
        tag(256, 4, {width}), tag(257, 3, {height});
        tag(258, 3, std::vector<std::uint32_t>(samples, bits));
        tag(259, 3, {compression}), tag(262, 3, {photometric}), tag(277, 3, {samples}), tag(317, 3, {predictor});
        tag(338, 3, {2});
        if (!palette.empty()) tag(320, 3, {palette.begin(), palette.end()});
        if (tile > 0)
            tag(322, 3, {tile}), tag(323, 3, {tile}), tag(324, 4, offsets), tag(325, 4, sizes);
        else
            tag(278, 4, {height}), tag(273, 4, offsets), tag(279, 4, sizes), tag(284, 3, {1});
        REQUIRE(count == entries);
        std::string out = (big ? "MM" : "II") + number(42, 2) + number(8, 4) + number(entries, 2) + tags + number(0, 4) + values;
        out.resize(offsets.front(), '\0');
        for (const std::string& part : parts) out += part;
        return out;
    }
};

/// Codes of 9 to 12 bits, each a byte by itself: a clear code before the table is full.
std::string lzw_of(const std::string& bytes) {
    std::string out;
    std::uint32_t held = 0, bits = 0;
    const auto put = [&](std::uint32_t code) {
        held = held << 9 | code, bits += 9;
        for (; bits >= 8; bits -= 8) out += static_cast<char>(held >> (bits - 8) & 255u);
    };
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        if (i % 200 == 0) put(256);
        put(static_cast<unsigned char>(bytes[i]));
    }
    put(257);
    if (bits > 0) out += static_cast<char>(held << (8 - bits) & 255u);
    return out;
}

std::string packed_bits_of(const std::string& bytes) {
    std::string out;
    for (std::size_t i = 0; i < bytes.size();) {
        std::size_t same = 1;
        while (same < 128 && i + same < bytes.size() && bytes[i + same] == bytes[i]) ++same;
        out += static_cast<char>(same > 1 ? 1 - static_cast<int>(same) : 0);
        out += bytes[i];
        i += same;
    }
    return out;
}

std::string rgb_of(const Image& image, std::size_t channels, std::size_t bytes_a_channel = 1) {
    std::string out;
    for (std::size_t i = 0; i < image.rgba8.size(); ++i)
        if (i % 4 < channels) out.append(bytes_a_channel, static_cast<char>(image.rgba8[i]));
    return out;
}

}  // namespace

TEST_CASE("pictures: TIFF of each kind that painting programs write comes back", "[io][picture]") {
    const Image image = pattern();
    const auto check = [&](const TiffMaker& maker, bool has_alpha, const char* what) {
        INFO(what);
        const std::string file = maker.file();
        const auto decoded = decode(file, "a.tif");
        REQUIRE(decoded);
        REQUIRE(decoded->rgba8.size() == image.rgba8.size());
        for (std::size_t i = 0; i < image.rgba8.size(); ++i)
            REQUIRE(decoded->rgba8[i] == (i % 4 == 3 && !has_alpha ? 255 : image.rgba8[i]));
        for (std::size_t cut = 0; cut < file.size(); cut += 7) (void)decode(file.substr(0, cut), "a.tif");  // no crash
    };
    const std::string rgb = rgb_of(image, 3), rgba = rgb_of(image, 4);
    for (const bool big : {false, true}) {
        check({.big = big, .parts = {rgb}}, false, "plain");
        check({.big = big, .samples = 4, .parts = {rgba}}, true, "alpha");
        check({.big = big, .compression = 5, .parts = {lzw_of(rgb)}}, false, "LZW");
        check({.big = big, .compression = 32773, .parts = {packed_bits_of(rgb)}}, false, "PackBits");
        check({.big = big, .bits = 16, .parts = {rgb_of(image, 3, 2)}}, false, "16 bits");
        std::string differences = rgb;
        for (std::size_t y = 0; y < kHeight; ++y)
            for (std::size_t i = kWidth * 3; i-- > 3;)
                differences[y * kWidth * 3 + i] = static_cast<char>(rgb[y * kWidth * 3 + i] - rgb[y * kWidth * 3 + i - 3]);
        check({.big = big, .compression = 5, .predictor = 2, .parts = {lzw_of(differences)}}, false, "differences");
        // Tiles of 16: three across, of which the last one hangs over, as it does below.
        std::vector<std::string> tiles;
        for (std::size_t left = 0; left < kWidth; left += 16) {
            std::string tile;
            for (std::size_t y = 0; y < 16; ++y)
                for (std::size_t x = left; x < left + 16; ++x)
                    tile += x < kWidth && y < kHeight ? rgb.substr(3 * (y * kWidth + x), 3) : std::string(3, '\0');
            tiles.push_back(tile);
        }
        check({.big = big, .tile = 16, .parts = tiles}, false, "tiles");
    }
    const auto pixel = [&](const TiffMaker& maker) {
        const auto decoded = decode(maker.file(), "a.tif");
        REQUIRE(decoded);
        return std::vector<int>(decoded->rgba8.begin(), decoded->rgba8.begin() + 8);
    };
    std::vector<std::uint16_t> palette(48);
    palette[1] = 0xff00, palette[16 + 2] = 0x8000;
    CHECK(pixel({.width = 2, .height = 1, .samples = 1, .bits = 4, .photometric = 3, .palette = palette, .parts = {"\x12"}}) ==
          std::vector<int>{255, 0, 0, 255, 0, 128, 0, 255});
    CHECK(pixel({.width = 2, .height = 1, .samples = 1, .bits = 1, .photometric = 0, .parts = {"\x40"}}) ==
          std::vector<int>{255, 255, 255, 255, 0, 0, 0, 255});
    CHECK(pixel({.width = 2, .height = 1, .samples = 2, .photometric = 1, .parts = {"abcd"}}) ==
          std::vector<int>{'a', 'a', 'a', 'b', 'c', 'c', 'c', 'd'});
    for (const TiffMaker& wrong : {TiffMaker{.compression = 7, .parts = {rgb}},
                                   {.samples = 2, .parts = {rgb}},
                                   {.bits = 32, .parts = {rgb}},
                                   {.samples = 1, .bits = 0, .photometric = 1, .parts = {rgb}},
                                   {.parts = {rgb.substr(1)}},
                                   {.width = 20000, .parts = {rgb}},
                                   {.compression = 5, .parts = {rgb}}})
        CHECK_FALSE(decode(wrong.file(), "a.tif"));
    // Each tile takes its memory, however few rows the picture has.
    const auto high =
        decode(TiffMaker{.width = 2, .height = 1, .compression = 5, .tile = 4096, .parts = {lzw_of("abcdef")}}.file(), "a.tif");
    REQUIRE_FALSE(high);
    CHECK(high.error().message.find("the file ends within the pixels") != std::string::npos);
}

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
