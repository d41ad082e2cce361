#include "apps/c/boundary.hpp"

#include <cstdio>
#include <string>

namespace halflit::c {
namespace {

/// A fixed array: a message must not require memory, which may be what is lacking. Longer messages are cut.
thread_local char message_of_thread[2048] = "";

}  // namespace

std::int32_t record_failure(ErrorCode code, const char* function, const char* message) noexcept {
    std::snprintf(message_of_thread, sizeof message_of_thread, "%s%s%s", function, *function != '\0' ? ": " : "", message);
    return static_cast<std::int32_t>(code);
}

const char* last_failure() noexcept { return message_of_thread; }

Result<void> check_pointers(const char* function, std::initializer_list<Pointer> pointers) {
    for (const Pointer& pointer : pointers)
        if (pointer.value == nullptr) return fail(ErrorCode::usage, std::string(function) + ": " + pointer.name + " is null");
    return {};
}

}  // namespace halflit::c
