#include "apps/io/files/text.hpp"

#include "apps/io/platform/files.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace halflit::io {

namespace {
unsigned byte_at(std::string_view text, std::size_t at) { return at < text.size() ? static_cast<unsigned char>(text[at]) : 0u; }
bool is_tail(unsigned byte) { return (byte & 0xC0u) == 0x80u; }
}  // namespace

int utf8_sequence(std::string_view text, std::size_t at) {
    const unsigned first = byte_at(text, at), second = byte_at(text, at + 1);
    if (at >= text.size()) return 0;
    if (first < 0x80) return 1;
    if (first >= 0xC2 && first <= 0xDF) return is_tail(second) ? 2 : 0;
    if ((first & 0xF0u) == 0xE0u) {
        const bool ok =
            is_tail(second) && is_tail(byte_at(text, at + 2)) && !(first == 0xE0 && second < 0xA0) && !(first == 0xED && second > 0x9F);
        return ok ? 3 : 0;
    }
    if (first >= 0xF0 && first <= 0xF4) {
        const bool ok = is_tail(second) && is_tail(byte_at(text, at + 2)) && is_tail(byte_at(text, at + 3)) &&
                        !(first == 0xF0 && second < 0x90) && !(first == 0xF4 && second > 0x8F);
        return ok ? 4 : 0;
    }
    return 0;
}

std::size_t find_invalid_utf8(std::string_view text) {
    std::size_t at = 0;
    while (at < text.size()) {
        std::uint64_t eight = 0;
        while (at + 8 <= text.size()) {  // plain ASCII, eight bytes at a time
            std::memcpy(&eight, text.data() + at, 8);
            if ((eight & 0x8080808080808080ull) != 0) break;
            at += 8;
        }
        if (at >= text.size()) break;
        const int length = utf8_sequence(text, at);
        if (length == 0) return at;
        at += static_cast<std::size_t>(length);
    }
    return std::string_view::npos;
}

namespace {

/// The code point of a sequence of 2 to 4 bytes.
unsigned code_point(std::string_view text, std::size_t at, int length) {
    unsigned code = byte_at(text, at) & (0x7Fu >> length);
    for (int i = 1; i < length; ++i) code = code << 6 | (byte_at(text, at + static_cast<std::size_t>(i)) & 0x3Fu);
    return code;
}

/// True for a character that has no glyph of its own and changes how others are shown: control, direction, format and tag characters,
/// separators of lines (Unicode 15, categories Cc, Cf, Zl and Zp).
bool changes_display(unsigned code) {
    static constexpr struct {
        unsigned first, last;
    } kRanges[] = {{0x00, 0x1F},       {0x7F, 0x9F},       {0xAD, 0xAD},      {0x600, 0x605},     {0x61C, 0x61C},     {0x6DD, 0x6DD},
                   {0x70F, 0x70F},     {0x890, 0x891},     {0x8E2, 0x8E2},    {0x180E, 0x180E},   {0x200B, 0x200F},   {0x2028, 0x202E},
                   {0x2060, 0x206F},   {0xFEFF, 0xFEFF},   {0xFFF9, 0xFFFB},  {0x110BD, 0x110BD}, {0x110CD, 0x110CD}, {0x13430, 0x1343F},
                   {0x1BCA0, 0x1BCA3}, {0x1D173, 0x1D17A}, {0xE0000, 0xE007F}};
    for (const auto& range : kRanges)
        if (code >= range.first && code <= range.last) return true;
    return false;
}

}  // namespace

std::string printable(std::string_view text, std::size_t max_bytes) {
    static constexpr char kHex[] = "0123456789abcdef";
    std::string out;
    const std::string_view shown = text.substr(0, max_bytes);
    for (std::size_t at = 0; at < shown.size();) {
        const int length = utf8_sequence(shown, at);
        const bool shown_as_it_is = length > 0 && !changes_display(length == 1 ? byte_at(shown, at) : code_point(shown, at, length));
        const std::size_t end = at + static_cast<std::size_t>(length == 0 ? 1 : length);
        for (; at < end; ++at) {
            if (shown_as_it_is) {
                out += shown[at];
                continue;
            }
            out += "\\x";
            out += kHex[byte_at(shown, at) >> 4];
            out += kHex[byte_at(shown, at) & 15u];
        }
    }
    if (text.size() > shown.size()) out += "...";
    return out;
}

std::string display_safe_json(std::string_view json) {
    const auto add_unit = [](std::string& out, unsigned unit) { out += fmt::format("\\u{:04x}", unit); };
    std::string out;
    TimeCheck check;
    for (std::size_t at = 0, end = 0; at < json.size(); at = end) {
        check();
        const int length = std::max(1, utf8_sequence(json, at));
        end = at + static_cast<std::size_t>(length);
        const unsigned code = length == 1 ? byte_at(json, at) : code_point(json, at, length);
        if (code < 0x7F || !changes_display(code)) {  // JSON escapes the controls of ASCII but DEL
            out.append(json, at, end - at);
        } else if (code < 0x10000) {
            add_unit(out, code);
        } else {
            add_unit(out, 0xD7C0 + (code >> 10));
            add_unit(out, 0xDC00 + (code & 0x3FF));
        }
    }
    return out;
}

std::string folder_of(const std::string& path) {
    const std::size_t slash = platform::last_separator(path);
    if (slash == std::string::npos) return ".";
    const bool of_root = slash == 0 || path[slash - 1] == ':';  // "C:" is another folder than "C:/"
    return path.substr(0, of_root ? slash + 1 : slash);
}

}  // namespace halflit::io
