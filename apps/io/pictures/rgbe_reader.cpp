#include "apps/io/pictures/rgbe_reader.hpp"

#include "apps/io/files/text.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <utility>

namespace halflit::io {
namespace {

constexpr std::size_t kMaxHeaderBytes = 65536;
constexpr double kLargest = static_cast<double>(kLargestLight);

tl::unexpected<Error> refuse(std::string message) { return fail(ErrorCode::bad_input, std::move(message)); }

struct Header {
    std::array<double, 3> divisor{1, 1, 1};  ///< EXPOSURE times COLORCORR
    bool columns = false;                    ///< scanlines are columns: "X" comes first in the resolution line
    bool x_reversed = false, y_upwards = false;
    int width = 0, height = 0;
    std::size_t end = 0;  ///< offset of the first pixel
};

/// Lines of the header. A line without a newline is an error, because the file ends within the header.
class Lines {
public:
    explicit Lines(std::span<const std::byte> file)
        : text_(reinterpret_cast<const char*>(file.data()), file.size() < kMaxHeaderBytes ? file.size() : kMaxHeaderBytes) {}

    Result<std::string_view> next() {
        const std::size_t end = text_.find('\n', at_);
        if (end == std::string_view::npos) {
            if (text_.size() == kMaxHeaderBytes) return refuse(fmt::format("the header is longer than {} bytes", kMaxHeaderBytes));
            return refuse(fmt::format("line {}: the file ends within the header", number_ + 1));
        }
        std::string_view line = text_.substr(at_, end - at_);
        at_ = end + 1;
        ++number_;
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }
    [[nodiscard]] std::size_t position() const { return at_; }
    [[nodiscard]] tl::unexpected<Error> error(std::string_view expected, std::string_view found) const {
        return refuse(fmt::format("line {}: expected {}, found \"{}\"", number_, expected, printable(found, 60)));
    }

private:
    std::string_view text_;
    std::size_t at_ = 0;
    int number_ = 0;
};

std::string_view trimmed(std::string_view text) {
    while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1);
    while (text.ends_with(' ') || text.ends_with('\t')) text.remove_suffix(1);
    return text;
}

/// Takes the first word off `text`.
std::string_view word(std::string_view& text) {
    text = trimmed(text);
    const std::size_t end = text.find_first_of(" \t");
    const std::string_view first = text.substr(0, end);
    text.remove_prefix(first.size());
    return first;
}

template <class T>
bool parse(std::string_view text, T& value) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

/// Reads factors that the pixels have been multiplied by; each must be usable as a divisor.
template <std::size_t N>
bool parse_factors(std::string_view text, std::array<double, N>& factors) {
    for (double& factor : factors)
        if (!parse(word(text), factor) || !(factor >= 1e-30 && factor <= 1e30)) return false;
    return trimmed(text).empty();
}

Result<void> read_variable(const Lines& lines, std::string_view line, Header& header) {
    const auto value_of = [&](std::string_view name) { return trimmed(line.substr(name.size())); };
    if (line.starts_with("FORMAT=") && value_of("FORMAT=") != "32-bit_rle_rgbe") return lines.error("FORMAT=32-bit_rle_rgbe", line);
    if (line.starts_with("EXPOSURE=")) {
        std::array<double, 1> exposure{};
        if (!parse_factors(value_of("EXPOSURE="), exposure)) return lines.error("EXPOSURE= and a positive number", line);
        for (double& divisor : header.divisor) divisor *= exposure[0];
    } else if (line.starts_with("COLORCORR=")) {
        std::array<double, 3> correction{};
        if (!parse_factors(value_of("COLORCORR="), correction)) return lines.error("COLORCORR= and three positive numbers", line);
        for (std::size_t i = 0; i < 3; ++i) header.divisor[i] *= correction[i];
    }
    return {};
}

/// Reads "-Y 512 +X 1024" or one of the seven other orders. The axis named first is the slow one.
Result<void> read_resolution(const Lines& lines, std::string_view line, Header& header) {
    std::string_view rest = line;
    std::array<std::string_view, 2> axis;
    std::array<int, 2> size{};
    bool good = true;
    for (std::size_t i = 0; i < 2; ++i) {
        axis[i] = word(rest);
        good = good && axis[i].size() == 2 && (axis[i][0] == '-' || axis[i][0] == '+') && parse(word(rest), size[i]) && size[i] > 0;
    }
    good = good && trimmed(rest).empty() && ((axis[0][1] == 'Y' && axis[1][1] == 'X') || (axis[0][1] == 'X' && axis[1][1] == 'Y'));
    if (!good) return lines.error("a resolution like \"-Y 512 +X 1024\"", line);
    header.columns = axis[0][1] == 'X';
    const std::size_t x = header.columns ? 0 : 1, y = 1 - x;
    header.width = size[x];
    header.height = size[y];
    header.x_reversed = axis[x][0] == '-';
    header.y_upwards = axis[y][0] == '+';
    return {};
}

Result<Header> read_header(std::span<const std::byte> file) {
    Lines lines(file);
    Header header;
    auto line = lines.next();
    if (!line || !(line->starts_with("#?RADIANCE") || line->starts_with("#?RGBE")))
        return refuse("expected a Radiance picture, which begins with #?RADIANCE or #?RGBE, or an EXR or PFM picture");
    for (line = lines.next(); line && !line->empty(); line = lines.next())
        if (const auto read = read_variable(lines, *line, header); !read) return tl::unexpected(read.error());
    if (!line) return tl::unexpected(line.error());
    line = lines.next();
    if (!line) return tl::unexpected(line.error());
    if (const auto read = read_resolution(lines, *line, header); !read) return tl::unexpected(read.error());
    for (const double divisor : header.divisor)
        if (!(divisor >= 1e-60 && divisor <= 1e60))
            return refuse("EXPOSURE and COLORCORR lines multiply to less than 1e-60 or more than 1e60");
    header.end = lines.position();
    return header;
}

using Rgbe = std::array<std::uint8_t, 4>;

/// Reads scanlines in order. Every function consumes at least one byte for each run or pixel, or fails.
class Scanlines {
public:
    explicit Scanlines(std::span<const std::byte> bytes) : bytes_(bytes) {}

