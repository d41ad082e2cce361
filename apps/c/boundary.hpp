// The boundary to C: a Result becomes a code and a message, and no exception passes.
#pragma once

#include "apps/c/interrupt.hpp"
#include "sh/time_limit.hpp"

#include <halflit/error.hpp>

#include <cstdint>
#include <exception>
#include <initializer_list>
#include <new>

namespace halflit::c {

/// Keeps the message for the calling thread. Returns the code.
std::int32_t record_failure(ErrorCode code, const char* function, const char* message) noexcept;

/// The message that the calling thread's last failure left; empty if none failed.
[[nodiscard]] const char* last_failure() noexcept;

/// An argument that must not be null.
struct Pointer {
    const void* value;
    const char* name;
};

/// Fails (usage) if a pointer is null.
[[nodiscard]] Result<void> check_pointers(const char* function, std::initializer_list<Pointer> pointers);

/// Runs `body`, which returns Result<void>, for the function of that name, if none of the pointers is null. Returns the code, 0 for
/// success.
template <class Body>
std::int32_t guarded(const char* function, std::initializer_list<Pointer> pointers, const Body& body) noexcept {
    try {
        const InterruptibleCall call;
        Result<void> done = check_pointers(function, pointers);
        if (done) done = body();
        return done ? 0 : record_failure(done.error().code, "", done.error().message.c_str());
    } catch (const OutOfTime&) {  // no function of C has a time limit outside of what its body calls
        return record_failure(ErrorCode::cancelled, "", kCancelled);
    } catch (const std::bad_alloc&) {
        return record_failure(ErrorCode::limit, function, "out of memory");
    } catch (const std::exception& e) {
        return record_failure(ErrorCode::internal, function, e.what());
    } catch (...) {
        return record_failure(ErrorCode::internal, function, "an unknown exception");
    }
}

}  // namespace halflit::c
