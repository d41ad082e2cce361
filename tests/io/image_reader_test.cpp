#include "apps/io/pictures/image_reader.hpp"

#include "tests/io/png_maker.hpp"

#include "tests/support/catch.hpp"

#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>

using namespace halflit;
using namespace halflit::io;
using namespace halflit::test;

namespace {

std::uint32_t noise(std::uint32_t x, std::uint32_t y, int c) {
    std::uint32_t h = x * 2654435761u ^ y * 40503u ^ static_cast<std::uint32_t>(c) * 97u;
    h ^= h >> 15;
    h *= 2246822519u;
    return h ^ h >> 13;
}

struct JpegSpec {
    int width = 16, height = 16, channels = 3;
    J_COLOR_SPACE space = JCS_RGB;
    int quality = 100;
    int scans = 0;  ///< 0: baseline
};

Bytes make_jpeg(const JpegSpec& spec, const std::vector<std::uint8_t>& pixels) {
    jpeg_compress_struct info{};
    jpeg_error_mgr errors{};
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    unsigned char* out = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&info, &out, &size);
    info.image_width = static_cast<JDIMENSION>(spec.width);
    info.image_height = static_cast<JDIMENSION>(spec.height);
    info.input_components = spec.channels;
    info.in_color_space = spec.space;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, spec.quality, TRUE);
    for (int c = 0; c < info.num_components; ++c) info.comp_info[c].h_samp_factor = info.comp_info[c].v_samp_factor = 1;
    std::vector<jpeg_scan_info> script;
    if (spec.scans > 0) {  // DC, then one AC band after the other, of one component
        script.push_back({1, {0}, 0, 0, 0, 0});
        for (int k = 1; k < spec.scans; ++k) script.push_back({1, {0}, k, k == spec.scans - 1 ? 63 : k, 0, 0});
        info.scan_info = script.data();
        info.num_scans = static_cast<int>(script.size());
    }
    jpeg_start_compress(&info, TRUE);
    while (info.next_scanline < info.image_height) {
        auto* row = const_cast<unsigned char*>(pixels.data()) +
                    static_cast<std::size_t>(info.next_scanline) * static_cast<std::size_t>(spec.width * spec.channels);
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    Bytes file(size);
    std::memcpy(file.data(), out, size);
    std::free(out);
    return file;
}

struct Rows : RowSink {
    std::vector<std::uint8_t> rgba8;
    std::vector<std::uint16_t> rgba16;
    std::size_t row = 0;  // channel values

    void add_row(const std::uint8_t* values) override { rgba8.insert(rgba8.end(), values, values + row); }
    void add_row(const std::uint16_t* values) override { rgba16.insert(rgba16.end(), values, values + row); }
};

/// True if the file can be decoded; whole and by rows give the same answer.
bool decodes(std::span<const std::byte> file) {
    const auto header = read_image_header(file);
    Rows rows;
    if (header) rows.row = 4 * static_cast<std::size_t>(header->width);
    const bool whole = decode_image(file).has_value();
    if (whole != decode_rows(file, {}, false, rows).has_value()) FAIL("whole and by rows differ");
    return whole;
}

DecodedImage decode_ok(const Bytes& file, bool keep_16_bits = false) {
    auto image = decode_image(file, {}, keep_16_bits);
    if (!image) FAIL(image.error().message);
    Rows rows;
    rows.row = 4 * static_cast<std::size_t>(image->width);
    if (const auto added = decode_rows(file, {}, keep_16_bits, rows); !added) FAIL(added.error().message);
    if (rows.rgba8 != image->rgba8 || rows.rgba16 != image->rgba16) FAIL("rows differ from the whole");
    return *std::move(image);
}

}  // namespace

