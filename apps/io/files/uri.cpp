#include "apps/io/files/uri.hpp"

#include "apps/io/files/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

namespace halflit::io::detail {

namespace {

constexpr std::array<std::int16_t, 256> make_base64_table() {
    std::array<std::int16_t, 256> table{};
    table.fill(-1);
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < kDigits.size(); ++i) table[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int16_t>(i);
    return table;
}
constexpr std::array<std::int16_t, 256> kBase64 = make_base64_table();

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::optional<std::string> percent_decode(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            out += text[i];
            continue;
        }
        const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
        const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
        if (high < 0 || low < 0) return std::nullopt;
        out += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return out;
}

/// Base64 without white space and percent sequences.
std::string packed(std::string_view text) {
    std::string out = percent_decode(text).value_or(std::string(text));
    std::erase_if(out, [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); });
    return out;
}

Result<std::vector<std::byte>> decode_base64(std::string_view text, std::size_t max_bytes) {
    std::string_view digits = text;
    int padding = 0;
    while (padding < 2 && !digits.empty() && digits.back() == '=') {
        digits.remove_suffix(1);
        ++padding;
    }
    if (digits.size() % 4 == 1 || (padding > 0 && text.size() % 4 != 0))
        return fail(ErrorCode::bad_input, fmt::format("base64 of {} characters is cut short", text.size()));
    const std::size_t size = digits.size() / 4 * 3 + (digits.size() % 4 == 0 ? 0 : digits.size() % 4 - 1);
    if (size > max_bytes) return fail(ErrorCode::limit, fmt::format("holds {} bytes, the limit is {}", size, max_bytes));
    std::vector<std::byte> out(size);
    std::uint32_t bits = 0;
    std::size_t at = 0, count = 0;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        const int digit = kBase64[static_cast<unsigned char>(digits[i])];
        if (digit < 0)
            return fail(ErrorCode::bad_input, fmt::format("base64 character {}: found \"{}\"", i, printable(digits.substr(i, 1))));
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        if (++count == 4) {
            for (int shift = 16; shift >= 0; shift -= 8) out[at++] = static_cast<std::byte>(bits >> shift & 255u);
            count = 0;
            bits = 0;
        }
    }
    if (count == 2) out[at] = static_cast<std::byte>(bits >> 4 & 255u);
    if (count == 3) {
        out[at++] = static_cast<std::byte>(bits >> 10 & 255u);
        out[at] = static_cast<std::byte>(bits >> 2 & 255u);
    }
    return out;
}

}  // namespace

bool is_data_uri(std::string_view uri) { return same_word(uri.substr(0, 5), "data:"); }

Result<std::vector<std::byte>> decode_data_uri(std::string_view uri, std::size_t max_bytes, bool* mended) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) return fail(ErrorCode::bad_input, "data URI: expected a comma after the media type");
    const std::string_view header = uri.substr(5, comma - 5), body = uri.substr(comma + 1);
    constexpr std::string_view kBase64Mark = ";base64";
    if (ends_with_word(header, kBase64Mark)) {
        auto bytes = decode_base64(body, max_bytes);
        if (!bytes && mended != nullptr)
            if (const std::string clean = packed(body); clean != body) {
                bytes = decode_base64(clean, max_bytes);
                *mended = bytes.has_value();
            }
        if (!bytes) return fail(bytes.error().code, fmt::format("data URI: {}", bytes.error().message));
        return bytes;
    }
    const std::optional<std::string> plain = percent_decode(body);
    if (!plain) return fail(ErrorCode::bad_input, "data URI: broken percent sequence");
    if (plain->size() > max_bytes)
        return fail(ErrorCode::limit, fmt::format("data URI: holds {} bytes, the limit is {}", plain->size(), max_bytes));
    const auto* first = reinterpret_cast<const std::byte*>(plain->data());
    return std::vector<std::byte>(first, first + plain->size());
}

Result<std::string> decode_file_uri(std::string_view uri, bool tolerant) {
    const std::size_t colon = uri.find(':');
    const bool elsewhere = tolerant && (colon == 1 || same_word(uri.substr(0, std::min(colon, uri.size())), "file"));
    if (elsewhere && colon > 1) uri.remove_prefix(colon + 1);
    if (!elsewhere && colon != std::string_view::npos && uri.substr(0, colon).find('/') == std::string_view::npos)
        return fail(ErrorCode::bad_input,
                    fmt::format("\"{}\": expected a file below the model's folder, found an address with a scheme", printable(uri)));
    std::optional<std::string> name = percent_decode(uri);
    if (!name && tolerant) name = uri;
    if (!name) return fail(ErrorCode::bad_input, fmt::format("\"{}\": broken percent sequence", printable(uri)));
    if (name->find('\0') != std::string::npos)
        return fail(ErrorCode::bad_input, fmt::format("\"{}\": a file name cannot hold a zero byte", printable(uri)));
    return *std::move(name);
}

}  // namespace halflit::io::detail
