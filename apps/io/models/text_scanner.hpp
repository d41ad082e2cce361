// Words and numbers of the text formats: STL, OBJ, MTL, OFF and PLY are read by one rule. White space of any kind parts words, `#` at the
// start of a word begins a comment up to the line's end, numbers may have commas or semicolons behind them, and brackets around. A word
// that a format does not have is passed over, and a value that is no number is read as NaN: one warning for each kind, with the first
// place. `--strict` refuses.
#pragma once

#include "apps/io/gltf/file/document.hpp"
#include "apps/io/models/model_text.hpp"
#include "sh/time_limit.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// Thrown where a file ends before a value: what came before is drawn.
struct CutOff {};

class TextScanner {
public:
    /// name: stands before the line in messages. joined_lines: a backslash at the end of a line joins it to the next one. The text must
    /// outlive the scanner. first_line: number of the text's first line.
    explicit TextScanner(std::string_view text, Document& document, std::string name = "", bool joined_lines = false,
                         std::size_t first_line = 1)
        : begin_(text.data()),
          at_(text.data()),
          end_(text.data() + text.size()),
          document_(&document),
          name_(std::move(name)),
          joined_lines_(joined_lines),
          line_(first_line) {}

    // ---- words ---------------------------------------------------------------------------------------------------------
    /// The next word, of this line or a later one; empty at the end of the text.
    std::string_view word() { return go_to_word() ? take_word() : std::string_view(); }
    /// Goes to the next word of the text, which stays. False: it has no more.
    bool go_to_word() {
        while (!find_word())
            if (!pass_line_end()) return false;
        return true;
    }
    /// The next word of this line; empty at its end.
    std::string_view word_in_line() { return find_word() ? take_word() : std::string_view(); }
    /// The same without brackets, which are noted, commas and semicolons around it; those alone are passed over.
    std::string_view bare_word_in_line();
    /// The same as word_in_line(), which stays.
    std::string_view next_in_line() {
        if (!find_word()) return {};
        const char* behind = at_;
        while (behind < end_ && !is_space(*behind) && !is_joined_end(behind)) ++behind;
        return {at_, static_cast<std::size_t>(behind - at_)};
    }
    /// The rest of the line without blanks around it, up to a comment; with_marks: with what stands behind a `#`, which names may have.
    /// Joined lines are one, with a blank between them, until the next call.
    std::string_view rest_of_line(bool with_marks = false);
    /// Bytes up to the end of the line, with those that are joined to it.
    [[nodiscard]] std::size_t rest_size() const;
    /// Goes to the end of the line.
    void skip_line();
    /// The same for values that a row should not have, of which warn() tells.
    void pass_long_row() { skip_line(), ++long_rows_; }
    /// Words up to the end of the line, at most `most`, which stay.
    [[nodiscard]] std::size_t words_in_line(std::size_t most) const;
    /// True if no word of this line was taken yet.
    [[nodiscard]] bool is_at_line_begin() const { return !taken_in_line_; }
    /// Comments that begin with `mark` are appended to a list, without it.
    void keep_comments(std::string_view mark, std::vector<std::string_view>& into) { kept_mark_ = mark, kept_ = &into; }

    // ---- numbers -------------------------------------------------------------------------------------------------------
    /// Takes the next number of this line into `value`. False: another word or the line's end comes, and stays.
    bool take_number(double& value) { return find_word() && parse_number(value); }
    /// The next number of this line. Not a number, which is noted, where the line ends or another word stands, which is taken.
    double number_in_line() {
        double value = 0;
        return take_number(value) ? value : wrong(word_in_line(), "a number");
    }
    /// The next number of the text. Throws CutOff at its end.
    double number() {
        double value = 0;
        find_word_in_text();
        return parse_number(value) ? value : wrong(take_word(), "a number");
    }
    /// The next word of the text as a number of things; nothing where it is none. Throws CutOff at the text's end.
    std::optional<std::uint64_t> count() {
        find_word_in_text();
        return parse_count(take_word());
    }
    /// A whole number that is not negative, which may be written as 3.0 or with a comma behind it.
    [[nodiscard]] static std::optional<std::uint64_t> parse_count(std::string_view word);

