// The error of a call that OutOfTime ended.
#pragma once

#include "halflit/error.hpp"
#include "sh/time_limit.hpp"

#include <string>

namespace halflit {

/// before, after: of the message.
[[nodiscard]] inline tl::unexpected<Error> fail_out_of_time(const OutOfTime& found, const std::string& before = "",
                                                            const std::string& after = "") {
    if (found.is_cancelled) return fail(ErrorCode::cancelled, before + kCancelled);
    return fail(ErrorCode::limit, before + (found.is_work ? kOutOfWork : kOutOfTime) + after);
}

}  // namespace halflit
