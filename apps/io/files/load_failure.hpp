// Failures of loading: a fault with its place in the model, or a limit reached.
#pragma once

#include "apps/io/files/text.hpp"
#include "halflit/error.hpp"
#include "halflit/model.hpp"
#include "sh/fp_environment.hpp"
#include "sh/time_limit.hpp"
#include "shading/out_of_time.hpp"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <utility>

namespace halflit::io::detail {

/// Thrown inside this folder only; what reads a file returns its Error (errors_of).
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

/// Calls make(), which returns a Result, within a time limit (0: none), and gives its failures and exceptions as errors that begin with the
/// file's name.
template <class Make>
auto errors_of(const std::string& name, double time_limit_s, const Make& make) -> decltype(make()) {
    const FpEnvironment environment_of_host;
    const TimeLimit limit(time_limit_s);
    const auto failed = [&](ErrorCode code, const std::string& message) { return fail(code, printable(name) + ": " + message); };
    try {
        try {
            return make();
        } catch (const LoadFailure& failure) {
            return failed(failure.error.code, failure.error.message);
        } catch (const OutOfTime& found) {
            return fail_out_of_time(found, printable(name) + ": ");
        } catch (const std::bad_alloc&) {
            return failed(ErrorCode::limit, "out of memory");
        } catch (const std::exception& error) {  // a decoder's, or the standard library's
            return failed(ErrorCode::bad_input, printable(error.what()));
        }
    } catch (const std::bad_alloc&) {  // of the message
        return fail(ErrorCode::limit, "out of memory");
    }
}

/// Work that a file of this size may take.
[[nodiscard]] inline std::uint64_t allowed_work(const LoadLimits& limits, std::uint64_t bytes) {
    constexpr std::uint64_t kFree = 1'700'000'000, kByByte = 1'000;
    return limits.max_work > 0 ? limits.max_work : kFree + kByByte * std::min(bytes, std::uint64_t{1} << 48);
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