    // ---- places --------------------------------------------------------------------------------------------------------
    struct Mark {
        const char* at;
        std::size_t line;
        bool taken_in_line;
    };
    [[nodiscard]] Mark mark() const { return {at_, line_, taken_in_line_}; }
    void go_back(const Mark& mark) { at_ = mark.at, line_ = mark.line, taken_in_line_ = mark.taken_in_line; }

    // ---- what is wrong -------------------------------------------------------------------------------------------------
    /// Notes a word that the format does not have here. Strict: refuses it.
    void unknown(std::string_view found, std::string_view expected);
    /// Notes a word in another form than `expected`, which is read. Strict: refuses it.
    void loose(std::string_view found, std::string_view expected) { note(loose_, found, expected); }
    /// Notes a value that is not `expected`; found: the word there, empty at the line's end. Returns not a number. Strict: refuses it.
    double wrong(std::string_view found, std::string_view expected);
    /// Refuses what was found, at this line.
    [[noreturn]] void refuse_word(std::string_view found, std::string_view expected) const;
    /// Says what should come next, for the message of end().
    void expect_next(const char* what) { expected_ = what; }
    /// Throws CutOff: the text ends before what is expected. Strict: refuses it.
    [[noreturn]] void end() const {
        if (document_->options.strict) refuse_word("", expected_);
        throw CutOff{};
    }
    /// "line 7", for messages.
    [[nodiscard]] std::string where() const;
    [[nodiscard]] std::size_t line() const { return line_; }
    /// Warns of what was noted. The readers call it once, at the end.
    void warn();

    /// The text that was not read yet.
    [[nodiscard]] std::string_view left() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }

private:
    [[nodiscard]] bool is_joined_end(const char* at) const { return joined_lines_ && *at == '\\' && at + 1 < end_ && is_line_end(at[1]); }
    /// Behind the end of a line.
    [[nodiscard]] const char* behind_end(const char* at) const { return at + (*at == '\r' && at + 1 < end_ && at[1] == '\n' ? 2 : 1); }
    /// Goes to the next word of this line. False: it has no more.
    bool find_word() {
        for (; at_ < end_; ++at_) {
            if (!is_space(*at_)) {
                if (*at_ == '#') {
                    pass_comment();
                    return false;
                }
                if (!is_joined_end(at_)) return true;
                ++at_;
                pass_end();
                --at_;
            } else if (is_line_end(*at_)) {
                return false;
            }
        }
        return false;
    }
    void find_word_in_text() {
        if (!go_to_word()) end();
    }
    std::string_view take_word() {
        const char* const from = at_;
        while (at_ < end_ && !is_space(*at_) && !is_joined_end(at_)) ++at_;
        check_();
        taken_in_line_ = true;
        return {from, static_cast<std::size_t>(at_ - from)};
    }
    /// Behind find_word(). False: the word is no number, and stays.
    bool parse_number(double& value) {
        const auto [behind, error] = std::from_chars(at_, end_, value);
        if (error != std::errc() || (behind < end_ && !is_space(*behind))) return parse_odd_number(value);
        at_ = behind;
        check_();
        return taken_in_line_ = true;
    }
    bool parse_odd_number(double& value);
    void pass_comment();
    /// Goes past the end of a line, where it stands.
    void pass_end() {
        at_ = behind_end(at_);
        ++line_;
        check_();
    }
    /// The same for the line that is read. False at the end of the text.
    bool pass_line_end() {
        if (at_ == end_) return false;
        pass_end();
        taken_in_line_ = false;
        return true;
    }
    struct Noted {
        std::string first;
        std::size_t count = 0;
    };
    void note(Noted& noted, std::string_view found, std::string_view expected) const;

    const char *begin_, *at_, *end_;
    const char* expected_ = "more";
    Document* document_;
    std::string name_, joined_;
    bool joined_lines_, taken_in_line_ = false;
    std::size_t line_;
    TimeCheck check_;
    std::string_view kept_mark_;
    std::vector<std::string_view>* kept_ = nullptr;
    Noted unknown_, wrong_, loose_;
    std::size_t long_rows_ = 0;
};

}  // namespace halflit::io::detail