TEST_CASE("png: every colour type, bit depth and interlacing gives the stored samples", "[io]") {
    for (const int type : {0, 2, 3, 4, 6}) {
        for (const int bits : {1, 2, 4, 8, 16}) {
            if ((type == 2 || type == 4 || type == 6) && bits < 8) continue;
            if (type == 3 && bits == 16) continue;
            for (const bool interlaced : {false, true}) {
                for (const std::uint32_t width : {1u, 5u, 19u}) {
                    PngSpec spec{width, 13, bits, type, interlaced, {}, {}};
                    const std::uint32_t entries = 1u << std::min(bits, 8), top = (1u << bits) - 1;
                    if (type == 3)
                        for (std::uint32_t i = 0; i < 3 * entries; ++i) spec.palette.push_back(static_cast<std::byte>(i * 37 % 256));
                    if (type == 3) spec.transparency = {std::byte{7}, std::byte{200}};
                    const auto sample = [&](std::uint32_t x, std::uint32_t y, int c) { return noise(x, y, c) & top; };
                    const DecodedImage image = decode_ok(make_png(spec, sample));
                    INFO("type " << type << " bits " << bits << " interlaced " << interlaced << " width " << width);
                    REQUIRE(image.rgba8.size() == std::size_t{4} * width * 13);
                    bool same = true;
                    for (std::uint32_t y = 0; y < 13; ++y) {
                        for (std::uint32_t x = 0; x < width; ++x) {
                            const auto to8 = [&](int c) { return static_cast<std::uint32_t>((sample(x, y, c) * 255.0) / top + 0.5); };
                            std::uint32_t want[4];
                            for (int c = 0; c < 4; ++c) {
                                if (type == 0) want[c] = c < 3 ? to8(0) : 255;
                                if (type == 2) want[c] = c < 3 ? to8(c) : 255;
                                if (type == 4) want[c] = c < 3 ? to8(0) : to8(1);
                                if (type == 6) want[c] = to8(c);
                                const std::uint32_t index = sample(x, y, 0);
                                if (type == 3)
                                    want[c] = c < 3        ? (3 * index + static_cast<std::uint32_t>(c)) * 37 % 256
                                              : index == 0 ? 7
                                              : index == 1 ? 200
                                                           : 255;
                                same = same && image.rgba8[4 * (y * width + x) + static_cast<std::uint32_t>(c)] == want[c];
                            }
                        }
                    }
                    CHECK(same);
                }
            }
        }
    }
}

TEST_CASE("png: rows of every filter below rows of every filter give the stored samples", "[io]") {
    // Each filter follows each, on even and odd rows.
    std::vector<int> filters;
    for (int a = 0; a < 5; ++a)
        for (int b = 0; b < 5; ++b) filters.insert(filters.end(), {a, b});
    filters.push_back(0);
    const auto filter = GENERATE(0, 1, 2, 3, 4, 5);
    if (filter < 5) filters = {filter};
    for (const int type : {0, 2, 3, 4, 6}) {
        for (const int bits : {8, 16}) {
            if (type == 3 && bits == 16) continue;
            for (const std::uint32_t width : {1u, 2u, 19u}) {
                for (const std::uint32_t height : {1u, 2u, 7u, 103u}) {
                    PngSpec spec{width, height, bits, type, false, {}, {}, filters, {}};
                    if (type == 3)
                        for (int i = 0; i < 256; ++i) spec.palette.insert(spec.palette.end(), 3, static_cast<std::byte>(255 - i));
                    // The high byte is the sample of 8 bits: rounding keeps it.
                    const auto sample = [&](std::uint32_t x, std::uint32_t y, int c) {
                        return (noise(x, y, c) & 255) * (bits == 16 ? 257 : 1);
                    };
                    const auto sample8 = [&](std::uint32_t x, std::uint32_t y, int c) { return noise(x, y, c) & 255; };
                    const DecodedImage image = decode_ok(make_png(spec, sample));
                    INFO("filter " << filter << " type " << type << " bits " << bits << " width " << width << " height " << height);
                    REQUIRE(image.rgba8.size() == std::size_t{4} * width * height);
                    bool same = true;
                    for (std::uint32_t i = 0; i < 4 * width * height; ++i) {
                        const std::uint32_t x = i / 4 % width, y = i / 4 / width, c = i % 4;
                        const bool has_alpha = type == 4 || type == 6, is_grey = type == 0 || type == 4;
                        std::uint32_t want = sample8(x, y, static_cast<int>(is_grey ? c / 3 : c));
                        if (type == 3) want = 255 - sample8(x, y, 0);
                        if (c == 3 && !has_alpha) want = 255;
                        same = same && image.rgba8[i] == want;
                    }
                    CHECK(same);
                }
            }
        }
    }
}