    /// Reads a scanline; false, with `why` set, if the data ends or contradicts itself.
    bool read(std::span<Rgbe> line) {
        if (bytes_.size() < 4) return ends();
        const std::uint8_t b0 = byte(0), b1 = byte(1), b2 = byte(2), b3 = byte(3);
        // New run lengths begin with bytes that no normalised pixel of a flat picture has.
        const bool new_runs = line.size() >= 8 && line.size() <= 32767 && b0 == 2 && b1 == 2 && b2 < 128;
        if (!new_runs) return read_flat(line);
        if (static_cast<std::size_t>(b2) * 256 + b3 != line.size()) {
            why = fmt::format("expected a scanline of {} pixels, found one of {}", line.size(), b2 * 256 + b3);
            return false;
        }
        bytes_ = bytes_.subspan(4);
        for (std::size_t component = 0; component < 4; ++component)
            if (!read_component(line, component)) return false;
        return true;
    }

    std::string why;

private:
    [[nodiscard]] std::uint8_t byte(std::size_t i) const { return std::to_integer<std::uint8_t>(bytes_[i]); }
    bool ends() {
        why = "the file ends within the pixels";
        return false;
    }
    bool overruns() {
        why = "a run goes past the end of its scanline";
        return false;
    }

    /// New run lengths: count > 128 repeats the next byte count - 128 times, else count bytes follow.
    bool read_component(std::span<Rgbe> line, std::size_t component) {
        for (std::size_t x = 0; x < line.size();) {
            if (bytes_.size() < 2) return ends();
            const std::size_t code = byte(0), count = code > 128 ? code - 128 : code, used = code > 128 ? 1 : count;
            if (count == 0) {
                why = "a run of no pixels";
                return false;
            }
            if (count > line.size() - x) return overruns();
            if (bytes_.size() < 1 + used) return ends();
            for (std::size_t i = 0; i < count; ++i) line[x + i][component] = byte(code > 128 ? 1 : 1 + i);
            x += count;
            bytes_ = bytes_.subspan(1 + used);
        }
        return true;
    }

    /// Flat pixels and old run lengths: (1, 1, 1, n) repeats the pixel before n times. Of several in a row, each counts 256 times as much
    /// as the one before.
    bool read_flat(std::span<Rgbe> line) {
        int shift = 0;
        for (std::size_t x = 0; x < line.size();) {
            if (bytes_.size() < 4) return ends();
            const Rgbe pixel{byte(0), byte(1), byte(2), byte(3)};
            bytes_ = bytes_.subspan(4);
            if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
                line[x++] = pixel;
                shift = 0;
                continue;
            }
            if (x == 0) {
                why = "a run with no pixel before it";
                return false;
            }
            if (shift > 16) return overruns();
            const std::size_t count = static_cast<std::size_t>(pixel[3]) << shift;
            if (count > line.size() - x) return overruns();
            for (std::size_t i = 0; i < count; ++i) line[x + i] = line[x - 1];
            x += count;
            shift += 8;
        }
        return true;
    }

