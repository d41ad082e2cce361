// The boundary of the library: sets the floating-point environment and lets no exception through.
#pragma once

#include "halflit/error.hpp"
#include "raster/detail/executor.hpp"
#include "raster/detail/stop_signal.hpp"
#include "sh/fp_environment.hpp"
#include "sh/time_limit.hpp"
#include "shading/out_of_time.hpp"

#include <exception>
#include <new>
#include <string>
#include <utility>

namespace halflit::raster {

/// Returns what `body` returns, a Result, within the time limit of `execution` and until it is cancelled. An exception becomes an error;
/// `doing` completes the message "out of memory while ...".
template <class Body>
auto guarded(const char* doing, const Execution& execution, const Body& body) -> decltype(body()) {
    const FpEnvironment environment;
    const TimeLimit limit(execution.time_limit_s, &execution.cancelled);
    try {
        try {
            return body();
        } catch (const std::bad_alloc&) {
            return fail(ErrorCode::limit, std::string("out of memory while ") + doing);
        } catch (const OutOfTime& found) {
            return fail_out_of_time(found);
        } catch (Stopped& stopped) {
            return tl::unexpected(std::move(stopped.error));
        } catch (const WrongLoop& e) {
            return fail(ErrorCode::usage, e.what());
        } catch (const std::exception& e) {
            return fail(ErrorCode::internal, e.what());
        } catch (...) {
            return fail(ErrorCode::internal, std::string("a function of the caller threw an exception while ") + doing);
        }
    } catch (const std::bad_alloc&) {  // of the message; this one needs no memory
        return fail(ErrorCode::limit, "out of memory");
    }
}

}  // namespace halflit::raster
