#include "apps/halflit/messages.hpp"

#include <cstdint>
#include <cstdio>

namespace halflit::cli {
namespace {

/// Length of the well-formed UTF-8 sequence at the start of `text`; 0 for none.
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<std::uint8_t>(text[i]) : std::uint8_t{0}; };
    const auto tail = [&](std::size_t i, unsigned low = 0x80, unsigned high = 0xBF) { return byte(i) >= low && byte(i) <= high; };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    if (first >= 0xC2 && first <= 0xDF) return tail(1) ? 2 : 0;
    // The second byte's limits keep out overlong forms, surrogates and what lies above U+10FFFF.
    if (first >= 0xE0 && first <= 0xEF) return tail(1, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF) && tail(2) ? 3 : 0;
    if (first >= 0xF0 && first <= 0xF4)
        return tail(1, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF) && tail(2) && tail(3) ? 4 : 0;
    return 0;
}

void append_hex(std::string& out, char c) {
    constexpr char kDigits[] = "0123456789abcdef";
    const auto byte = static_cast<std::uint8_t>(c);
    out += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
}

bool is_control(std::string_view sequence) {
    const auto first = static_cast<std::uint8_t>(sequence[0]);
    if (sequence.size() == 1) return first < 0x20 || first == 0x7F;
    return first == 0xC2 && static_cast<std::uint8_t>(sequence[1]) < 0xA0;  // C1
}

void print_line(std::string_view kind, std::string_view message) {
    const std::string line = "halflit: " + std::string(kind) + printable(message) + "\n";
    std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

std::string printable(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        const std::string_view sequence = text.substr(0, length == 0 ? 1 : length);
        if (length == 0 || is_control(sequence))
            for (const char c : sequence) append_hex(out, c);
        else
            out += sequence;
        text.remove_prefix(sequence.size());
    }
    return out;
}

void print_error(std::string_view message) {
    if (!message.empty()) print_line("error: ", message);
}

void print_warning(std::string_view message) { print_line("warning: ", message); }

void print_note(std::string_view message) { print_line("", message); }

}  // namespace halflit::cli
