// Errors. A call that can fail returns a Result, and no exception leaves it. A call without a Result may throw std::bad_alloc alone.
#pragma once

#include <tl/expected.hpp>

#include <string>

namespace halflit {

/// Reason why a call failed. The numbers are the exit codes of the command line.
enum class ErrorCode {
    negative_result = 1,  ///< the command line alone: the answer is no
    usage = 2,            ///< an argument out of range, or two that exclude each other
    bad_input = 3,        ///< a damaged file or a faulty scene
    io = 4,               ///< a file that cannot be read or written
    limit = 5,            ///< a limit was hit, or the memory is full
    internal = 6,         ///< a fault of the library
    cancelled = 7         ///< Execution::cancelled stopped the frame
};

/// Reason of a failure: the code is for the program, the message for its user.
struct Error {
    ErrorCode code = ErrorCode::bad_input;  ///< kind of failure
    std::string message;                    ///< "FILE: place: what was found, what was expected"; one line, UTF-8, no trailing full stop
};

/// A value, or an Error: `if (!result) report(result.error().message); else use(*result);`
template <class T>
using Result = tl::expected<T, Error>;

/// The error of a function that returns a Result: `return fail(ErrorCode::usage, "..");`
[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
    return tl::unexpected<Error>(Error{code, static_cast<std::string&&>(message)});
}

}  // namespace halflit
