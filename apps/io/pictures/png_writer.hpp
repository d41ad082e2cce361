// PNG files: their chunks, and pixels as they are packed in them. (PNG, third edition, 2023.)
#pragma once

#include "halflit/error.hpp"

#include <libdeflate.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

namespace halflit::io {

enum class PngColor : std::uint8_t { grey16, rgb8, rgba8 };

/// Appends the lowest `bytes` bytes of a number, the highest of them first.
void put_big_endian(std::vector<std::uint8_t>& file, std::uint32_t value, int bytes);
/// Appends a chunk: length, type, data, and the checksum of type and data.
void put_chunk(std::vector<std::uint8_t>& file, const char* type, std::initializer_list<std::span<const std::uint8_t>> parts);
/// Signature and header.
void begin_png(std::vector<std::uint8_t>& file, int width, int height, PngColor color);

/// Packs pictures, one after the other in the same memory.
class PngPacker {
public:
    /// level: libdeflate's, 1 to 12. Throws std::bad_alloc, as pack() does.
    explicit PngPacker(int level);

    /// The zlib stream of a picture, which stays until the next call. rgba8: four bytes a pixel, the top row first; rgb8 leaves out alpha.
    [[nodiscard]] std::span<const std::uint8_t> pack(int width, int height, PngColor color, const std::uint8_t* rgba8);
    /// The same of grey16.
    [[nodiscard]] std::span<const std::uint8_t> pack(int width, int height, const std::uint16_t* values);

private:
    template <class Fill>
    std::span<const std::uint8_t> pack_rows(int width, int height, std::size_t bytes_a_pixel, const Fill& fill);

    struct Free {
        void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
    };
    std::unique_ptr<libdeflate_compressor, Free> compressor_;
    struct Buffer {
        std::unique_ptr<std::uint8_t[]> bytes;
        std::size_t size = 0;
        std::uint8_t* hold(std::size_t count);
    };
    Buffer plain_, rows_, packed_;
};

/// The file of a picture, four bytes a pixel, without alpha if it is opaque: three quarters of the time, and 7/8 of the size. Throws
/// std::bad_alloc, here and below.
[[nodiscard]] std::vector<std::uint8_t> encode_png(int width, int height, std::span<const std::uint8_t> rgba8);
/// The file of whole numbers, the top row first: one channel of 16 bits, without a colour space.
[[nodiscard]] std::vector<std::uint8_t> encode_grey16(int width, int height, std::span<const std::uint16_t> values);

}  // namespace halflit::io
