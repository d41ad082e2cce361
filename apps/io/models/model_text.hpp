// Text of models: lines, words and numbers, without the C locale. Numbers are rounded by std::from_chars, so they have the same bits
// everywhere.
#pragma once

#include "apps/io/files/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

namespace halflit::io::detail {

/// A file's bytes as text, without a byte order mark.
[[nodiscard]] inline std::string_view as_text(std::span<const std::byte> bytes) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

/// True if at most one byte in 64 of the first kilobyte, zeros at the file's end left out, is a control character that is neither white
/// space nor DOS's end of file: a damaged name has one, numbers of binary files have one in ten.
[[nodiscard]] inline bool begins_as_text(std::span<const std::byte> bytes) {
    std::string_view begin = as_text(bytes.first(std::min<std::size_t>(bytes.size(), 1024)));
    while (!begin.empty() && begin.back() == 0) begin.remove_suffix(1);
    const auto controls = std::count_if(begin.begin(), begin.end(), [](char c) {
        const auto code = static_cast<unsigned char>(c);
        return !(code >= ' ' || (code >= '\t' && code <= '\r') || code == 0x1A);
    });
    return static_cast<std::size_t>(controls) * 64 <= begin.size();
}

/// White space of any kind, and control characters.
[[nodiscard]] constexpr bool is_space(char c) { return static_cast<unsigned char>(c) <= ' '; }
[[nodiscard]] constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
[[nodiscard]] constexpr bool is_line_end(char c) { return c == '\n' || c == '\r'; }

/// The power of ten of the first digit of a decimal number other than 0, within a few millions.
[[nodiscard]] inline long long exponent_of(std::string_view word) {
    const std::size_t e = std::min(word.find_first_of("eE"), word.size()), first = std::min(word.find_first_of("123456789"), e);
    const std::size_t point = std::min(word.find('.'), e);
    long long exponent = 0;
    for (std::size_t i = e + 1; i < word.size() && exponent < 1'000'000'000; ++i)
        if (word[i] >= '0' && word[i] <= '9') exponent = 10 * exponent + (word[i] - '0');
    if (e + 1 < word.size() && word[e + 1] == '-') exponent = -exponent;
    return exponent + (point > first ? static_cast<long long>(point - first) - 1 : -static_cast<long long>(first - point));
}

/// The whole word as a number: decimal, with an optional sign and exponent, or inf and nan. Too small a number is 0, too large a one is
/// infinite.
template <class T>
[[nodiscard]] std::optional<T> parse_real(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || word.empty()) return std::nullopt;
    if (error == std::errc()) return value;
    if (error != std::errc::result_out_of_range) return std::nullopt;
    const T sign = word[0] == '-' ? T{-1} : T{1};
    return sign * (exponent_of(word) < 0 ? T{0} : std::numeric_limits<T>::infinity());
}

/// A number as files of all countries, languages and C libraries have it: parse_real, with a comma for the point ("0,5"), Fortran's D for
/// the exponent's E ("1.5D+01"), C's f at the end ("1.5f"), and not a number where the word is a C library's for that ("nan(ind)",
/// "1.#QNAN", "-1.#IND", "1.#INF").
[[nodiscard]] inline std::optional<double> parse_loosely(std::string_view word) {
    if (const auto value = parse_real<double>(word)) return value;
    if (word.size() < 64 && word.find_first_of(",Dd") != std::string_view::npos && word.find_first_of("0123456789") < 3) {
        std::array<char, 64> text{};
        std::copy(word.begin(), word.end(), text.begin());
        if (const std::size_t comma = word.find(','); comma != std::string_view::npos && word.find('.') == std::string_view::npos)
            text[comma] = '.';
        if (const std::size_t exponent = word.find_first_of("Dd"); exponent != std::string_view::npos) text[exponent] = 'e';
        if (const auto value = parse_real<double>({text.data(), word.size()})) return value;
    }
    if (word.size() > 1 && lower(word.back()) == 'f' &&
        (word[word.size() - 2] == '.' || (word[word.size() - 2] >= '0' && word[word.size() - 2] <= '9')))
        return parse_real<double>(word.substr(0, word.size() - 1));
    if (word.find("#QNAN") != std::string_view::npos || word.find("#IND") != std::string_view::npos ||
        word.find("#INF") != std::string_view::npos || word.starts_with("nan(") || word.starts_with("-nan("))
        return std::numeric_limits<double>::quiet_NaN();
    return std::nullopt;
}

/// The whole word as a whole number.
template <class T>
[[nodiscard]] std::optional<T> parse_whole(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
}

/// A line's words, one after another.
class Words {
public:
    explicit Words(std::string_view line) : left_(line) {}
    /// The next word; empty at the end.
    std::string_view next() {
        std::size_t from = 0;
        while (from < left_.size() && is_space(left_[from])) ++from;
        std::size_t to = from;
        while (to < left_.size() && !is_space(left_[to])) ++to;
        const std::string_view word = left_.substr(from, to - from);
        left_.remove_prefix(to);
        return word;
    }
    /// The text that has not been read yet, without blanks around it.
    [[nodiscard]] std::string_view rest() const {
        std::string_view text = left_;
        while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
        while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
        return text;
    }

private:
    std::string_view left_;
};

/// A text's lines, which end with \n, \r\n or \r.
class Lines {
public:
    explicit Lines(std::string_view text) : left_(text) {}
    /// False at the end of the text.
    bool next(std::string_view& line) {
        if (left_.empty()) return false;
        std::size_t end = 0;
        while (end < left_.size() && !is_line_end(left_[end])) ++end;
        line = left_.substr(0, end);
        if (end + 1 < left_.size() && left_[end] == '\r' && left_[end + 1] == '\n') ++end;
        left_.remove_prefix(end < left_.size() ? end + 1 : end);
        ++number_;
        return true;
    }
    [[nodiscard]] std::size_t number() const { return number_; }  ///< of the line that next gave, from 1
    [[nodiscard]] std::string_view left() const { return left_; }

private:
    std::string_view left_;
    std::size_t number_ = 0;
};

}  // namespace halflit::io::detail
