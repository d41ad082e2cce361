// Setting a value, and whether its bits change.
#pragma once

#include <cstring>

namespace halflit::io::detail {

/// Sets a value. Returns true if its bytes change.
template <class T>
bool replace(T& value, const T& by) {
    if (std::memcmp(&value, &by, sizeof value) == 0) return false;  // NOLINT(bugprone-suspicious-memory-comparison): bits are meant
    value = by;
    return true;
}

}  // namespace halflit::io::detail
