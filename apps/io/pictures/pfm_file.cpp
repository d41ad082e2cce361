#include "apps/io/pictures/pfm_file.hpp"

#include "apps/io/files/text.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstring>
#include <string_view>

namespace halflit::io {
namespace {

constexpr std::size_t kMaxPfmHeaderBytes = 256;

struct PfmHeader {
    int channels = 3;
    int width = 0, height = 0;
    float factor = 1.0f;
    bool little_endian = true;
    std::size_t end = 0;  ///< offset of the first value
};

bool is_pfm_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Words of the header, each with the space behind it. Empty where the header ends too early.
class PfmWords {
public:
    explicit PfmWords(std::span<const std::byte> file)
        : text_(reinterpret_cast<const char*>(file.data()), file.size() < kMaxPfmHeaderBytes ? file.size() : kMaxPfmHeaderBytes) {}
    std::string_view next() {
        while (at_ < text_.size() && is_pfm_space(text_[at_])) ++at_;
        const std::size_t begin = at_;
        while (at_ < text_.size() && !is_pfm_space(text_[at_])) ++at_;
        if (at_ == text_.size()) return {};
        return text_.substr(begin, at_ - begin);
    }
    /// Offset behind the one space that follows the last word.
    [[nodiscard]] std::size_t end() const { return at_ + 1; }

private:
    std::string_view text_;
    std::size_t at_ = 0;
};

template <class T>
bool parse_word(std::string_view text, T& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

Result<PfmHeader> read_pfm_header(std::span<const std::byte> file) {
    PfmWords words(file);
    PfmHeader header;
    header.channels = words.next() == "Pf" ? 1 : 3;
    for (int* const side : {&header.width, &header.height}) {
        const std::string_view word = words.next();
        if (word.empty()) return fail(ErrorCode::bad_input, "the file ends within the header");
        if (!parse_word(word, *side) || *side < 1)
            return fail(ErrorCode::bad_input, fmt::format("header: expected width and height, found \"{}\"", printable(word, 40)));
    }
    const std::string_view word = words.next();
    if (word.empty()) return fail(ErrorCode::bad_input, "the file ends within the header");
    float scale = 0.0f;
    if (!parse_word(word, scale) || !((scale >= 1e-30f && scale <= 1e30f) || (scale <= -1e-30f && scale >= -1e30f)))
        return fail(ErrorCode::bad_input,
                    fmt::format("header: expected a factor, negative for little-endian floats, found \"{}\"", printable(word, 40)));
    header.little_endian = scale < 0.0f;
    header.factor = scale < 0.0f ? -scale : scale;
    header.end = words.end();
    return header;
}

float value_at(const std::byte* bytes, bool little_endian) {
    std::uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits |= std::to_integer<std::uint32_t>(bytes[little_endian ? i : 3 - i]) << (8 * i);
    return std::bit_cast<float>(bits);
}

}  // namespace

bool is_pfm(std::span<const std::byte> file) {
    return file.size() >= 3 && file[0] == std::byte{'P'} && (file[1] == std::byte{'F'} || file[1] == std::byte{'f'}) &&
           is_pfm_space(std::to_integer<char>(file[2]));
}

Result<FloatImage> decode_pfm(std::span<const std::byte> file, const FloatImageLimits& limits) {
    const auto header = read_pfm_header(file);
    if (!header) return tl::unexpected(header.error());
    if (auto ok = check_float_image_size(header->width, header->height, limits); !ok) return tl::unexpected(ok.error());
    const auto width = static_cast<std::size_t>(header->width), height = static_cast<std::size_t>(header->height);
    const auto channels = static_cast<std::size_t>(header->channels);
    const std::size_t expected = 4 * width * height * channels, found = file.size() - header->end;
    if (found != expected)
        return fail(ErrorCode::bad_input,
                    fmt::format("expected {} bytes of {}x{} pixels, found {}", expected, header->width, header->height, found));
    FloatImage image{header->width, header->height, {}};
    image.rgb.reserve(3 * width * height);
    for (std::size_t y = 0; y < height; ++y) {
        check_time();
        const std::byte* row = file.data() + header->end + 4 * channels * width * (height - 1 - y);
        for (std::size_t i = 0; i < width * 3; ++i)
            image.rgb.push_back(light_of(value_at(row + 4 * (channels == 3 ? i : i / 3), header->little_endian) * header->factor));
    }
    if (auto ok = check_numbers(image); !ok) return tl::unexpected(ok.error());
    return image;
}

std::vector<std::uint8_t> encode_pfm(int width, int height, int channels, std::span<const float> values) {
    const std::string head = fmt::format("{}\n{} {}\n-1.0\n", channels == 1 ? "Pf" : "PF", width, height);
    const std::size_t row = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    std::vector<std::uint8_t> file(head.begin(), head.end());
    file.reserve(head.size() + 4 * values.size());
    for (int y = height - 1; y >= 0; --y)
        for (const float value : values.subspan(row * static_cast<std::size_t>(y), row)) {
            const auto bits = std::bit_cast<std::uint32_t>(value);
            for (int i = 0; i < 4; ++i) file.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
        }
    return file;
}

}  // namespace halflit::io
