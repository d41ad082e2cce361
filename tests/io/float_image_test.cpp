#include "apps/io/pictures/float_image.hpp"

#include "halflit/image.hpp"
#include "tests/support/random.hpp"
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

using namespace halflit;
using namespace halflit::io;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

std::string little(std::uint32_t bits, int bytes = 4) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(bits >> (8 * i));
    return text;
}
std::string big(std::uint32_t bits) {
    const std::string text = little(bits);
    return {text.rbegin(), text.rend()};
}
std::string floats(const std::vector<float>& values, bool little_endian = true) {
    std::string text;
    for (const float v : values) text += little_endian ? little(std::bit_cast<std::uint32_t>(v)) : big(std::bit_cast<std::uint32_t>(v));
    return text;
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + little(static_cast<std::uint32_t>(value.size())) + value;
}

enum PixelType : std::uint32_t { kHalf = 1, kFloat = 2 };

struct ExrFile {
    int x = 0, y = 0, width = 2, height = 2;
    std::vector<std::string> channels{"B", "G", "R"};  ///< in the order of their names, as the format demands
    PixelType type = kFloat;
    std::uint32_t version = 2;
    std::string more{};  ///< attributes
};

std::string exr_header(const ExrFile& f) {
    std::string channels;
    for (const std::string& name : f.channels) channels += name + '\0' + little(f.type) + little(0) + little(1) + little(1);
    const auto corner = [](int value) { return little(static_cast<std::uint32_t>(value)); };
    const std::string window = corner(f.x) + corner(f.y) + corner(f.x + f.width - 1) + corner(f.y + f.height - 1);
    return "\x76\x2f\x31\x01" + little(f.version) + attribute("channels", "chlist", channels + '\0') +
           attribute("compression", "compression", std::string(1, '\0')) + attribute("dataWindow", "box2i", window) +
           attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
           attribute("pixelAspectRatio", "float", floats({1.0f})) + attribute("screenWindowCenter", "v2f", floats({0, 0})) +
           attribute("screenWindowWidth", "float", floats({1.0f})) + f.more + '\0';
}

/// A file without compression, written as the format's description says. rows: for each line, the bytes of each channel in turn.
std::string exr_file(const ExrFile& f, const std::vector<std::string>& rows) {
    const std::string head = exr_header(f);
    std::string offsets, lines;
    const std::size_t first = head.size() + 8 * rows.size();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        offsets += little(static_cast<std::uint32_t>(first + lines.size())) + little(0);
        lines +=
            little(static_cast<std::uint32_t>(f.y + static_cast<int>(i))) + little(static_cast<std::uint32_t>(rows[i].size())) + rows[i];
    }
    return head + offsets + lines;
}

std::span<const std::byte> bytes_of(const std::string& file) { return {reinterpret_cast<const std::byte*>(file.data()), file.size()}; }
Result<FloatImage> decode(const std::string& file, const FloatImageLimits& limits = {}) {
    return decode_float_image(bytes_of(file), limits);
}
std::string message_of(const std::string& file, ErrorCode code = ErrorCode::bad_input) {
    const auto decoded = decode(file);
    REQUIRE_FALSE(decoded);
    CHECK(decoded.error().code == code);
    CHECK(decoded.error().message.find('\n') == std::string::npos);
    return decoded.error().message;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), 4 * a.size()) == 0;
}

/// Values that show each bit of a float: large, small, denormal, and neighbours of 1.
Image test_picture(float alpha) {
    Image image{3, 2, {}, {}};
    const float values[] = {0.0f,      1.0f,     std::nextafter(1.0f, 2.0f),
                            0x1p-149f, 1e-20f,   1e29f,
                            0.1f,      2.5f,     1000.25f,
                            0.3f,      0x1p-66f, 65504.0f,
                            65520.0f,  7.0f,     0.7f,
                            1e6f,      3.0f,     std::nextafter(0.5f, 0.0f)};
    for (std::size_t i = 0; i < 18; ++i) {
        image.rgba_linear.push_back(values[i]);
        if (i % 3 == 2) image.rgba_linear.push_back(alpha);
    }
    return image;
}

std::string encoded(const Image& image, OutputFormat format) {
    const auto file = encode_image(image, format);
    REQUIRE(file);
    return {file->begin(), file->end()};
}

