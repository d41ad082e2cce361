#include "apps/io/gltf/text/json_scan.hpp"

#include "apps/io/files/text.hpp"
#include "sh/time_limit.hpp"
#include "shading/model/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <deque>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace halflit::io::detail {

namespace {

class Scanner {
public:
    Scanner(std::string_view text, const JsonScanLimits& limits, JsonVisitor& visitor) : text_(text), limits_(limits), visitor_(visitor) {}

    void run() {
        const std::size_t bad = find_invalid_utf8(text_);
        if (bad != std::string_view::npos)
            refuse(bad, fmt::format("expected UTF-8, found the byte \"{}\"", printable(text_.substr(bad, 1))));
        value();
        while (!open_.empty()) step();
        skip_space();
        if (at_ < text_.size())
            refuse(at_, fmt::format("expected the end of the JSON text, found \"{}\"", printable(text_.substr(at_, 1))));
    }

private:
    struct Key {
        std::string_view text;
        std::size_t offset;
    };
    struct Open {
        bool object;
        bool empty;
        std::size_t first_key;  // index of this object's first key in keys_
    };

    [[noreturn]] void refuse(std::size_t offset, std::string what, ErrorCode code = ErrorCode::bad_input) const {
        throw JsonFault{code, offset, std::move(what)};
    }
    [[nodiscard]] JsonFault other_than(const char* expected) const {
        if (at_ >= text_.size())
            return {ErrorCode::bad_input, text_.size(), fmt::format("expected {}, found the end of the text", expected)};
        std::size_t length = 1;
        while (length < 12 && at_ + length < text_.size() && static_cast<unsigned char>(text_[at_ + length] | 0x20) >= 'a' &&
               (text_[at_ + length] | 0x20) <= 'z')
            ++length;
        return {ErrorCode::bad_input, at_, fmt::format("expected {}, found \"{}\"", expected, printable(text_.substr(at_, length)))};
    }
    [[noreturn]] void unexpected(const char* expected) const { throw other_than(expected); }
    void loose(std::size_t offset, const char* what) { visitor_.on_loose({ErrorCode::bad_input, offset, what}); }
    void count_token() {
        if (++tokens_ > limits_.max_tokens)
            refuse(at_, fmt::format("more than {} JSON tokens, which is max_json_tokens", limits_.max_tokens), ErrorCode::limit);
        check_();
    }
    [[nodiscard]] char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    void skip_space() {
        do
            while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\r' || text_[at_] == '\t')) ++at_;
        while (peek() == '/' && skip_comment());
    }
    bool skip_comment() {
        const bool line = text_.substr(at_, 2) == "//";
        const std::size_t end = text_.find(line ? "\n" : "*/", std::min(at_ + 2, text_.size()));
        if (!line && (text_.substr(at_, 2) != "/*" || end == text_.npos)) return false;
        loose(at_, "a comment");
        at_ = line ? std::min(end, text_.size()) : end + 2;
        check_();
        return true;
    }
    /// Commas in front of which, or behind which, there is no value.
    void skip_commas(const char* expected) {
        visitor_.on_loose(other_than(expected));
        for (; peek() == ','; skip_space()) {
            check_();
            ++at_;
        }
    }

    // Reads one member or element of the innermost open object or array, or its end.
    void step() {
        Open& top = open_.back();
        skip_space();
        const char closing = top.object ? '}' : ']';
        if (peek() == closing && at_ < text_.size()) {
            close();
            return;
        }
        if (!top.empty) {
            if (peek() != ',') unexpected(top.object ? "',' or '}'" : "',' or ']'");
            ++at_;
            skip_space();
        }
        if (peek() == ',' || (!top.empty && peek() == closing)) {
            skip_commas(top.object ? "a key in double quotes" : "a JSON value");
            if (peek() == closing) return close();
        }
        top.empty = false;
        if (top.object) {
            if (peek() != '"') unexpected("a key in double quotes");
            count_token();
            JsonValue key{.type = JsonType::string, .offset = at_};
            key.text = string(key.in_place);
            if (!key.in_place) key.text = decoded_.emplace_back(key.text);
            keys_.push_back({key.text, key.offset});
            visitor_.on_key(key);
            skip_space();
            if (peek() != ':') unexpected("':'");
            ++at_;
        }
        value();
    }

