// Failures of loading: a fault with its place in the model, or a limit reached.
#pragma once

#include "halflit/error.hpp"

#include <cstdint>
#include <string_view>
#include <utility>

namespace halflit::io::detail {

/// Thrown inside this folder only; load_gltf_bytes returns its Error.
struct LoadFailure {
    Error error;
};

/// Throws LoadFailure "where: what".
[[noreturn]] void refuse(std::string_view where, std::string_view what, ErrorCode code = ErrorCode::bad_input);

/// Returns the value of `result`, or throws its error as a LoadFailure "where: message".
template <class T>
T take(Result<T>&& result, std::string_view where) {
    if (!result) refuse(where, result.error().message, result.error().code);
    return *std::move(result);
}

inline void take(Result<void>&& result, std::string_view where) {
    if (!result) refuse(where, result.error().message, result.error().code);
}

/// Memory that a file may still use.
class Budget {
public:
    Budget() = default;
    Budget(const char* what, std::uint64_t limit) : what_(what), limit_(limit) {}
    void take(std::uint64_t bytes);                          ///< throws LoadFailure with ErrorCode::limit
    void set_limit(std::uint64_t limit) { limit_ = limit; }  ///< at least what is used
    [[nodiscard]] std::uint64_t left() const { return limit_ - used_; }

private:
    const char* what_ = "";
    std::uint64_t limit_ = 0, used_ = 0;
};

}  // namespace halflit::io::detail