std::vector<float> rgb_of(const Image& image, float factor = 1.0f) {
    std::vector<float> rgb;
    for (std::size_t i = 0; i < image.rgba_linear.size(); ++i)
        if (i % 4 != 3) rgb.push_back(image.rgba_linear[i] * factor);
    return rgb;
}

#define REQUIRE_EXR() \
    if (!has_exr()) HALFLIT_SKIP("built without OpenEXR")

}  // namespace

TEST_CASE("float image: a PFM file is its three lines and the floats, bottom row first", "[io][float_image]") {
    const Image image = test_picture(1.0f);
    const std::vector<float> rgb = rgb_of(image);
    const std::string file = encoded(image, OutputFormat::pfm);
    CHECK(file == "PF\n3 2\n-1.0\n" + floats({rgb.begin() + 9, rgb.end()}) + floats({rgb.begin(), rgb.begin() + 9}));
}

TEST_CASE("float image: PFM and EXR files give each bit of the picture back", "[io][float_image]") {
    for (const float alpha : {1.0f, 0.5f, 0.0f}) {
        CAPTURE(alpha);
        const Image image = test_picture(alpha);
        for (const OutputFormat format : {OutputFormat::pfm, OutputFormat::exr}) {
            if (format == OutputFormat::exr && !has_exr()) continue;
            const auto decoded = decode(encoded(image, format));
            REQUIRE(decoded);
            CHECK(decoded->width == 3);
            CHECK(decoded->height == 2);
            CHECK(same_bits(decoded->rgb, rgb_of(image, alpha)));
        }
    }
}

TEST_CASE("float image: PFM files of either byte order, one channel and any factor are read", "[io][float_image]") {
    const auto grey = decode("Pf 2 1\n2.0\n" + floats({0.25f, 3.0f}, false));
    REQUIRE(grey);
    CHECK(grey->rgb == std::vector<float>{0.5f, 0.5f, 0.5f, 6.0f, 6.0f, 6.0f});
    const auto color = decode("PF\r\n1 2\n-1\n" + floats({1, 2, 3, 4, 5, 6}));
    REQUIRE(color);
    CHECK(color->rgb == std::vector<float>{4, 5, 6, 1, 2, 3});
}

TEST_CASE("float image: EXR files made by hand are read, wherever their window lies", "[io][float_image]") {
    REQUIRE_EXR();
    ExrFile f{.x = -7, .y = 3};
    const auto decoded =
        decode(exr_file(f, {floats({1, 2}) + floats({3, 4}) + floats({5, 6}), floats({7, 8}) + floats({9, 10}) + floats({11, 12})}));
    REQUIRE(decoded);
    CHECK(decoded->rgb == std::vector<float>{5, 3, 1, 6, 4, 2, 11, 9, 7, 12, 10, 8});

    ExrFile grey{.height = 1, .channels = {"Y"}, .type = kHalf};
    const auto halves = decode(exr_file(grey, {little(0x3800, 2) + little(0x4100, 2)}));  // 0.5 and 2.5
    REQUIRE(halves);
    CHECK(halves->rgb == std::vector<float>{0.5f, 0.5f, 0.5f, 2.5f, 2.5f, 2.5f});
}

TEST_CASE("float image: negative and infinite values become light, and a NaN is an error that names its pixel", "[io][float_image]") {
    const auto pfm = decode("Pf\n4 1\n-1\n" + floats({-1.0f, -kInfinity, kInfinity, 2e30f}));
    REQUIRE(pfm);
    for (std::size_t i = 0; i < 6; ++i) CHECK(pfm->rgb[i] == 0.0f);
    for (std::size_t i = 6; i < 12; ++i) CHECK(pfm->rgb[i] == kLargestLight);
    CHECK(message_of("Pf\n2 2\n-1\n" + floats({0, 0, 0, kNan})) == "pixel 1,0: expected a number, found NaN");
    REQUIRE_EXR();
    ExrFile f{.height = 1, .channels = {"Y"}, .type = kHalf};
    const auto halves = decode(exr_file(f, {little(0x7c00, 2) + little(0xfc00, 2)}));  // both infinities
    REQUIRE(halves);
    CHECK(halves->rgb == std::vector<float>{65504, 65504, 65504, 0, 0, 0});
    CHECK(message_of(exr_file(f, {little(0, 2) + little(0x7e00, 2)})) == "pixel 1,0: expected a number, found NaN");
}