    void close() {
        const Open top = open_.back();
        open_.pop_back();
        if (top.object) {
            const auto first = keys_.begin() + static_cast<std::ptrdiff_t>(top.first_key);
            std::sort(first, keys_.end(),
                      timed_less([](const Key& a, const Key& b) { return a.text != b.text ? a.text < b.text : a.offset < b.offset; }));
            const auto is_twin = [](const Key& a, const Key& b) { return a.text == b.text; };
            if (std::adjacent_find(first, keys_.end(), is_twin) != keys_.end()) report_twins(top.first_key);
            keys_.resize(top.first_key);
            if (keys_.empty()) decoded_.clear();
        }
        ++at_;
        visitor_.on_end(at_);
    }

    /// `keys_` from `first` on are sorted by text.
    void report_twins(std::size_t first) {
        std::vector<std::size_t> offsets;
        for (std::size_t i = first; i < keys_.size(); ++i) offsets.push_back(keys_[i].offset);
        std::sort(offsets.begin(), offsets.end());
        for (std::size_t i = first; i + 1 < keys_.size(); ++i) {
            check_();
            if (keys_[i].text != keys_[i + 1].text) continue;
            const std::size_t next = *std::upper_bound(offsets.begin(), offsets.end(), keys_[i].offset);
            visitor_.on_twin(keys_[i].text, keys_[i].offset, next, keys_[i + 1].offset);
        }
    }

    void value() {
        skip_space();
        count_token();
        const std::size_t offset = at_;
        const char c = peek();
        if (c == '{' || c == '[') {
            if (static_cast<int>(open_.size()) >= limits_.max_depth)
                refuse(at_, fmt::format("nested deeper than {} levels, which is max_json_depth", limits_.max_depth), ErrorCode::limit);
            ++at_;
            open_.push_back({c == '{', true, keys_.size()});
            visitor_.on_begin(c == '{' ? JsonType::object : JsonType::array, offset);
            return;
        }
        JsonValue v;
        v.offset = offset;
        if (c == '"') {
            v.type = JsonType::string;
            v.text = string(v.in_place);
        } else if (c == '-' || (c >= '0' && c <= '9')) {
            number(v);
        } else if (!literal(v)) {
            loose_number(v, other_than("a JSON value"));
        }
        visitor_.on_value(v, at_);
    }

    /// A word with a meaning, in any case; None is Python's null. False: there is none.
    bool literal(JsonValue& v) {
        static constexpr std::pair<std::string_view, JsonType> kWords[] = {
            {"true", JsonType::boolean}, {"false", JsonType::boolean}, {"null", JsonType::null}, {"none", JsonType::null}};
        for (const auto& [word, type] : kWords) {
            const std::string_view found = text_.substr(at_, word.size());
            if (!same_word(found, word)) continue;
            if (found != word || word == "none") visitor_.on_loose(other_than("a JSON value"));
            v.type = type;
            v.truth = word == "true";
            at_ += word.size();
            return true;
        }
        return false;
    }

    /// Passes digits; false: there are none.
    bool digits() {
        const std::size_t begin = at_;
        while (peek() >= '0' && peek() <= '9') ++at_;
        return at_ > begin;
    }

