// Text from files that goes into messages: escaped, so that a name cannot move the cursor or forge a second line, and cut to length.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace halflit::io {

/// A letter of ASCII as a small one.
[[nodiscard]] constexpr char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// True if the words are equal but for the case of ASCII letters; `small` has small letters.
[[nodiscard]] constexpr bool same_word(std::string_view word, std::string_view small) {
    if (word.size() != small.size()) return false;
    for (std::size_t i = 0; i < word.size(); ++i)
        if (lower(word[i]) != small[i]) return false;
    return true;
}

/// True if the text ends so, but for the case of ASCII letters; `small` has small letters.
[[nodiscard]] constexpr bool ends_with_word(std::string_view text, std::string_view small) {
    return text.size() >= small.size() && same_word(text.substr(text.size() - small.size()), small);
}

/// Control characters, DEL, the C1 controls and bytes that are not UTF-8 become \xNN; at most `max_bytes` of the source are shown.
[[nodiscard]] std::string printable(std::string_view text, std::size_t max_bytes = 200);

/// JSON text, valid UTF-8, with what printable() escapes beyond ASCII as \uNNNN: the same JSON value.
[[nodiscard]] std::string display_safe_json(std::string_view json);

/// Number of bytes of the UTF-8 sequence at text[at], or 0 where there is none (overlong forms and surrogates included).
[[nodiscard]] int utf8_sequence(std::string_view text, std::size_t at);

/// Offset of the first byte that is not UTF-8, or npos.
[[nodiscard]] std::size_t find_invalid_utf8(std::string_view text);

/// The folder of a path, "." for a bare name.
[[nodiscard]] std::string folder_of(const std::string& path);

}  // namespace halflit::io
