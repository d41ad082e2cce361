#include "apps/io/pictures/rgbe_reader.hpp"

#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>

using namespace halflit;
using namespace halflit::io;

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Pixels of a test picture. Neighbours differ; with `runs`, five in a row are alike.
std::vector<Rgbe> test_pixels(int width, int height, bool runs) {
    std::vector<Rgbe> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int step = runs ? x / 5 : x;
            pixels.push_back({static_cast<std::uint8_t>(10 + step), static_cast<std::uint8_t>(20 + y),
                              static_cast<std::uint8_t>(200 - step), static_cast<std::uint8_t>(125 + (step + y) % 8)});
        }
    return pixels;
}

std::string header(const std::string& resolution, const std::string& variables = "FORMAT=32-bit_rle_rgbe\n") {
    return "#?RADIANCE\n# made by a test\n" + variables + "\n" + resolution + "\n";
}

void put(std::string& file, const Rgbe& pixel) {
    for (const std::uint8_t c : pixel) file += static_cast<char>(c);
}

std::string flat(const std::vector<Rgbe>& pixels) {
    std::string bytes;
    for (const Rgbe& pixel : pixels) put(bytes, pixel);
    return bytes;
}

/// Encodes old run lengths, scanline by scanline. A run above 255 takes a second marker for the higher byte of its length.
std::string old_runs(const std::vector<Rgbe>& pixels, std::size_t line) {
    std::string bytes;
    for (std::size_t begin = 0; begin < pixels.size(); begin += line)
        for (std::size_t x = begin; x < begin + line;) {
            std::size_t end = x + 1;
            while (end < begin + line && pixels[end] == pixels[x]) ++end;
            put(bytes, pixels[x]);
            for (std::size_t count = end - x - 1; count > 0; count >>= 8) put(bytes, {1, 1, 1, static_cast<std::uint8_t>(count & 255)});
            x = end;
        }
    return bytes;
}

std::string new_runs(const std::vector<Rgbe>& pixels, std::size_t line) {
    std::string bytes;
    for (std::size_t begin = 0; begin < pixels.size(); begin += line) {
        put(bytes, {2, 2, static_cast<std::uint8_t>(line >> 8), static_cast<std::uint8_t>(line & 255)});
        for (std::size_t c = 0; c < 4; ++c)
            for (std::size_t x = 0; x < line;) {
                std::size_t end = x + 1;
                while (end < line && end - x < 127 && pixels[begin + end][c] == pixels[begin + x][c]) ++end;
                if (end - x > 2) {
                    bytes += static_cast<char>(128 + (end - x));
                    bytes += static_cast<char>(pixels[begin + x][c]);
                    x = end;
                    continue;
                }
                // literals up to the next run of three
                end = x + 1;
                while (end < line && end - x < 128 &&
                       !(end + 2 < line && pixels[begin + end][c] == pixels[begin + end + 1][c] &&
                         pixels[begin + end][c] == pixels[begin + end + 2][c]))
                    ++end;
                bytes += static_cast<char>(end - x);
                for (; x < end; ++x) bytes += static_cast<char>(pixels[begin + x][c]);
            }
    }
    return bytes;
}

Result<RgbeImage> decode(const std::string& file, const RgbeLimits& limits = {}) {
    return decode_rgbe({reinterpret_cast<const std::byte*>(file.data()), file.size()}, limits);
}

float value(std::uint8_t mantissa, std::uint8_t exponent) {
    return exponent == 0 ? 0.0f : static_cast<float>(std::ldexp(static_cast<double>(mantissa), exponent - 136));
}

