#pragma once
// Numbers of a PLY file's body: words of text, or binary of either byte order.
#include "apps/io/files/load_failure.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/ply_header.hpp"
#include "apps/io/models/text_scanner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// Values of the body, one after another.
class PlyValues {
public:
    PlyValues(const PlyHeader& header, Document& document)
        : strict_(document.options.strict),
          format_(header.format),
          words_(header.body, document, "", false, header.lines + 1),
          binary_(header.body) {
        words_.expect_next("another element");
    }

    /// Rows of a text, each a line, count before the header: a row that has the form of a later element alone ends an element before its
    /// number of rows, and those that have its own form alone go on behind it. Nothing where a line has another form, or none is too many
    /// or too few.
    void mend_counts(std::vector<PlyElement>& elements, Document& document) {
        if (format_ != PlyFormat::ascii || lines_are(elements)) return;
        const TextScanner::Mark begin = words_.mark();
        std::vector<std::uint64_t> found;
        TimeCheck check;
        for (auto element = elements.begin(); element != elements.end(); ++element) {
            std::uint64_t rows = 0;
            const auto is_later = [&] { return std::any_of(element + 1, elements.end(), [&](const PlyElement& e) { return fits(e); }); };
            for (; go_to_row() && fits(*element) && (rows < element->count || !is_later()); ++rows, words_.skip_line()) check();
            const bool has_row = go_to_row();
            if (has_row && !is_later()) break;
            found.push_back(has_row ? rows : std::max(rows, element->count));  // of a file that was cut off
        }
        words_.go_back(begin);
        if (found.size() < elements.size()) return;
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i] == elements[i].count) continue;
            document.go_on_without({{ErrorCode::bad_input, fmt::format("the header says {} elements \"{}\", but there are {}",
                                                                       elements[i].count, printable(elements[i].name, 40), found[i])}},
                                   "these are read");
            elements[i].count = found[i];
        }
    }

    void begin_row() { taken_ = 0; }
    /// Passes over what the line has beyond the row of a text, if that is less than another row.
    void end_row() {
        if (strict_ || format_ != PlyFormat::ascii) return;
        const std::size_t more = words_.words_in_line(taken_);
        if (more == 0 || more >= taken_) return;
        words_.pass_long_row();
    }

    /// Where the next value begins; null for texts, whose lines are counted again for a message.
    [[nodiscard]] const char* place() const { return format_ != PlyFormat::ascii ? binary_.data() : nullptr; }
    double next(PlyType type) {
        if (format_ != PlyFormat::ascii) return next_binary(type);
        find_word();
        return words_.number();
    }
    /// The next value, which is not used and need not be a number.
    void skip(PlyType type) {
        if (format_ != PlyFormat::ascii) return void(next_binary(type));
        find_word();
        words_.word();
    }

    /// The length of a list, whose entries must be there.
    std::size_t next_length(const PlyProperty& list) {
        const double length = next(list.count_type);
        const bool is_text = format_ == PlyFormat::ascii;
        if (!(length >= 0)) refuse(where(), fmt::format("a list's length is {}", length));
        if (length > static_cast<double>((is_text ? words_.left().size() : binary_.size() / size_of(list.type)) + 1)) end();
        return static_cast<std::size_t>(length);
    }
    /// The number of elements, or as many as the file can hold at most; if strict, refuses a file that cannot hold them.
    [[nodiscard]] std::uint64_t held(const PlyElement& element) const {
        const bool is_text = format_ == PlyFormat::ascii;
        std::size_t least = 0;  // bytes
        for (const PlyProperty& p : element.properties) least += is_text ? 1 : size_of(p.is_list ? p.count_type : p.type);
        const std::size_t left = is_text ? words_.left().size() : binary_.size();
        if (least == 0 || element.count <= left / least) return element.count;
        if (strict_)
            refuse("",
                   fmt::format("{} elements \"{}\" do not fit into the file: it was cut off", element.count, printable(element.name, 40)));
        return left / least + 1;  // the last of which ends with CutOff
    }
    /// Something follows the last value, besides white space and comments.
    [[nodiscard]] bool has_more() {
        if (format_ != PlyFormat::ascii)
            return std::any_of(binary_.begin(), binary_.end(), [](char c) { return !is_blank(c) && !is_line_end(c); });
        try {
            find_word();
        } catch (const CutOff&) {
            return false;
        } catch (const LoadFailure&) {
            return false;
        }
        return true;
    }
    [[nodiscard]] std::string where() const { return format_ == PlyFormat::ascii ? words_.where() : ""; }
    /// Warns of words that are no numbers, and of long rows.
    void warn() { words_.warn(); }

private:
    /// Goes to the next word that is not of a comment, which some programs write into the body.
    void find_word() {
        if (!go_to_row()) end();
        ++taken_;
    }
    /// The same. False at the end of the text.
    bool go_to_row() {
        for (;; words_.skip_line()) {
            if (!words_.go_to_word()) return false;
            if (!words_.is_at_line_begin() || lower(words_.left()[0]) < 'a') return true;
            const std::string_view word = words_.next_in_line();
            if (!same_word(word, "comment") && !same_word(word, "obj_info")) return true;
        }
    }
    /// True if a text has as many lines, blank ones aside, as the elements have rows.
    [[nodiscard]] bool lines_are(const std::vector<PlyElement>& elements) const {
        std::uint64_t lines = 0, rows = 0;
        for (const PlyElement& element : elements) rows += element.properties.empty() ? 0 : element.count;
        TimeCheck check;
        for (std::string_view left = words_.left(); !left.empty(); check()) {
            if (!is_line_end(left[0])) ++lines;
            left.remove_prefix(std::min(left.find('\n'), left.size() - 1) + 1);
        }
        return lines == rows;
    }
    /// True if the line that comes next has the words of one of the element's rows.
    [[nodiscard]] bool fits(const PlyElement& element) {
        const TextScanner::Mark begin = words_.mark();
        const auto pass = [&](std::uint64_t values) {
            while (values > 0 && parse_loosely(words_.word_in_line())) --values;
            return values == 0;
        };
        bool is_fit = !element.properties.empty();
        for (const PlyProperty& p : element.properties) {
            const auto length = p.is_list && is_fit ? TextScanner::parse_count(words_.word_in_line()) : std::optional<std::uint64_t>(1);
            is_fit = is_fit && length && pass(*length);
        }
        is_fit = is_fit && words_.next_in_line().empty();
        words_.go_back(begin);
        return is_fit;
    }

    [[noreturn]] void end() const {
        if (format_ == PlyFormat::ascii) words_.end();
        if (strict_) refuse("", "the file ends before its last element: it was cut off");
        throw CutOff{};
    }

    template <class T>
    T take_bytes() {
        if (binary_.size() < sizeof(T)) end();
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), binary_.data(), sizeof(T));
        binary_.remove_prefix(sizeof(T));
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
            case PlyType::i64:
                return static_cast<double>(take_bytes<std::int64_t>());
            case PlyType::u64:
                return static_cast<double>(take_bytes<std::uint64_t>());
            case PlyType::f32:
                return take_bytes<float>();
            case PlyType::f64:
                return take_bytes<double>();
        }
        return 0;
    }

    bool strict_;
    PlyFormat format_;
    std::size_t taken_ = 0;
    TextScanner words_;
    std::string_view binary_;
};

}  // namespace halflit::io::detail
