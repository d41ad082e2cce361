#include "apps/io/models/text_scanner.hpp"

#include "apps/io/files/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace halflit::io::detail {

namespace {

constexpr std::string_view kOpening = "([{", kClosing = ")]}", kBehind = ")]},;";

}  // namespace

std::string_view TextScanner::bare_word_in_line() {
    for (std::string_view whole = word_in_line(); !whole.empty(); whole = word_in_line()) {
        const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
        if (is_digit(whole.front()) && is_digit(whole.back())) return whole;
        std::string_view word = whole.substr(std::min(whole.find_first_not_of(kOpening), whole.size()));
        word = word.substr(0, word.find_last_not_of(kBehind) + 1);
        if (word.data() != whole.data() || whole.find_first_of(kClosing) != whole.npos) loose(whole, "a word without brackets");
        if (!word.empty()) return word;
    }
    return {};
}

void TextScanner::pass_comment() {
    const char* const from = at_;
    while (at_ < end_ && !is_line_end(*at_)) ++at_;
    if (kept_ == nullptr) return;
    const std::string_view comment(from, static_cast<std::size_t>(at_ - from));
    if (!comment.starts_with(kept_mark_)) return;
    document_->geometry.take(sizeof comment);
    kept_->push_back(comment.substr(kept_mark_.size()));
}

std::string_view TextScanner::rest_of_line(bool with_marks) {
    while (with_marks && at_ < end_ && is_space(*at_) && !is_line_end(*at_)) ++at_;
    if (!with_marks && !find_word()) return {};
    joined_.clear();
    const char* from = at_;
    const auto is_mark = [&](const char* at) { return *at == '#' && !with_marks && (at == from || is_space(at[-1])); };
    while (at_ < end_ && !is_line_end(*at_) && !is_mark(at_)) {
        if (!is_joined_end(at_)) {
            ++at_;
            continue;
        }
        joined_.append(from, at_) += ' ';
        ++at_;
        pass_end();
        from = at_;
    }
    taken_in_line_ = true;
    std::string_view text(from, static_cast<std::size_t>(at_ - from));
    if (!joined_.empty()) text = joined_.append(text);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    skip_line();
    return text;
}

std::size_t TextScanner::rest_size() const {
    const char* behind = at_;
    while (behind < end_ && !is_line_end(*behind)) behind = is_joined_end(behind) ? behind_end(behind + 1) : behind + 1;
    return static_cast<std::size_t>(behind - at_);
}

void TextScanner::skip_line() {
    while (find_word()) {
        while (at_ < end_ && !is_line_end(*at_) && !is_joined_end(at_) && *at_ != '#') ++at_;
        if (at_ < end_ && *at_ == '#' && !is_space(at_[-1])) ++at_;  // inside a word
    }
}

std::size_t TextScanner::words_in_line(std::size_t most) const {
    std::size_t count = 0;
    bool in_word = false;
    for (const char* at = at_; at < end_ && count < most && !is_line_end(*at) && (in_word || *at != '#');) {
        const bool is_joined = is_joined_end(at), is_part = !is_joined && !is_space(*at);
        if (is_part && !in_word) ++count;
        in_word = is_part;
        at = is_joined ? behind_end(at + 1) : at + 1;
    }
    return count;
}

bool TextScanner::parse_odd_number(double& value) {
    const char* behind = at_;
    while (behind < end_ && !is_space(*behind) && !is_joined_end(behind)) ++behind;
    std::string_view word(at_, static_cast<std::size_t>(behind - at_));
    const bool strict = document_->options.strict;
    bool has_brackets = false;
    if (!strict) {
        const std::size_t opening = std::min(word.find_first_not_of(kOpening), word.size());
        word.remove_prefix(opening);
        // "1.5, 2", "1.5;2" and "1,2,3": the number ends at the first of them. A single comma without a point is decimal.
        const bool is_part = at_ > begin_ && (at_[-1] == ',' || at_[-1] == ';');
        const bool is_decimal = !is_part && std::count(word.begin(), word.end(), ',') == 1 &&
                                word.find_first_of(".;") == std::string_view::npos && word.back() != ',';
        if (const std::size_t part = is_decimal ? std::string_view::npos : word.find_first_of(",;"); part != std::string_view::npos) {
            behind = word.data() + part + 1;
            word = word.substr(0, part);
        }
        const std::size_t size = word.find_last_not_of(kClosing) + 1;
        has_brackets = opening > 0 || size < word.size();
        word = word.substr(0, size);
        if (has_brackets && word.empty()) {  // brackets alone
            at_ = behind;
            return find_word() && parse_number(value);
        }
    }
    const std::optional<double> found = strict ? parse_real<double>(word) : parse_loosely(word);
    if (!found) return false;
    if (has_brackets) loose({at_, static_cast<std::size_t>(behind - at_)}, "a number without brackets");
    value = *found;
    at_ = behind;
    check_();
    return taken_in_line_ = true;
}

std::optional<std::uint64_t> TextScanner::parse_count(std::string_view word) {
    while (!word.empty() && (word.back() == ',' || word.back() == ';')) word.remove_suffix(1);
    if (const auto number = parse_whole<std::uint64_t>(word)) return number;
    const auto real = parse_real<double>(word);
    if (!real || !(*real >= 0 && *real < 9e15) || *real != std::floor(*real)) return std::nullopt;
    return static_cast<std::uint64_t>(*real);
}

void TextScanner::note(Noted& noted, std::string_view found, std::string_view expected) const {
    if (document_->options.strict) refuse_word(found, expected);
    if (++noted.count > 1) return;
    noted.first = found.empty() ? fmt::format("{}: expected {}, the line ends", where(), expected)
                                : fmt::format("{}: expected {}, found \"{}\"", where(), expected, printable(found, 40));
}

void TextScanner::unknown(std::string_view found, std::string_view expected) { note(unknown_, found, expected); }

double TextScanner::wrong(std::string_view found, std::string_view expected) {
    note(wrong_, found, expected);
    return std::numeric_limits<double>::quiet_NaN();
}

void TextScanner::refuse_word(std::string_view found, std::string_view expected) const {
    refuse(where(), !found.empty() ? fmt::format("expected {}, found \"{}\"", expected, printable(found, 40))
                    : at_ == end_  ? fmt::format("expected {}, the file ends: it was cut off", expected)
                                   : fmt::format("expected {}, the line ends", expected));
}

std::string TextScanner::where() const {
    const bool is_behind = at_ == end_ && at_ > begin_ && is_line_end(at_[-1]);  // the last line
    return fmt::format("{}line {}", name_, line_ - (is_behind ? 1 : 0));
}

void TextScanner::warn() {
    for (const auto& [noted, instead] :
         {std::pair(&unknown_, "passed over"), {&wrong_, "what needs the value is left out"}, {&loose_, "read as it is meant"}}) {
        if (noted->count == 0) continue;
        const std::string others = noted->count > 1 ? fmt::format(" (and {} more)", noted->count - 1) : "";
        document_->go_on_without({{ErrorCode::bad_input, noted->first + others}}, instead);
        noted->count = 0;
    }
    if (const std::size_t rows = std::exchange(long_rows_, 0); rows > 0)
        document_->warn(fmt::format("{} lines have more values than the header says, which are passed over", rows));
}

}  // namespace halflit::io::detail
