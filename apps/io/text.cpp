#include "apps/io/text.hpp"

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

std::string printable(std::string_view text, std::size_t max_bytes) {
    static constexpr char kHex[] = "0123456789abcdef";
    std::string out;
    const std::string_view shown = text.substr(0, max_bytes);
    for (std::size_t at = 0; at < shown.size();) {
        const int length = utf8_sequence(shown, at);
        const unsigned first = byte_at(shown, at);
        const bool c1 = length == 2 && first == 0xC2 && byte_at(shown, at + 1) < 0xA0;
        if (length == 0 || c1 || (length == 1 && (first < 0x20 || first == 0x7F))) {
            out += "\\x";
            out += kHex[first >> 4];
            out += kHex[first & 15u];
            ++at;
        } else {
            out.append(shown, at, static_cast<std::size_t>(length));
            at += static_cast<std::size_t>(length);
        }
    }
    if (text.size() > shown.size()) out += "...";
    return out;
}

}  // namespace halflit::io
