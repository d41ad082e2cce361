// The boundary of the library: sets the floating-point environment and lets no exception through.
#pragma once

#include "halflit/error.hpp"
#include "raster/detail/executor.hpp"
#include "raster/detail/fp_environment.hpp"
#include "raster/detail/stop_signal.hpp"

#include <exception>
#include <new>
#include <string>
#include <utility>

namespace halflit::raster {

/// Returns what `body` returns, a Result. An exception becomes an error; `doing` completes the message "out of memory while ...".
template <class Body>
auto guarded(const char* doing, const Body& body) -> decltype(body()) {
    const FpEnvironment environment;
    try {
        try {
            return body();
        } catch (const std::bad_alloc&) {
            return fail(ErrorCode::limit, std::string("out of memory while ") + doing);
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
