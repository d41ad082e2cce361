// The part of .exr files that calls OpenEXR. What it uses of halflit is in headers, so that it can lie in a module.
#include "apps/io/codecs/codec_libraries.hpp"

#include <fmt/format.h>

#if HALFLIT_HAS_OPENEXR
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>

#include <array>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

namespace halflit::io::detail {

namespace {

/// A file in memory, as the library reads it.
class Reading : public Imf::IStream {
public:
    explicit Reading(std::span<const std::byte> file) : IStream("the file"), file_(file) {}
    bool read(char to[], int count) override {
        if (count < 0 || static_cast<std::size_t>(count) > file_.size() - at_) throw std::runtime_error("the file ends within the pixels");
        if (count > 0) std::memcpy(to, file_.data() + at_, static_cast<std::size_t>(count));
        at_ += static_cast<std::size_t>(count);
        return at_ < file_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override {
        if (position > file_.size()) throw std::runtime_error("the file ends within the pixels");
        at_ = static_cast<std::size_t>(position);
    }

private:
    std::span<const std::byte> file_;
    std::size_t at_ = 0;
};

/// A file in memory, as the library writes it.
class Writing : public Imf::OStream {
public:
    Writing() : OStream("the file") {}
    void write(const char from[], int count) override {
        const std::size_t end = at_ + static_cast<std::size_t>(count);
        if (bytes.size() < end) bytes.resize(end);
        std::memcpy(bytes.data() + at_, from, static_cast<std::size_t>(count));
        at_ = end;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }

    std::vector<std::uint8_t> bytes;

private:
    std::size_t at_ = 0;
};

/// Names of the red, green and blue channel; all the same for grey.
Result<std::array<std::string, 3>> colour_channels(const Imf::ChannelList& list) {
    const bool rgb = list.findChannel("R") != nullptr && list.findChannel("G") != nullptr && list.findChannel("B") != nullptr;
    auto second = list.begin();
    if (second != list.end()) ++second;
    const bool grey = !rgb && list.begin() != list.end() && second == list.end();
    std::array<std::string, 3> names{"R", "G", "B"};
    if (grey) names.fill(list.begin().name());
    if (!rgb && !grey) {
        std::string found;
        for (auto channel = list.begin(); channel != list.end() && found.size() < 60; ++channel)
            found += std::string(found.empty() ? "" : " ") + channel.name();
        return fail(ErrorCode::bad_input, fmt::format("expected the channels R G B, or one alone, found {}", found.substr(0, 80)));
    }
    for (const std::string& name : names)
        if (const Imf::Channel& channel = *list.findChannel(name); channel.xSampling != 1 || channel.ySampling != 1)
            return fail(ErrorCode::bad_input, fmt::format("channel {}: expected a value for each pixel", name));
    return names;
}

Result<ExrPixels> read_pixels(Imf::InputFile& file, int width, int height, void (*check_time)()) {
    const Imf::ChannelList& list = file.header().channels();
    const auto names = colour_channels(list);
    if (!names) return tl::unexpected(names.error());
    const auto window = file.header().dataWindow();
    const auto columns = static_cast<std::size_t>(width);
    const bool grey = (*names)[0] == (*names)[1];
    std::vector<float> row(3 * columns);
    // The library adds (x, y) of the window to the base; y has no part in it, so that each row lies in `row`.
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < (grey ? 1u : 3u); ++c) {
        const auto base = reinterpret_cast<std::uintptr_t>(row.data() + c) - static_cast<std::uintptr_t>(std::int64_t{window.min.x} * 12);
        frame.insert((*names)[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(base), 12, 0));
    }
    file.setFrameBuffer(frame);
    ExrPixels pixels;  // grow with what has been read
    for (std::size_t c = 0; c < 3; ++c) pixels.is_half[c] = list.findChannel((*names)[c])->type == Imf::HALF;
    for (int y = window.min.y; y <= window.max.y; ++y) {
        check_time();
        if (y - window.min.y == height / 8) pixels.rgb.reserve(3 * columns * static_cast<std::size_t>(height));
        file.readPixels(y, y);
        for (std::size_t i = 0; i < row.size(); ++i) pixels.rgb.push_back(row[grey ? i - i % 3 : i]);
    }
    return pixels;
}

}  // namespace

Result<ExrPixels> decode_exr_pixels(std::span<const std::byte> file, int width, int height, void (*check_time)()) {
    try {
        Reading stream(file);
        Imf::InputFile input(stream, 0);
        const auto window = input.header().dataWindow();
        if (1LL + window.max.x - window.min.x != width || 1LL + window.max.y - window.min.y != height)
            return fail(ErrorCode::bad_input, "header: two data windows");
        return read_pixels(input, width, height, check_time);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        return fail(ErrorCode::bad_input, error.what());
    }
}

Result<std::vector<std::uint8_t>> encode_exr_pixels(int width, int height, std::span<const ExrChannel> channels) {
    try {
        Imf::Header header(width, height);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer frame;
        for (const ExrChannel& channel : channels) {
            header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
            const std::size_t step = sizeof(float) * static_cast<std::size_t>(channel.step);
            // The library takes memory to read from as char*, and does not write to it.
            auto* const base = reinterpret_cast<char*>(const_cast<float*>(channel.data));
            frame.insert(channel.name, Imf::Slice(Imf::FLOAT, base, step, step * static_cast<std::size_t>(width)));
        }
        Writing stream;
        {
            Imf::OutputFile output(stream, header, 0);
            output.setFrameBuffer(frame);
            output.writePixels(height);
        }  // the table of offsets is written at the end
        return std::move(stream.bytes);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        return fail(ErrorCode::internal, fmt::format("EXR: {}", error.what()));
    }
}

}  // namespace halflit::io::detail

#endif
