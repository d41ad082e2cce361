// The error of a call that found no memory, made without memory.
#pragma once

#include "halflit/error.hpp"

#include <new>

namespace halflit {

/// `message()` makes the message; where there is no memory for it, a short one, which a std::string holds without allocating, takes its
/// place.
template <class Message>
[[nodiscard]] tl::unexpected<Error> fail_out_of_memory(const Message& message) noexcept {
    try {
        return fail(ErrorCode::limit, message());
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::limit, "out of memory");
    }
}

}  // namespace halflit
