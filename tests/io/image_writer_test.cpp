#include "halflit/image.hpp"

#include "apps/io/pictures/image_reader.hpp"
#include "tests/io/png_maker.hpp"
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

#include <libdeflate.h>

#include <cstdlib>
#include <functional>
#include <thread>

using namespace halflit;
using namespace halflit::test;

namespace {

using Code = std::function<std::uint8_t(int x, int y, int channel)>;

Image picture_of(int width, int height, const Code& code) {
    Image image{width, height, {}, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 4; ++c) image.rgba8.push_back(code(x, y, c));
    return image;
}

/// Bits without a pattern: they cannot be compressed.
std::uint8_t noise(int x, int y, int c) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 2654435761u ^ static_cast<std::uint32_t>(y) * 2246822519u ^
                      static_cast<std::uint32_t>(c) * 3266489917u;
    h = (h ^ h >> 15) * 2246822519u;
    h = (h ^ h >> 13) * 3266489917u;
    return static_cast<std::uint8_t>(h >> 24);
}

std::uint8_t ramp(int x, int y, int c) { return static_cast<std::uint8_t>(3 * x + 5 * y + 70 * c); }

Code opaque(const Code& code) {
    return [code](int x, int y, int c) { return c == 3 ? std::uint8_t{255} : code(x, y, c); };
}

struct Chunk {
    std::string type;
    Bytes body;
};

/// The chunks of a file whose signature, lengths and checksums are right.
std::vector<Chunk> chunks_of(const std::vector<std::uint8_t>& file) {
    const Bytes bytes = to_bytes({reinterpret_cast<const char*>(file.data()), file.size()});
    const auto number_at = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint32_t>(bytes[at + i]);
        return value;
    };
    REQUIRE(file.size() > 8);
    CHECK(std::string(file.begin(), file.begin() + 8) == "\x89PNG\r\n\x1a\n");
    std::vector<Chunk> chunks;
    for (std::size_t at = 8; at < bytes.size();) {
        REQUIRE(bytes.size() - at >= 12);
        const std::size_t size = number_at(at);
        REQUIRE(bytes.size() - at - 12 >= size);
        const auto checked = bytes.begin() + static_cast<std::ptrdiff_t>(at) + 4;
        const Bytes covered(checked, checked + 4 + static_cast<std::ptrdiff_t>(size));
        CHECK(number_at(at + 8 + size) == crc32_of(covered));
        chunks.push_back(
            {std::string(file.begin() + static_cast<std::ptrdiff_t>(at) + 4, file.begin() + static_cast<std::ptrdiff_t>(at) + 8),
             Bytes(covered.begin() + 4, covered.end())});
        at += 12 + size;
    }
    return chunks;
}

std::vector<std::uint8_t> png_of(const Image& image) {
    const auto file = encode_image(image, OutputFormat::png);
    REQUIRE(file);
    return *file;
}

/// Colour type of the header: 2 is RGB, 6 is RGBA.
int color_type_of(const std::vector<std::uint8_t>& file) { return file.at(25); }

/// Reads the file by libspng and zlib, which share no code with the writer.
void check_round_trip(const Image& image) {
    const auto file = png_of(image);
    const auto chunks = chunks_of(file);
    REQUIRE(chunks.size() == 3);
    CHECK(chunks[0].type == "IHDR");
    CHECK(chunks[1].type == "IDAT");
    CHECK(chunks[2].type == "IEND");
    const auto read = io::decode_image(std::as_bytes(std::span(file)));
    REQUIRE(read);
    CHECK(read->width == image.width);
    CHECK(read->height == image.height);
    CHECK(read->rgba8 == image.rgba8);
}

}  // namespace

TEST_CASE("PNG: pictures of every small width come back, opaque or not, smooth or noise", "[io][png]") {
    for (const Code& code : {Code(ramp), Code(noise), opaque(ramp), opaque(noise)})
        for (int width = 1; width <= 17; ++width)
            for (const int height : {1, 2, 5}) {
                INFO(width << "x" << height);
                check_round_trip(picture_of(width, height, code));
            }
    check_round_trip(picture_of(1, 3000, ramp));
    check_round_trip(picture_of(3000, 1, opaque(noise)));
    check_round_trip(picture_of(701, 503, noise));  // 1.4 MB that do not compress: many blocks
    check_round_trip(picture_of(701, 503, opaque(ramp)));
}

TEST_CASE("PNG: it is RGB where every pixel is opaque, and one other alpha makes it RGBA", "[io][png]") {
    Image image = picture_of(7, 5, opaque(noise));
    const std::size_t opaque_size = png_of(image).size();
    CHECK(color_type_of(png_of(image)) == 2);
    for (std::size_t alpha = 3; alpha < image.rgba8.size(); alpha += 4)
        for (const std::uint8_t code : {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{127}, std::uint8_t{254}}) {
            image.rgba8[alpha] = code;
            INFO("pixel " << alpha / 4 << ", alpha " << int{code});
            CHECK(color_type_of(png_of(image)) == 6);
            check_round_trip(image);
            image.rgba8[alpha] = 255;
        }
    CHECK(png_of(image).size() == opaque_size);
    check_round_trip(picture_of(9, 9, [](int, int, int) { return std::uint8_t{0}; }));
    check_round_trip(picture_of(9, 9, [](int x, int y, int c) { return c == 3 ? std::uint8_t{0} : noise(x, y, c); }));
}

TEST_CASE("PNG: threads that encode at once make the file that one thread makes", "[io][png]") {
    const Image image = picture_of(200, 100, ramp);
    std::vector<std::vector<std::uint8_t>> files(4);
    std::vector<std::thread> threads;
    for (auto& file : files)
        threads.emplace_back([&image, &file] {
            if (auto made = encode_image(image, OutputFormat::png)) file = std::move(*made);
        });
    for (std::thread& thread : threads) thread.join();
    for (const auto& file : files) CHECK(file == png_of(image));
}

TEST_CASE("PNG: without memory for the compressor the picture is not encoded, and the next one is", "[io][png]") {
    const Image image = picture_of(64, 64, opaque(ramp));
    const auto expected = png_of(image);
    libdeflate_set_memory_allocator([](std::size_t) -> void* { return nullptr; }, std::free);
    const auto failed = encode_image(image, OutputFormat::png);
    libdeflate_set_memory_allocator(std::malloc, std::free);
    REQUIRE(!failed);
    CHECK(failed.error().code == ErrorCode::limit);
    CHECK(failed.error().message == "out of memory while encoding the picture");
    CHECK(png_of(image) == expected);
}

TEST_CASE("WebP: pixels come back as they were, those with alpha 0 too", "[io][image]") {
    const Image image = picture_of(37, 19, [](int x, int y, int c) { return c == 3 && x < 12 ? std::uint8_t{0} : noise(x, y, c); });
    const auto file = encode_image(image, OutputFormat::webp);
    if (!file) HALFLIT_SKIP("built without libwebp");
    const auto back = io::decode_image(to_bytes({reinterpret_cast<const char*>(file->data()), file->size()}));
    REQUIRE(back);
    CHECK(back->rgba8 == image.rgba8);
}
