// --timeout: the time limit of all that a command does for one scene.
#pragma once

#include "halflit/error.hpp"
#include "sh/time_limit.hpp"
#include "shading/out_of_time.hpp"

namespace halflit::engine {

/// Returns what `body` returns, a Result, or a limit error if it takes longer. 0: no limit.
template <class Body>
auto within_time(double timeout_s, const Body& body) -> decltype(body()) {
    const TimeLimit limit(timeout_s);
    try {
        return body();
    } catch (const OutOfTime& found) {
        return fail_out_of_time(found, "", " (--timeout)");
    }
}

}  // namespace halflit::engine