    /// True if the magnitude of a number that double cannot hold is below 1: it rounds to zero, which is no fault.
    static bool is_tiny(std::string_view number) {
        const std::size_t e = number.find_first_of("eE");
        const std::string_view mantissa = number.substr(0, e), exponent = e == number.npos ? "" : number.substr(e + 1);
        const std::size_t first = mantissa.find_first_of("123456789"), point = std::min(mantissa.find('.'), mantissa.size());
        if (first == mantissa.npos) return true;
        // Decimal exponent of the first digit that is not 0. An exponent out of range decides alone.
        const auto place = first < point ? static_cast<std::int64_t>(point - first) - 1 : -static_cast<std::int64_t>(first - point);
        const bool negative = exponent.starts_with('-');
        std::int64_t shift = 0;
        const std::string_view digits = exponent.substr(!exponent.empty() && (negative || exponent[0] == '+') ? 1 : 0);
        if (!digits.empty() && std::from_chars(digits.data(), digits.data() + digits.size(), shift).ec != std::errc{}) return negative;
        return place + (negative ? -shift : shift) < 0;
    }

    /// Passes a number of RFC 8259. Null: it is one; otherwise what is expected.
    const char* pass_number(JsonType& type) {
        type = JsonType::integer;
        if (peek() == '-') ++at_;
        const bool zero = peek() == '0';
        if (zero)
            ++at_;
        else if (!digits())
            return "a digit";
        if (zero && peek() >= '0' && peek() <= '9') return "a number without leading zeros";
        if (peek() == '.') {
            type = JsonType::number;
            ++at_;
            if (!digits()) return "a digit";
        }
        if (peek() == 'e' || peek() == 'E') {
            type = JsonType::number;
            ++at_;
            if (peek() == '+' || peek() == '-') ++at_;
            if (!digits()) return "a digit";
        }
        return nullptr;
    }

    /// The value of a text that begins with a number; returns its end. One that is too large is infinite.
    static const char* convert(std::string_view text, double& value) {
        const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
        if (parsed.ec == std::errc::result_out_of_range) value = is_tiny(text) ? 0 : std::numeric_limits<double>::infinity();
        return parsed.ptr;
    }

    /// A number that RFC 8259 forbids, from at_ on, or `fault`. std::from_chars knows nan, inf, infinity and nan(..), too.
    void loose_number(JsonValue& v, const JsonFault& fault) {
        const std::size_t end = std::min(text_.find_first_of(" \t\r\n,:[]{}/\"", at_), text_.size());
        const std::string_view whole = text_.substr(at_, end - at_), word = whole.substr(whole.starts_with('+') ? 1 : 0);
        if (word.empty() || (whole.size() > word.size() && word[0] == '-')) throw fault;
        v.type = JsonType::number;
        if (const std::size_t mark = word.find(".#"); mark != word.npos && mark + 2 < word.size() && mark <= 2)  // -1.#INF00, 1.#QNAN
            v.number = std::numeric_limits<double>::quiet_NaN();
        else if (convert(word, v.number) != word.data() + word.size())
            throw fault;
        visitor_.on_loose(fault);
        at_ = end;
    }

    void number(JsonValue& v) {
        const std::size_t begin = at_;
        if (const char* const expected = pass_number(v.type)) {
            const JsonFault fault = other_than(expected);
            at_ = begin;
            return loose_number(v, fault);
        }
        const std::string_view text = text_.substr(begin, at_ - begin);
        convert(text, v.number);
        if (!shading::finite(v.number)) {
            v.type = JsonType::number;
            visitor_.on_loose(
                {ErrorCode::bad_input, begin, fmt::format("the number {} is outside the range of double", printable(text, 40))});
        }
        constexpr std::int64_t kMaxExact = std::int64_t{1} << 53;
        std::int64_t whole = 0;
        if (v.type == JsonType::integer)
            v.exact = std::from_chars(text_.data() + begin, text_.data() + at_, whole).ec == std::errc{} && whole <= kMaxExact &&
                      whole >= -kMaxExact;
    }

    /// Four hexadecimal digits at `at`; nothing if they are not there.
    [[nodiscard]] std::optional<unsigned> hex4(std::size_t at) const {
        unsigned code = 0;
        const auto* first = text_.data() + std::min(at, text_.size());
        const auto* last = text_.data() + std::min(at + 4, text_.size());
        const auto parsed = std::from_chars(first, last, code, 16);
        if (parsed.ptr != first + 4 || *first == '-') return std::nullopt;
        return code;
    }

