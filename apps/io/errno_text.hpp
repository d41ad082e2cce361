// The system's words for an error number.
#pragma once

#include <cstring>
#include <string>

namespace halflit::io {

/// Thread-safe, which strerror is not.
inline std::string errno_text(int error) {
    char buffer[128] = "";
    return ::strerror_r(error, buffer, sizeof buffer);  // the GNU form: returns the text
}

}  // namespace halflit::io
