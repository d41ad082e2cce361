// The system's words for an error number.
#pragma once

#include <cstring>
#include <string>

namespace halflit::io {

namespace detail {
// strerror_r returns the text (GNU) or writes it into the buffer (POSIX).
inline const char* error_words(const char* text, const char* /*buffer*/) { return text; }
inline const char* error_words(int /*failed*/, const char* buffer) { return buffer; }
}  // namespace detail

/// Thread-safe, which strerror is not.
inline std::string errno_text(int error) {
    char buffer[128] = "";
    return detail::error_words(::strerror_r(error, buffer, sizeof buffer), buffer);
}

}  // namespace halflit::io
