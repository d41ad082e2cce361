// APNG: a PNG whose further frames are in chunks of their own, which other readers of PNG leave out. (PNG, third edition, 2023.)
#include "apps/engine/film/film_writer.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <new>
#include <numeric>
#include <string>
#include <utility>

namespace halflit::film {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put(Bytes& out, std::uint32_t value, int bytes) {
    const std::array<std::uint8_t, 4> big_endian{static_cast<std::uint8_t>(value >> 24), static_cast<std::uint8_t>(value >> 16),
                                                 static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value)};
    out.insert(out.end(), big_endian.end() - bytes, big_endian.end());
}

/// Length, type, data, and the checksum of type and data.
void put_chunk(Bytes& out, const char* type, std::initializer_list<std::pair<const std::uint8_t*, std::size_t>> parts) {
    std::size_t size = 0;
    for (const auto& part : parts) size += part.second;
    put(out, static_cast<std::uint32_t>(size), 4);
    const std::size_t begin = out.size();
    out.insert(out.end(), type, type + 4);
    for (const auto& [data, length] : parts) out.insert(out.end(), data, data + length);
    put(out, libdeflate_crc32(0, out.data() + begin, out.size() - begin), 4);
}

void put_chunk(Bytes& out, const char* type, const Bytes& data) { put_chunk(out, type, {{data.data(), data.size()}}); }

/// A fraction of 16-bit numbers if it is one, thousandths of a second otherwise.
std::pair<std::uint32_t, std::uint32_t> delay_of(const FrameTime& time, std::size_t frame) {
    constexpr std::int64_t kMost = 65535, kThousand = 1000;
    const std::int64_t common = std::gcd(time.numerator, time.denominator);
    std::int64_t top = time.numerator / common, bottom = time.denominator / common;
    if (top > kMost || bottom > kMost) top = std::min(rounded_time(time, frame, kThousand), kMost), bottom = kThousand;
    return {static_cast<std::uint32_t>(top), static_cast<std::uint32_t>(bottom)};
}

class ApngWriter final : public FilmWriter {
public:
    explicit ApngWriter(const FilmSettings& settings) : settings_(settings), compressor_(libdeflate_alloc_compressor(kLevel)) {
        if (!compressor_) throw std::bad_alloc();
        constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
        file_.assign(std::begin(kSignature), std::end(kSignature));
        Bytes data;
        put(data, static_cast<std::uint32_t>(settings.width), 4);
        put(data, static_cast<std::uint32_t>(settings.height), 4);
        data.insert(data.end(), {8, static_cast<std::uint8_t>(settings.opaque ? 2 : 6), 0, 0, 0});  // 8 bits, RGB or RGBA
        put_chunk(file_, "IHDR", data);
        data.clear();
        put(data, static_cast<std::uint32_t>(settings.frames), 4);
        put(data, 0, 4);  // plays for ever
        put_chunk(file_, "acTL", data);
    }

    Result<void> add(const Image& frame) override {
        try {
            const std::size_t size = compress(frame);
            Bytes control;
            put(control, sequence_++, 4);
            put(control, static_cast<std::uint32_t>(settings_.width), 4);
            put(control, static_cast<std::uint32_t>(settings_.height), 4);
            put(control, 0, 4), put(control, 0, 4);  // its place
            const auto [top, bottom] = delay_of(settings_.frame_time, added_);
            put(control, top, 2), put(control, bottom, 2);
            control.insert(control.end(), {0, 0});  // the next frame replaces all of it
            put_chunk(file_, "fcTL", control);
            if (added_ == 0) {
                put_chunk(file_, "IDAT", {{compressed_.data(), size}});
            } else {
                Bytes number;
                put(number, sequence_++, 4);
                put_chunk(file_, "fdAT", {{number.data(), number.size()}, {compressed_.data(), size}});
            }
            ++added_;
            return {};
        } catch (const std::bad_alloc&) {
            return fail(ErrorCode::limit, "out of memory while encoding a frame");
        }
    }

    Result<std::vector<std::uint8_t>> finish() override {
        put_chunk(file_, "IEND", Bytes{});
        return std::move(file_);
    }

private:
    static constexpr int kLevel = 6;
    struct Free {
        void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
    };

    /// Rows as differences to the pixel on the left (filter 1). Returns the number of bytes in compressed_.
    std::size_t compress(const Image& frame) {
        const auto width = static_cast<std::size_t>(settings_.width), height = static_cast<std::size_t>(settings_.height);
        const std::size_t channels = settings_.opaque ? 3 : 4;
        rows_.resize(height * (1 + width * channels));
        std::uint8_t* out = rows_.data();
        for (std::size_t y = 0; y < height; ++y) {
            const std::uint8_t* pixel = frame.rgba8.data() + y * width * 4;
            *out++ = 1;
            for (std::size_t c = 0; c < channels; ++c) *out++ = pixel[c];
            for (std::size_t x = 1; x < width; ++x) {
                pixel += 4;
                for (std::size_t c = 0; c < channels; ++c) *out++ = static_cast<std::uint8_t>(pixel[c] - pixel[c - 4]);
            }
        }
        compressed_.resize(libdeflate_zlib_compress_bound(compressor_.get(), rows_.size()));
        return libdeflate_zlib_compress(compressor_.get(), rows_.data(), rows_.size(), compressed_.data(), compressed_.size());
    }

    FilmSettings settings_;
    std::unique_ptr<libdeflate_compressor, Free> compressor_;
    Bytes file_, rows_, compressed_;
    std::uint32_t sequence_ = 0;
    std::size_t added_ = 0;
};

}  // namespace

std::unique_ptr<FilmWriter> make_apng_writer(const FilmSettings& settings) { return std::make_unique<ApngWriter>(settings); }

}  // namespace halflit::film
