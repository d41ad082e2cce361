// PNG by libspng, and the pixels of plain files by png_plain. Gamma and colour profile chunks are ignored, as glTF demands.
#include "apps/io/pictures/image_decoders.hpp"
#include "apps/io/pictures/png_plain.hpp"

#include <libdeflate.h>
#include <spng.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>

namespace halflit::io::detail {

namespace {

// libspng reports an allocation that fails inside zlib as a damaged stream, so its allocations are watched here.
// It hands no context to them: the mark belongs to the thread that decodes.
thread_local bool allocation_failed = false;

void* watched(void* memory) {
    if (memory == nullptr) allocation_failed = true;
    return memory;
}
void* watched_malloc(std::size_t size) { return watched(std::malloc(size)); }
void* watched_calloc(std::size_t count, std::size_t size) { return watched(std::calloc(count, size)); }
void* watched_realloc(void* memory, std::size_t size) { return watched(std::realloc(memory, size)); }

struct ContextDeleter {
    void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using Context = std::unique_ptr<spng_ctx, ContextDeleter>;

constexpr std::size_t kMaxChunkBytes = std::size_t{16} << 20;  // limit of the chunks that libspng stores (text, profiles)
constexpr std::uint64_t kMaxDeflateRatio = 1032;               // deflate cannot expand more: 258 bytes from 2 bits

tl::unexpected<Error> png_error(int code) {
    if (allocation_failed || code == SPNG_EMEM || code == SPNG_EZLIB_INIT) return fail(ErrorCode::limit, "PNG: out of memory");
    return fail(ErrorCode::bad_input, fmt::format("PNG: {}", spng_strerror(code)));
}

struct Opened {
    Context context;
    spng_ihdr header{};
};

Result<Opened> open_png(std::span<const std::byte> file, const ImageLimits& limits) {
    allocation_failed = false;
    spng_alloc allocator{.malloc_fn = watched_malloc, .realloc_fn = watched_realloc, .calloc_fn = watched_calloc, .free_fn = std::free};
    Opened png{Context(spng_ctx_new2(&allocator, 0)), {}};
    if (png.context == nullptr) return fail(ErrorCode::limit, "PNG: out of memory");
    if (const int e = spng_set_png_buffer(png.context.get(), file.data(), file.size()); e != 0) return png_error(e);
    if (const int e = spng_set_chunk_limits(png.context.get(), kMaxChunkBytes, kMaxChunkBytes); e != 0) return png_error(e);
    if (const int e = spng_get_ihdr(png.context.get(), &png.header); e != 0) return png_error(e);
    const auto size = check_image_size(png.header.width, png.header.height, limits);
    if (!size) return tl::unexpected(size.error());
    return png;
}

void round_to_8_bits(std::span<const std::uint16_t> from, std::span<std::uint8_t> to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<std::uint8_t>((from[i] * 255u + 32767u) / 65535u);
}

unsigned channels_of(const spng_ihdr& header) {
    switch (header.color_type) {
        case SPNG_COLOR_TYPE_TRUECOLOR:
            return 3;
        case SPNG_COLOR_TYPE_GRAYSCALE_ALPHA:
            return 2;
        case SPNG_COLOR_TYPE_TRUECOLOR_ALPHA:
            return 4;
        default:
            return 1;
    }
}

/// Refuses a file too short for its own picture, before memory for the picture is taken.
Result<Opened> open_for_pixels(std::span<const std::byte> file, const ImageLimits& limits) {
    auto png = open_png(file, limits);
    if (!png) return png;
    const spng_ihdr& header = png->header;
    if (std::uint64_t{header.width} * header.height * channels_of(header) * header.bit_depth / 8 / kMaxDeflateRatio > file.size())
        return fail(ErrorCode::bad_input, fmt::format("PNG: {} bytes cannot hold {}x{} pixels", file.size(), header.width, header.height));
    return png;
}

/// Nothing where one colour is transparent, which png_plain does not know.
std::optional<PlainPng> plain_png(spng_ctx* context, const spng_ihdr& header) {
    PlainPng plain{header.width, header.height, header.color_type, {}};
    spng_trns transparency{};
    const bool has_transparency = spng_get_trns(context, &transparency) == 0;
    if (header.color_type != SPNG_COLOR_TYPE_INDEXED) return has_transparency ? std::nullopt : std::optional(plain);
    spng_plte palette{};
    if (spng_get_plte(context, &palette) != 0) return std::nullopt;
    plain.palette.fill({0, 0, 0, 255});  // libspng's colour past the palette's end
    for (std::size_t i = 0; i < palette.n_entries; ++i)
        plain.palette[i] = {palette.entries[i].red, palette.entries[i].green, palette.entries[i].blue, 255};
    if (has_transparency)
        for (std::size_t i = 0; i < transparency.n_type3_entries; ++i) plain.palette[i][3] = transparency.type3_alpha[i];
    return plain;
}

/// Adds the rows of a file that is not interlaced.
Result<void> add_rows(const Opened& png, std::span<const std::byte> file, bool keep_16_bits, RowSink& sink) {
    const spng_ihdr& header = png.header;
    spng_ctx* const context = png.context.get();
    if (header.bit_depth == 8) {
        if (const int e = spng_decode_chunks(context); e != 0) return png_error(e);  // those ahead of the pixels
        if (const auto plain = plain_png(context, header); plain && decode_plain_png(file, *plain, sink)) return {};
    }
    const bool deep = header.bit_depth == 16;
    const std::size_t values = std::size_t{4} * header.width;
    std::vector<std::uint16_t> row16(deep ? values : 0);
    std::vector<std::uint8_t> row8(deep && keep_16_bits ? 0 : values);
    if (const int e =
            spng_decode_image(context, nullptr, 0, deep ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8, SPNG_DECODE_TRNS | SPNG_DECODE_PROGRESSIVE);
        e != 0)
        return png_error(e);
    for (std::uint32_t y = 0; y < header.height; ++y) {
        const int e = deep ? spng_decode_row(context, row16.data(), 2 * values) : spng_decode_row(context, row8.data(), values);
        if (e != (y + 1 == header.height ? SPNG_EOI : 0)) return png_error(e);
        if (deep && keep_16_bits) {
            sink.add_row(row16.data());
            continue;
        }
        if (deep) round_to_8_bits(row16, row8);
        sink.add_row(row8.data());
    }
    if (const int e = spng_decode_chunks(context); e != 0) return png_error(e);  // checks the last checksum, and that IEND is there
    return {};
}

/// A whole picture at once, for interlaced files, whose rows do not come in order.
Result<DecodedImage> decode_at_once(const Opened& png, bool keep_16_bits) {
    const spng_ihdr& header = png.header;
    const std::uint64_t pixels = std::uint64_t{header.width} * header.height;
    DecodedImage image{static_cast<int>(header.width), static_cast<int>(header.height), {}, {}};
    const bool deep = header.bit_depth == 16;
    void* out = nullptr;
    if (deep) {
        image.rgba16.resize(pixels * 4);
        out = image.rgba16.data();
    } else {
        image.rgba8.resize(pixels * 4);
        out = image.rgba8.data();
    }
    const std::size_t bytes = pixels * 4 * (deep ? 2 : 1);
    if (const int e = spng_decode_image(png.context.get(), out, bytes, deep ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8, SPNG_DECODE_TRNS); e != 0)
        return png_error(e);
    if (const int e = spng_decode_chunks(png.context.get()); e != 0) return png_error(e);  // as above
    if (!deep || keep_16_bits) return image;
    image.rgba8.resize(pixels * 4);
    round_to_8_bits(image.rgba16, image.rgba8);
    image.rgba16 = {};
    return image;
}

/// A file that is cut off within its pixels, with an end; nothing for others. Decoders read no chunk that is not whole.
std::vector<std::byte> with_end(std::span<const std::byte> file) {
    for (std::size_t at = kPngSignature; at + kPngChunkFrame < file.size();) {
        const std::size_t size = png_number(&file[at]), left = file.size() - at - 8, data = std::min(size, left);
        if (size + 4 <= left) {
            at += size + kPngChunkFrame;
            continue;
        }
        if (std::memcmp(&file[at + 4], "IDAT", 4) != 0) return {};
        std::vector<std::byte> whole(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(at + 8 + data));
        const auto put = [](std::byte* to, std::size_t value) {
            for (int i = 0; i < 4; ++i) to[i] = static_cast<std::byte>(value >> (24 - 8 * i));
        };
        put(&whole[at], data);
        std::byte sum[4];
        put(sum, libdeflate_crc32(0, &whole[at + 4], data + 4));
        whole.insert(whole.end(), sum, sum + 4);
        static constexpr std::uint8_t kEnd[] = {0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
        for (const std::uint8_t byte : kEnd) whole.push_back(static_cast<std::byte>(byte));
        return whole;
    }
    return {};
}

/// The file without the chunks before its pixels that say nothing of them, if they are so many, so large or so empty that the library
/// refuses them; nothing for others.
std::vector<std::byte> without_notes(std::span<const std::byte> file) {
    constexpr std::size_t kManyNotes = 256, kLargeNote = std::size_t{1} << 20;
    const auto is = [&](std::size_t at, const char* type) { return std::memcmp(&file[at + 4], type, 4) == 0; };
    if (file.size() < kPngSignature + kPngChunkFrame || !is(kPngSignature, "IHDR")) return {};
    std::vector<std::byte> out;
    std::size_t notes = 0, at = kPngSignature, copied = 0;
    bool refused = false;
    while (at + kPngChunkFrame <= file.size() && !is(at, "IDAT")) {
        const std::size_t size = png_number(&file[at]);
        if (size > file.size() - at - kPngChunkFrame) return {};
        constexpr std::byte kAncillary{0x20};
        if ((file[at + 4] & kAncillary) != std::byte{0} && !is(at, "tRNS")) {
            ++notes;
            refused |= size == 0 || size > kLargeNote;
            out.insert(out.end(), file.begin() + static_cast<std::ptrdiff_t>(copied), file.begin() + static_cast<std::ptrdiff_t>(at));
            copied = at + size + kPngChunkFrame;
        }
        at += size + kPngChunkFrame;
    }
    if (!refused && notes <= kManyNotes) return {};
    out.insert(out.end(), file.begin() + static_cast<std::ptrdiff_t>(copied), file.end());
    return out;
}

}  // namespace

Result<ImageHeader> read_png_header(std::span<const std::byte> file, const ImageLimits& limits) {
    const auto png = open_png(file, limits);
    if (!png) return tl::unexpected(png.error());
    return ImageHeader{ImageFormat::png, static_cast<int>(png->header.width), static_cast<int>(png->header.height),
                       png->header.bit_depth == 16 ? 16 : 8};
}

Result<bool> decode_png_rows(std::span<const std::byte> file, const ImageLimits& limits, bool keep_16_bits, RowSink& sink) {
    const std::vector<std::byte> plain = without_notes(file);
    if (!plain.empty()) file = plain;
    const std::vector<std::byte> whole = limits.keep_damaged ? with_end(file) : std::vector<std::byte>();
    if (!whole.empty()) file = whole;
    const auto png = open_for_pixels(file, limits);
    if (!png) return tl::unexpected(png.error());
    if (png->header.interlace_method != SPNG_INTERLACE_NONE) return false;
    if (auto added = add_rows(*png, file, keep_16_bits, sink); !added) return tl::unexpected(added.error());
    if (!whole.empty()) return fail(ErrorCode::bad_input, "PNG: the file is cut off");
    return true;
}

Result<DecodedImage> decode_png(std::span<const std::byte> file, const ImageLimits& limits, bool keep_16_bits) {
    const std::vector<std::byte> plain = without_notes(file);
    if (!plain.empty()) file = plain;
    const auto png = open_for_pixels(file, limits);
    if (!png) return tl::unexpected(png.error());
    const spng_ihdr& header = png->header;
    if (header.interlace_method != SPNG_INTERLACE_NONE) return decode_at_once(*png, keep_16_bits);
    WholePicture picture(static_cast<int>(header.width), static_cast<int>(header.height));
    const std::size_t values = picture.row() * header.height;
    if (header.bit_depth == 16 && keep_16_bits)
        picture.image.rgba16.reserve(values);
    else
        picture.image.rgba8.reserve(values);
    return add_rows(*png, file, keep_16_bits, picture).map([&] { return std::move(picture.image); });
}

}  // namespace halflit::io::detail