TEST_CASE("png: chunks after the pixels, a transparent colour and indices past the palette are read", "[io]") {
    const auto sample = [](std::uint32_t x, std::uint32_t, int) { return 3 * x; };
    Bytes text;
    append_chunk(text, "tEXt", to_bytes(std::string_view("k\0v", 3)));
    CHECK(decode_ok(make_png({4, 3, 8, 0, false, {}, {}, {4}, text}, sample)).rgba8[12] == 9);
    const Bytes second = {std::byte{0}, std::byte{3}};
    const DecodedImage clear = decode_ok(make_png({4, 3, 8, 0, false, {}, second, {4}, {}}, sample));
    for (std::size_t x = 0; x < 4; ++x) CHECK(clear.rgba8[4 * x + 3] == (x == 1 ? 0 : 255));
    const Bytes palette(9, std::byte{7});
    CHECK(decode_ok(make_png({2, 1, 8, 3, false, palette, {}, {}, {}}, sample)).rgba8 ==
          std::vector<std::uint8_t>{7, 7, 7, 255, 0, 0, 0, 255});
}

TEST_CASE("png: notes before the pixels may be empty, many or large", "[io]") {
    const auto sample = [](std::uint32_t x, std::uint32_t, int) { return 3 * x; };
    const Bytes second = {std::byte{0}, std::byte{3}};
    for (const bool transparent : {false, true}) {
        const Bytes plain = make_png({4, 3, 8, 0, false, {}, transparent ? second : Bytes{}, {4}, {}}, sample);
        const auto wanted = decode_ok(plain).rgba8;
        constexpr std::ptrdiff_t kHeader = 33;  // bytes
        Bytes empty, many, large;
        append_chunk(empty, "eXIf", {});
        for (int i = 0; i < 3000; ++i) append_chunk(many, "tEXt", to_bytes(std::string_view("k\0v", 3)));
        append_chunk(large, "tEXt", Bytes(std::size_t{20} << 20, std::byte{65}));
        for (const Bytes& notes : {empty, many, large}) {
            Bytes file = plain;
            file.insert(file.begin() + kHeader, notes.begin(), notes.end());
            CHECK(decode_ok(file).rgba8 == wanted);
        }
    }
}

TEST_CASE("png: 16 bits are kept when asked for", "[io]") {
    const auto sample = [](std::uint32_t x, std::uint32_t y, int c) { return noise(x, y, c) & 0xFFFFu; };
    const Bytes file = make_png({3, 2, 16, 6, false, {}, {}}, sample);
    CHECK(read_image_header(file)->bits == 16);
    const DecodedImage image = decode_ok(file, true);
    CHECK(image.rgba8.empty());
    REQUIRE(image.rgba16.size() == 24);
    for (std::uint32_t i = 0; i < 24; ++i) CHECK(image.rgba16[i] == sample(i / 4 % 3, i / 12, static_cast<int>(i % 4)));
}