    std::span<const std::byte> bytes_;
};

/// Scale of a mantissa by channel and exponent e: 2^(e - 136) / divisor.
std::array<std::array<double, 256>, 3> make_scales(const Header& header) {
    std::array<std::array<double, 256>, 3> scales{};
    for (std::size_t i = 0; i < 3; ++i) {
        double power = 0x1p-135;
        for (std::size_t e = 1; e < 256; ++e, power *= 2.0) scales[i][e] = power / header.divisor[i];
    }
    return scales;
}

/// The picture as it is read: rows from the top, whatever the file's order. Its memory is taken once an eighth of the file's lines is
/// there, so that a short file cannot take much.
class Rows {
public:
    explicit Rows(const Header& header)
        : header_(header), width_(static_cast<std::size_t>(header.width)), height_(static_cast<std::size_t>(header.height)) {}

    /// Adds the next line of the file, three floats per pixel.
    void add(std::span<const float> line) {
        const std::size_t lines = header_.columns ? width_ : height_;
        if (!whole_ && ++held_ > lines / 8) take_memory(line.size());
        if (whole_)
            place(line);
        else
            first_.insert(first_.end(), line.begin(), line.end());
    }
    [[nodiscard]] std::vector<float> take() && {
        if (!whole_) take_memory(first_.size());
        return std::move(rgb_);
    }

private:
    void take_memory(std::size_t line) {
        whole_ = true;
        if (usual_)
            rgb_.reserve(3 * width_ * height_);
        else
            rgb_.resize(3 * width_ * height_);
        for (std::size_t at = 0; at < first_.size(); at += line) place(std::span(first_).subspan(at, line));
        first_ = {};
    }
    void place(std::span<const float> line) {
        if (usual_) {
            rgb_.insert(rgb_.end(), line.begin(), line.end());
            return;
        }
        const std::size_t slow = placed_++;
        for (std::size_t fast = 0; 3 * fast < line.size(); ++fast) {
            const std::size_t column = header_.columns ? slow : fast, row = header_.columns ? fast : slow;
            const std::size_t x = header_.x_reversed ? width_ - 1 - column : column, y = header_.y_upwards ? height_ - 1 - row : row;
            std::copy_n(line.begin() + static_cast<std::ptrdiff_t>(3 * fast), 3,
                        rgb_.begin() + static_cast<std::ptrdiff_t>(3 * (y * width_ + x)));
        }
    }

    const Header& header_;
    std::size_t width_, height_, held_ = 0, placed_ = 0;
    bool usual_ = !header_.columns && !header_.x_reversed && !header_.y_upwards, whole_ = false;
    std::vector<float> first_, rgb_;
};

}  // namespace

Result<RgbeImage> decode_rgbe(std::span<const std::byte> file, const RgbeLimits& limits) {
    const auto header = read_header(file);
    if (!header) return tl::unexpected(header.error());
    if (auto ok = check_float_image_size(header->width, header->height, limits); !ok) return tl::unexpected(ok.error());
    const auto scales = make_scales(*header);
    const int lines = header->columns ? header->width : header->height;
    std::vector<Rgbe> line(static_cast<std::size_t>(header->columns ? header->height : header->width));
    Scanlines scanlines(file.subspan(header->end));
    std::vector<float> light(3 * line.size());
    Rows rows(*header);
    for (int i = 0; i < lines; ++i) {
        check_time();
        if (!scanlines.read(line)) return refuse(fmt::format("scanline {} of {}: {}", i, lines, scanlines.why));
        for (std::size_t x = 0; x < line.size(); ++x)
            for (std::size_t k = 0; k < 3; ++k) {
                const double value = line[x][k] * scales[k][line[x][3]];
                light[3 * x + k] = static_cast<float>(value < kLargest ? value : kLargest);
            }
        rows.add(light);
    }
    return RgbeImage{header->width, header->height, std::move(rows).take()};
}

}  // namespace halflit::io