TEST_CASE("float image: sizes above the limits are refused by the header", "[io][float_image]") {
    message_of("PF\n20000 1\n-1\n", ErrorCode::limit);
    message_of("PF\n2147483647 2147483647\n-1\n", ErrorCode::limit);
    message_of("PF\n-3 2\n-1\n");
    message_of("PF\n3 2\n0\n");
    message_of("PF\n3 2\nnan\n");
    REQUIRE_EXR();
    message_of(exr_header({.width = 20000}), ErrorCode::limit);
    message_of(exr_header({.x = -2147483647 - 1, .width = 2147483647, .height = 1}), ErrorCode::limit);
    CHECK(message_of(exr_header({.version = 0x802})).find("deep") != std::string::npos);
    CHECK(message_of(exr_header({.version = 0x1002})).find("several parts") != std::string::npos);
    CHECK(message_of(exr_header({.version = 3})).find("version 2") != std::string::npos);
    CHECK(message_of(exr_header({.more = attribute("envmap", "envmap", "\x01")})).find("cube map") != std::string::npos);
    const auto tiles = [](int side) {
        const std::string of = little(static_cast<std::uint32_t>(side));
        return attribute("tiles", "tiledesc", of + of + '\0');
    };
    message_of(exr_header({.version = 0x202, .more = tiles(100000)}), ErrorCode::limit);
    message_of(exr_header({.version = 0x202, .more = tiles(2147483647)}), ErrorCode::limit);
    message_of(exr_header({.version = 0x202, .more = tiles(0)}));
    std::vector<std::string> many;
    for (int i = 0; i < 1000; ++i) many.push_back(std::to_string(1000 + i));
    message_of(exr_header({.width = 16384, .channels = many}), ErrorCode::limit);
}

TEST_CASE("float image: several channels other than R, G and B are refused by name", "[io][float_image]") {
    REQUIRE_EXR();
    CHECK(message_of(exr_file({.width = 1, .height = 1, .channels = {"BY", "RY", "Y"}}, {floats({1, 2, 3})})) ==
          "expected the channels R G B, or one alone, found BY RY Y");
}

TEST_CASE("float image: every cut-off file ends with one line", "[io][float_image]") {
    std::vector<std::string> files{encoded(test_picture(1.0f), OutputFormat::pfm)};
    if (has_exr()) {
        files.push_back(encoded(test_picture(0.5f), OutputFormat::exr));
        files.push_back(exr_file({}, {floats({1, 2, 3, 4, 5, 6}), floats({1, 2, 3, 4, 5, 6})}));
    }
    for (const std::string& file : files) {
        REQUIRE(decode(file));
        for (std::size_t size = 0; size < file.size(); ++size) {
            CAPTURE(size, file.substr(0, 2));
            message_of(file.substr(0, size));
        }
    }
}

TEST_CASE("float image: files with random bytes give a sound picture or one line", "[io][float_image]") {
    std::vector<std::string> files{encoded(test_picture(1.0f), OutputFormat::pfm)};
    if (has_exr()) {
        files.push_back(encoded(test_picture(0.5f), OutputFormat::exr));
        files.push_back(exr_file({}, {floats({1, 2, 3, 4, 5, 6}), floats({1, 2, 3, 4, 5, 6})}));
    }
    test::Random random(7);
    int refused = 0, read = 0;
    for (const std::string& file : files)
        for (int i = 0; i < 3000; ++i) {
            std::string damaged = file;
            for (int n = random.index(4); n >= 0; --n)
                damaged[static_cast<std::size_t>(random.index(static_cast<int>(file.size())))] = static_cast<char>(random.index(256));
            const auto decoded = decode(damaged, {64, 64, 4096});
            if (!decoded) {
                ++refused;
                REQUIRE_FALSE(decoded.error().message.empty());
                REQUIRE(decoded.error().message.find('\n') == std::string::npos);
                continue;
            }
            ++read;
            REQUIRE(decoded->rgb.size() == static_cast<std::size_t>(decoded->width * decoded->height * 3));
            for (const float value : decoded->rgb) REQUIRE((value >= 0.0f && value <= kLargestLight));
        }
    CHECK(refused > 1000);
    CHECK(read > 500);
}