TEST_CASE("png: cut, damaged and oversized files are refused", "[io]") {
    const Bytes good = plain_png(20, 20, 10, 20, 30);
    CHECK(decode_ok(good).rgba8[4 * 399 + 2] == 30);
    for (std::size_t length = 0; length + 12 < good.size(); ++length)  // the last 12 bytes are IEND
        if (decodes(std::span(good).first(length))) FAIL("cut to " << length);
    std::size_t refused = 0;
    for (std::size_t at = 8; at + 12 < good.size(); ++at) {
        Bytes bad = good;
        bad[at] ^= std::byte{0x10};
        refused += decodes(bad) ? 0 : 1;
    }
    CHECK(refused == good.size() - 20);  // each byte is covered by a CRC
    const auto header_only = [](std::uint32_t width, std::uint32_t height) {
        Bytes file = plain_png(1, 1, 0, 0, 0);
        Bytes header;
        append_big(header, width);
        append_big(header, height);
        for (const int v : {8, 6, 0, 0, 0}) header.push_back(static_cast<std::byte>(v));
        Bytes out(file.begin(), file.begin() + 8);
        append_chunk(out, "IHDR", header);
        out.insert(out.end(), file.begin() + 33, file.end());
        return out;
    };
    const auto filtered = [](int filter) {
        Bytes raw(2 * 9, std::byte{1});
        raw[9] = static_cast<std::byte>(filter);
        Bytes file = make_png({2, 2, 8, 6, false, {}, {}, {}, {}}, [](std::uint32_t, std::uint32_t, int) { return 1u; });
        file.resize(33);
        append_chunk(file, "IDAT", zlib_stored(raw));
        append_chunk(file, "IEND", {});
        return file;
    };
    CHECK(decodes(filtered(4)));
    CHECK(!decodes(filtered(5)));
    CHECK(!decodes(filtered(255)));
    CHECK(decode_image(header_only(30000, 30000)).error().code == ErrorCode::limit);
    CHECK(decode_image(header_only(16385, 1)).error().code == ErrorCode::limit);
    CHECK(decode_image(header_only(16384, 16384)).error().code == ErrorCode::limit);
    CHECK(decode_image(header_only(8000, 8000)).error().code == ErrorCode::bad_input);  // the data is too short for it
    CHECK(decode_image(header_only(2, 2)).error().code == ErrorCode::bad_input);
    CHECK(decode_image(header_only(0, 4)).error().code == ErrorCode::bad_input);
    CHECK(decode_image(good, {16, 1000, 64}).error().code == ErrorCode::limit);
    CHECK(decode_image(good, {100, 399, 64}).error().code == ErrorCode::limit);
}

TEST_CASE("jpeg: flat RGB, grey and CMYK colours give what was put in", "[io]") {
    const auto flat = [](const JpegSpec& spec, std::initializer_list<std::uint8_t> color) {
        std::vector<std::uint8_t> pixels;
        for (int i = 0; i < spec.width * spec.height; ++i) pixels.insert(pixels.end(), color);
        return decode_ok(make_jpeg(spec, pixels));
    };
    // Quality 100 has quantisation steps of 1, so the error is the rounding of the colour transform (within 2 of 255).
    const auto near = [](const DecodedImage& image, int r, int g, int b) {
        for (std::size_t i = 0; i < image.rgba8.size(); i += 4)
            if (std::abs(image.rgba8[i] - r) > 2 || std::abs(image.rgba8[i + 1] - g) > 2 || std::abs(image.rgba8[i + 2] - b) > 2 ||
                image.rgba8[i + 3] != 255)
                return false;
        return !image.rgba8.empty();
    };
    CHECK(near(flat({17, 9, 3, JCS_RGB, 100, 0}, {200, 30, 90}), 200, 30, 90));
    CHECK(near(flat({17, 9, 1, JCS_GRAYSCALE, 100, 0}, {77}), 77, 77, 77));
    CHECK(near(flat({17, 9, 1, JCS_GRAYSCALE, 100, 5}, {77}), 77, 77, 77));
    // libjpeg writes the Adobe marker for CMYK: values are 255 - ink.
    CHECK(near(flat({8, 8, 4, JCS_CMYK, 100, 0}, {255, 128, 0, 255}), 255, 128, 0));
    CHECK(near(flat({8, 8, 4, JCS_CMYK, 100, 0}, {255, 255, 255, 128}), 128, 128, 128));
}

