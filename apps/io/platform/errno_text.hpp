// The system's words for an error number.
#pragma once

#include <string>

namespace halflit::platform {

/// Thread-safe, which strerror is not.
[[nodiscard]] std::string errno_text(int error);

}  // namespace halflit::platform
