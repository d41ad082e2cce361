#pragma once
// Numbers of a PLY file's body: words of text, or binary of either byte order.
#include "apps/io/files/load_failure.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/models/ply_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace halflit::io::detail {

/// Thrown at the end of a file that was cut off, unless strict: what came before is drawn.
struct PlyCutOff {};

/// Values of the body, one after another.
class PlyValues {
public:
    PlyValues(const PlyHeader& header, bool strict)
        : strict_(strict),
          format_(header.format),
          text_({reinterpret_cast<const char*>(header.body.data()), header.body.size()}),
          line_(header.lines) {}

    void begin_row() { words_ = 0; }
    /// Passes over what the line has beyond the row of a text, if that is less than another row.
    void end_row() {
        if (strict_ || format_ != PlyFormat::ascii) return;
        std::size_t at = 0, more = 0;
        for (bool in_word = false; at < text_.size() && !is_line_end(text_[at]); ++at) {
            if (!is_blank(text_[at]) && !in_word) ++more;
            in_word = !is_blank(text_[at]);
            if (more >= words_) return;
        }
        if (more == 0) return;
        text_.remove_prefix(at);
        ++long_rows_;
    }
    [[nodiscard]] std::size_t long_rows() const { return long_rows_; }

    double next(PlyType type) { return format_ == PlyFormat::ascii ? next_word() : next_binary(type); }

    /// The length of a list, whose entries must be there.
    std::size_t next_length(const PlyProperty& list) {
        const double length = next(list.count_type);
        const std::size_t least = format_ == PlyFormat::ascii ? 1 : size_of(list.type);
        if (!(length >= 0)) refuse(where(), fmt::format("a list's length is {}", length));
        if (length > static_cast<double>(text_.size() / least + 1)) refuse_end();
        return static_cast<std::size_t>(length);
    }
    /// The number of elements, or as many as the file can hold at most; if strict, refuses a file that cannot hold them.
    [[nodiscard]] std::uint64_t held(const PlyElement& element) const {
        std::size_t least = 0;  // bytes
        for (const PlyProperty& p : element.properties)
            least += format_ == PlyFormat::ascii ? 1 : size_of(p.is_list ? p.count_type : p.type);
        if (least == 0 || element.count <= text_.size() / least) return element.count;
        if (strict_)
            refuse("",
                   fmt::format("{} elements \"{}\" do not fit into the file: it was cut off", element.count, printable(element.name, 40)));
        return text_.size() / least + 1;  // the last of which ends with PlyCutOff
    }
    /// Something follows the last value, besides ends of lines.
    [[nodiscard]] bool has_more() const {
        const auto counts = [](char c) { return !is_blank(c) && !is_line_end(c); };
        return std::any_of(text_.begin(), text_.end(), counts);
    }
    [[nodiscard]] std::string where() const { return format_ == PlyFormat::ascii ? fmt::format("line {}", line_ + 1) : ""; }

private:
    [[noreturn]] void refuse_end() const {
        if (!strict_) throw PlyCutOff{};
        refuse(where(), "the file ends before its last element: it was cut off");
    }

    double next_word() {
        ++words_;
        while (!text_.empty() && (is_blank(text_.front()) || is_line_end(text_.front()))) {
            if (text_.front() == '\n') ++line_;
            text_.remove_prefix(1);
        }
        std::size_t length = 0;
        while (length < text_.size() && !is_blank(text_[length]) && !is_line_end(text_[length])) ++length;
        if (length == 0) refuse_end();
        const std::string_view word = text_.substr(0, length);
        text_.remove_prefix(length);
        const std::optional<double> value =
            strict_ ? parse_real<double>(word) : parse_loosely(word);  // also of floats: surveys write more digits than those hold
        if (!value) refuse(where(), fmt::format("expected a number, found \"{}\"", printable(word, 40)));
        return *value;
    }

    template <class T>
    T take_bytes() {
        if (text_.size() < sizeof(T)) refuse_end();
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), text_.data(), sizeof(T));
        text_.remove_prefix(sizeof(T));
        if ((format_ == PlyFormat::big_endian) != (std::endian::native == std::endian::big)) std::reverse(bytes.begin(), bytes.end());
        return std::bit_cast<T>(bytes);
    }
    double next_binary(PlyType type) {
        switch (type) {
            case PlyType::i8:
                return take_bytes<std::int8_t>();
            case PlyType::u8:
                return take_bytes<std::uint8_t>();
            case PlyType::i16:
                return take_bytes<std::int16_t>();
            case PlyType::u16:
                return take_bytes<std::uint16_t>();
            case PlyType::i32:
                return take_bytes<std::int32_t>();
            case PlyType::u32:
                return take_bytes<std::uint32_t>();
            case PlyType::f32:
                return take_bytes<float>();
            case PlyType::f64:
                return take_bytes<double>();
        }
        return 0;
    }

    bool strict_;
    PlyFormat format_;
    std::size_t words_ = 0, long_rows_ = 0;
    std::string_view text_;
    std::size_t line_;
};

}  // namespace halflit::io::detail