TEST_CASE("jpeg: cut files, too many scans and wrong sizes are refused", "[io]") {
    std::vector<std::uint8_t> pixels(64 * 64);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(noise(static_cast<std::uint32_t>(i), 0, 0));
    const Bytes baseline = make_jpeg({64, 64, 1, JCS_GRAYSCALE, 90, 0}, pixels),
                progressive = make_jpeg({64, 64, 1, JCS_GRAYSCALE, 90, 20}, pixels);
    CHECK(decode_image(baseline));
    CHECK(decode_image(progressive));
    CHECK(decode_image(progressive, {16384, 1 << 20, 20}));
    CHECK(decode_image(progressive, {16384, 1 << 20, 19}).error().code == ErrorCode::limit);
    for (const Bytes& file : {baseline, progressive})
        for (std::size_t length = 0; length + 2 < file.size(); length += 7)
            if (decodes(std::span(file).first(length))) FAIL("cut to " << length);
    Bytes huge = baseline;  // the frame header: FF C0, length, precision, height, width
    for (std::size_t i = 0; i + 9 < huge.size(); ++i) {
        if (huge[i] != std::byte{0xFF} || huge[i + 1] != std::byte{0xC0}) continue;
        for (std::size_t k = 5; k < 9; ++k) huge[i + k] = std::byte{0x1F};  // 7967 x 7967
        break;
    }
    CHECK(decode_image(huge).error().code == ErrorCode::bad_input);
    CHECK(read_image_header(huge)->width == 0x1F1F);
}

TEST_CASE("pictures: of one that is cut off, the rows before are added where damage is kept", "[io]") {
    constexpr std::uint32_t kSide = 64;
    std::vector<std::uint8_t> grey(kSide * kSide);
    for (std::uint32_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<std::uint8_t>(i * 7 + i / kSide * 13);
    const auto noise = [](std::uint32_t x, std::uint32_t y, int c) {
        return ((x * 71 + y * 131 + static_cast<std::uint32_t>(c) * 37) * 2654435761u) >> 24;
    };
    const Bytes png = make_png({kSide, kSide, 8, 2, false, {}, {}}, noise), baseline = make_jpeg({64, 64, 1, JCS_GRAYSCALE, 95, 0}, grey),
                progressive = make_jpeg({64, 64, 1, JCS_GRAYSCALE, 95, 20}, grey);
    for (const Bytes& file : {png, baseline, progressive}) {
        const DecodedImage whole = decode_ok(file);
        Bytes cut = file;
        cut.resize(file.size() * 2 / 3);
        const bool all_rows = file == progressive;  // its later scans only add detail
        Rows rows;
        rows.row = 4 * kSide;
        const auto kept = decode_rows(cut, {.keep_damaged = true}, false, rows);
        REQUIRE_FALSE(kept);
        CHECK(kept.error().code == ErrorCode::bad_input);
        const std::size_t found = rows.rgba8.size() / rows.row;
        INFO(found << " rows");
        if (all_rows)
            CHECK(found == kSide);
        else
            CHECK((found > kSide / 2 && found < kSide));
        if (file != progressive)
            CHECK(std::equal(rows.rgba8.begin(), rows.rgba8.begin() + static_cast<std::ptrdiff_t>(rows.row * 16), whole.rgba8.begin()));
    }
}

TEST_CASE("image reader: other formats are refused by name", "[io]") {
    CHECK(decode_image(to_bytes("RIFF....WEBPVP8 ")).error().message.find("WebP") != std::string::npos);
    CHECK(decode_image(to_bytes("GIF89a")).error().message.find("found GIF") != std::string::npos);
    CHECK(decode_image({}).error().code == ErrorCode::bad_input);
    CHECK(decode_image(to_bytes("hello")).error().message.find("68 65 6c 6c") != std::string::npos);
}