bool shows(const RgbeImage& image, const std::vector<Rgbe>& pixels) {
    if (image.rgb.size() != pixels.size() * 3) return false;
    for (std::size_t i = 0; i < pixels.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            if (image.rgb[3 * i + c] != value(pixels[i][c], pixels[i][3])) return false;
    return true;
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// A small file of each encoding, 13 x 5.
std::vector<std::string> small_files() {
    const auto pixels = test_pixels(13, 5, true);
    const std::string head = header("-Y 5 +X 13");
    return {head + flat(pixels), head + old_runs(pixels, 13), head + new_runs(pixels, 13)};
}

}  // namespace

TEST_CASE("rgbe: flat, old and new run lengths give the same pixels", "[io][rgbe]") {
    for (const bool runs : {false, true})
        for (const int width : {1, 7, 8, 13, 200, 700}) {
            const auto pixels = test_pixels(width, 6, runs);
            const auto line = static_cast<std::size_t>(width);
            std::vector<std::string> bodies = {flat(pixels), old_runs(pixels, line)};
            if (width >= 8) bodies.push_back(new_runs(pixels, line));
            for (const std::string& body : bodies) {
                const auto image = decode(header("-Y 6 +X " + std::to_string(width)) + body);
                REQUIRE(image);
                CHECK(image->width == width);
                CHECK(image->height == 6);
                CHECK(shows(*image, pixels));
            }
        }
}

TEST_CASE("rgbe: a scanline of one colour is read from old runs of more than 255", "[io][rgbe]") {
    const std::vector<Rgbe> pixels(1000, Rgbe{10, 20, 30, 128});
    const auto image = decode(header("-Y 1 +X 1000") + old_runs(pixels, 1000));
    REQUIRE(image);
    CHECK(shows(*image, pixels));
}

TEST_CASE("rgbe: all eight orders show the same picture", "[io][rgbe]") {
    const int width = 9, height = 4;
    const auto shown = test_pixels(width, height, false);
    for (const bool columns : {false, true})
        for (const bool x_minus : {false, true})
            for (const bool y_plus : {false, true}) {
                // The file's pixels, slow axis first.
                std::vector<Rgbe> stored;
                for (int slow = 0; slow < (columns ? width : height); ++slow)
                    for (int fast = 0; fast < (columns ? height : width); ++fast) {
                        const int x = columns ? slow : fast, y = columns ? fast : slow;
                        stored.push_back(
                            shown[static_cast<std::size_t>((y_plus ? height - 1 - y : y) * width + (x_minus ? width - 1 - x : x))]);
                    }
                const std::string x_axis = std::string(x_minus ? "-X " : "+X ") + std::to_string(width);
                const std::string y_axis = std::string(y_plus ? "+Y " : "-Y ") + std::to_string(height);
                const std::string resolution = columns ? x_axis + " " + y_axis : y_axis + " " + x_axis;
                INFO(resolution);
                const auto image = decode(header(resolution) + flat(stored));
                REQUIRE(image);
                CHECK(image->width == width);
                CHECK(image->height == height);
                CHECK(shows(*image, shown));
                if (!columns) CHECK(shows(*decode(header(resolution) + new_runs(stored, width)), shown));
            }
}

TEST_CASE("rgbe: values are mantissa * 2^(exponent - 136), black at exponent 0, 1e30 at most", "[io][rgbe]") {
    const std::vector<Rgbe> pixels = {{128, 64, 255, 129}, {255, 255, 255, 0}, {1, 0, 0, 1}, {128, 128, 128, 255}};
    const auto image = decode(header("-Y 1 +X 4") + flat(pixels));
    REQUIRE(image);
    CHECK(image->rgb[0] == 1.0f);
    CHECK(image->rgb[1] == 0.5f);
    CHECK(image->rgb[2] == 255.0f / 128.0f);
    CHECK(image->rgb[3] == 0.0f);
    CHECK(image->rgb[6] == std::ldexp(1.0f, -135));
    CHECK(image->rgb[9] == 1e30f);
}

TEST_CASE("rgbe: EXPOSURE and COLORCORR lines are multiplied and taken back out", "[io][rgbe]") {
    const std::vector<Rgbe> pixels = {{128, 128, 128, 129}};
    const auto image = decode(header("-Y 1 +X 1", "EXPOSURE=2\nEXPOSURE= 0.25\nCOLORCORR=1 2 4\nVIEW= -vtl\n") + flat(pixels));
    REQUIRE(image);
    CHECK(image->rgb[0] == 2.0f);
    CHECK(image->rgb[1] == 1.0f);
    CHECK(image->rgb[2] == 0.5f);
    for (const char* bad : {"EXPOSURE=0\n", "EXPOSURE=-1\n", "EXPOSURE=nan\n", "EXPOSURE=1e400\n", "EXPOSURE=\n", "EXPOSURE=1 2\n",
                            "COLORCORR=1 2\n", "COLORCORR=1 2 x\n", "EXPOSURE=1e-30\nEXPOSURE=1e-30\nEXPOSURE=1e-30\n"}) {
        INFO(bad);
        const auto result = decode(header("-Y 1 +X 1", bad) + flat(pixels));
        REQUIRE_FALSE(result);
        CHECK(result.error().code == ErrorCode::bad_input);
    }
}

TEST_CASE("rgbe: #?RGBE, other names after #?RADIANCE, CRLF and no FORMAT line are read", "[io][rgbe]") {
    const std::string body = flat({{128, 128, 128, 129}});
    for (const std::string head :
         {"#?RGBE\n\n-Y 1 +X 1\n", "#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 1 +X 1\r\n", "#?RADIANCE\n\n  -Y  1\t+X 1 \n"}) {
        INFO(head);
        const auto image = decode(head + body);
        REQUIRE(image);
        CHECK(image->rgb[0] == 1.0f);
    }
}

TEST_CASE("rgbe: other files are refused with what was expected", "[io][rgbe]") {
    const std::string body = flat({{128, 128, 128, 129}});
    const std::pair<std::string, std::string> cases[] = {
        {"", "expected a Radiance picture"},
        {"\x89PNG\r\n", "expected a Radiance picture"},
        {"#?RADIANCE", "expected a Radiance picture"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + body, "expected FORMAT=32-bit_rle_rgbe"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", "the file ends within the header"},
        {"#?RADIANCE\n\n-Y 1 -Y 1\n" + body, "expected a resolution"},
        {"#?RADIANCE\n\n-Y 0 +X 1\n" + body, "expected a resolution"},
        {"#?RADIANCE\n\n-Y -5 +X 1\n" + body, "expected a resolution"},
        {"#?RADIANCE\n\n-Y 99999999999 +X 1\n" + body, "expected a resolution"},
        {"#?RADIANCE\n\n-Y 1 +X 1 2\n" + body, "expected a resolution"},
        {"#?RADIANCE\n\n\x1b[2J\n" + body, "\\x1b"},
        {"#?RADIANCE\n" + std::string(100000, 'x'), "longer than 65536 bytes"},
        {header("-Y 1 +X 2") + std::string("\1\1\1\5", 4) + body, "no pixel before it"},
        {header("-Y 1 +X 2") + body + std::string("\1\1\1\5", 4), "goes past the end"},
        {header("-Y 1 +X 8") + std::string("\2\2\0\x09", 4), "expected a scanline of 8 pixels, found one of 9"},
        {header("-Y 1 +X 8") + std::string("\2\2\0\x08\0\0", 6), "a run of no pixels"},
        {header("-Y 1 +X 8") + std::string("\2\2\0\x08\xff\0", 6), "goes past the end"}};
    for (const auto& [file, expected] : cases) {
        INFO(expected);
        const auto result = decode(file);
        REQUIRE_FALSE(result);
        CHECK(result.error().code == ErrorCode::bad_input);
        CHECK(result.error().message.find(expected) != std::string::npos);
    }
}

TEST_CASE("rgbe: a picture that is too large is refused by its header, before any pixel", "[io][rgbe]") {
    for (const char* resolution : {"-Y 8193 +X 16384", "-Y 8192 +X 16385", "+X 16385 -Y 1", "-Y 2000000000 +X 2000000000"}) {
        const auto result = decode(header(resolution));
        REQUIRE_FALSE(result);
        CHECK(result.error().code == ErrorCode::limit);
    }
    CHECK(decode(header("-Y 1 +X 4") + flat(test_pixels(4, 1, false)), {4, 1}));
    CHECK_FALSE(decode(header("-Y 1 +X 4") + flat(test_pixels(4, 1, false)), {3, 1}));
    const auto start = std::chrono::steady_clock::now();
    CHECK_FALSE(decode(header("-Y 8192 +X 16384") + "\2\2"));  // at the limit, and nothing in it
    CHECK(milliseconds_since(start) < 10);
}

TEST_CASE("rgbe: a file cut off at any byte is an error, at once", "[io][rgbe]") {
    const auto start = std::chrono::steady_clock::now();
    int cuts = 0;
    for (const std::string& file : small_files()) {
        REQUIRE(decode(file));
        for (std::size_t size = 0; size < file.size(); ++size, ++cuts) CHECK_FALSE(decode(file.substr(0, size)));
    }
    CHECK(milliseconds_since(start) < 10.0 * cuts);
}

TEST_CASE("rgbe: 2000 damaged files give an error or a picture, and all values are finite and at least 0", "[io][rgbe]") {
    test::Random random(71);
    const auto files = small_files();
    const auto start = std::chrono::steady_clock::now();
    int pictures = 0, errors = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string file = files[static_cast<std::size_t>(random.index(3))];
        for (int n = random.index(4); n >= 0; --n) {
            const auto at = static_cast<std::size_t>(random.index(static_cast<int>(file.size())));
            switch (random.index(4)) {
                case 0:
                    file[at] = static_cast<char>(random.index(256));
                    break;
                case 1:
                    file.erase(at, 1 + static_cast<std::size_t>(random.index(8)));
                    break;
                case 2:
                    file.insert(at, 1, static_cast<char>(random.index(256)));
                    break;
                default:
                    file[at] = static_cast<char>(file[at] ^ (1 << random.index(8)));
            }
            if (file.empty()) break;
        }
        const auto image = decode(file);
        (image ? pictures : errors) += 1;
        if (!image) continue;
        CHECK(image->rgb.size() == static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height) * 3);
        bool good = true;
        for (const float v : image->rgb) good = good && v >= 0 && v <= 1e30f;
        CHECK(good);
    }
    CHECK(milliseconds_since(start) < 20000);
    CHECK(pictures > 100);
    CHECK(errors > 100);
}
