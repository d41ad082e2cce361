// Result of a call that can fail because of its input. No exception leaves a module.
#pragma once

#include <tl/expected.hpp>

#include <string>

namespace halflit {

/// Reason why a call failed. The numbers are the exit codes of the command line.
enum class ErrorCode { negative_result = 1, usage = 2, bad_input = 3, io = 4, limit = 5, internal = 6 };

struct Error {
    ErrorCode code = ErrorCode::bad_input;
    std::string message;  ///< "FILE: place: what was found, what was expected"; one line, no trailing full stop
};

template <class T>
using Result = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
    return tl::unexpected<Error>(Error{code, std::move(message)});
}

}  // namespace halflit
