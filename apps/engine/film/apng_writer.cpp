// APNG: a PNG whose further frames are in chunks of their own, which other readers of PNG leave out. (PNG, third edition, 2023.)
#include "apps/engine/film/film_writer.hpp"
#include "apps/io/pictures/png_writer.hpp"

#include <algorithm>
#include <new>
#include <numeric>
#include <string>
#include <utility>

namespace halflit::film {
namespace {

using Bytes = std::vector<std::uint8_t>;
using io::put_big_endian;

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
    explicit ApngWriter(const FilmSettings& settings)
        : settings_(settings), color_(settings.opaque ? io::PngColor::rgb8 : io::PngColor::rgba8) {
        io::begin_png(file_, settings.width, settings.height, color_);
        Bytes data;
        put_big_endian(data, static_cast<std::uint32_t>(settings.frames), 4);
        put_big_endian(data, 0, 4);  // plays for ever
        io::put_chunk(file_, "acTL", {data});
    }

    Result<void> add(const Image& frame) override {
        try {
            const auto packed = packer_.pack(settings_.width, settings_.height, color_, frame.rgba8.data());
            Bytes control;
            put_big_endian(control, sequence_++, 4);
            put_big_endian(control, static_cast<std::uint32_t>(settings_.width), 4);
            put_big_endian(control, static_cast<std::uint32_t>(settings_.height), 4);
            put_big_endian(control, 0, 4), put_big_endian(control, 0, 4);  // its place
            const auto [top, bottom] = delay_of(settings_.frame_time, added_);
            put_big_endian(control, top, 2), put_big_endian(control, bottom, 2);
            control.insert(control.end(), {0, 0});  // the next frame replaces all of it
            io::put_chunk(file_, "fcTL", {control});
            if (added_ == 0) {
                io::put_chunk(file_, "IDAT", {packed});
            } else {
                Bytes number;
                put_big_endian(number, sequence_++, 4);
                io::put_chunk(file_, "fdAT", {number, packed});
            }
            ++added_;
            return {};
        } catch (const std::bad_alloc&) {
            return fail(ErrorCode::limit, "out of memory while encoding a frame");
        }
    }

    Result<std::vector<std::uint8_t>> finish() override {
        io::put_chunk(file_, "IEND", {});
        return std::move(file_);
    }

private:
    static constexpr int kLevel = 6;
    FilmSettings settings_;
    io::PngColor color_;
    io::PngPacker packer_{kLevel};
    Bytes file_;
    std::uint32_t sequence_ = 0;
    std::size_t added_ = 0;
};

}  // namespace

std::unique_ptr<FilmWriter> make_apng_writer(const FilmSettings& settings) { return std::make_unique<ApngWriter>(settings); }

}  // namespace halflit::film