    void escape(std::string& out) {
        static constexpr std::string_view kNames = "\"\\/bfnrt", kMeaning = "\"\\/\b\f\n\r\t";
        const std::size_t which = at_ < text_.size() ? kNames.find(text_[at_]) : std::string_view::npos;
        if (which != std::string_view::npos) {
            out += kMeaning[which];
            ++at_;
            return;
        }
        const std::optional<unsigned> found = peek() == 'u' ? hex4(at_ + 1) : std::nullopt;
        if (!found) {  // a path of Windows, say
            at_ += peek() == 'u' ? 1 : 0;
            const JsonFault fault =
                other_than(at_ > 0 && text_[at_ - 1] == 'u' ? "four hexadecimal digits after \\u" : "an escape sequence");
            if (at_ >= text_.size()) throw fault;
            visitor_.on_loose(fault);
            out += text_[at_ - 1] == 'u' ? "\\u" : "\\";
            return;
        }
        const std::size_t begin = at_ - 1;
        at_ += 5;
        unsigned code = *found;
        const std::optional<unsigned> low = text_.substr(at_, 2) == "\\u" ? hex4(at_ + 2) : std::nullopt;
        if (code >= 0xD800 && code <= 0xDBFF && low >= 0xDC00u && low <= 0xDFFFu) {
            at_ += 6;
            code = 0x10000 + ((code - 0xD800) << 10) + (*low - 0xDC00);
        } else if (code >= 0xD800 && code <= 0xDFFF) {
            loose(begin, "half of a surrogate pair");
            code = 0xFFFD;  // the replacement character
        }
        if (code < 0x80) {
            out += static_cast<char>(code);
        } else {
            const int tail = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
            static constexpr unsigned kLead[4] = {0, 0xC0, 0xE0, 0xF0};
            out += static_cast<char>(kLead[tail] | code >> (6 * tail));
            for (int i = tail - 1; i >= 0; --i) out += static_cast<char>(0x80u | (code >> (6 * i) & 63u));
        }
    }

    std::string_view string(bool& in_place) {
        const std::size_t begin = ++at_;
        while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\\' && static_cast<unsigned char>(text_[at_]) >= 0x20) ++at_;
        in_place = peek() == '"';
        if (in_place) return text_.substr(begin, at_++ - begin);
        scratch_.assign(text_, begin, at_ - begin);
        while (peek() != '"') {
            if (at_ >= text_.size()) refuse(begin - 1, "the string has no closing quote");
            if (static_cast<unsigned char>(text_[at_]) < 0x20) loose(at_, "a control character in a string must be escaped");
            if (text_[at_] == '\\') {
                ++at_;
                escape(scratch_);
            } else {
                scratch_ += text_[at_++];
            }
        }
        ++at_;
        return scratch_;
    }

    std::string_view text_;
    const JsonScanLimits limits_;
    JsonVisitor& visitor_;
    std::size_t at_ = 0, tokens_ = 0;
    TimeCheck check_;
    std::vector<Open> open_;
    std::vector<Key> keys_;
    std::deque<std::string> decoded_;  // keys that held escapes
    std::string scratch_;
};

}  // namespace

const char* name_of(JsonType type) {
    switch (type) {
        case JsonType::object:
            return "an object";
        case JsonType::array:
            return "an array";
        case JsonType::string:
            return "a string";
        case JsonType::integer:
            return "an integer";
        case JsonType::number:
            return "a number";
        case JsonType::boolean:
            return "true or false";
        case JsonType::null:
            break;
    }
    return "null";
}

void JsonVisitor::on_twin(std::string_view key, std::size_t /*first*/, std::size_t /*next*/, std::size_t again) {
    throw JsonFault{ErrorCode::bad_input, again, fmt::format("the key \"{}\" is there twice", printable(key, 60))};
}

void scan_json(std::string_view text, const JsonScanLimits& limits, JsonVisitor& visitor) { Scanner(text, limits, visitor).run(); }

}  // namespace halflit::io::detail
