// The time limit of a thread's work. Long loops call check_time(), which throws OutOfTime once the limit has passed. The function that set
// the limit turns this into an error. The limit belongs to the thread, so that loops need no parameter for it. Work that moves to other
// threads takes it along.
#pragma once

#include "halflit/export.hpp"

#include <chrono>
#include <cstdint>

namespace halflit {

/// Thrown by check_time().
struct HALFLIT_API OutOfTime {};

/// Sets a time limit for this thread while the object lives.
class [[nodiscard]] TimeLimit {
public:
    using Clock = std::chrono::steady_clock;

    /// Of nested limits the earlier one holds. 0: no limit of its own.
    HALFLIT_API explicit TimeLimit(double seconds);
    /// For work that began on another thread, with the end of its limit. It replaces this thread's limit, which may belong to other work.
    HALFLIT_API explicit TimeLimit(Clock::time_point end);
    HALFLIT_API ~TimeLimit();
    TimeLimit(const TimeLimit&) = delete;
    TimeLimit& operator=(const TimeLimit&) = delete;

    /// When this thread's limit ends; the largest time point where it has none.
    [[nodiscard]] HALFLIT_API static Clock::time_point end();

private:
    Clock::time_point outer_;
};

/// True if this thread's limit is over.
[[nodiscard]] HALFLIT_API bool time_is_over();

/// Throws OutOfTime if this thread's limit is over. Takes about 30 ns with a limit, 2 ns without.
HALFLIT_API void check_time();

/// Asks for the time once in 65,536 calls. For loops whose steps take nanoseconds.
class TimeCheck {
public:
    void operator()() {
        if (++steps_ % 65536 == 0) check_time();
    }

private:
    std::uint32_t steps_ = 0;
};

/// A comparison for long sorts, which asks for the time now and then.
template <class Less>
[[nodiscard]] auto timed_less(Less less) {
    return [less, check = TimeCheck()](const auto& a, const auto& b) mutable {
        check();
        return less(a, b);
    };
}

/// Message of the error for work that OutOfTime ended.
inline constexpr const char* kOutOfTime = "the time limit was reached before the work was done";

}  // namespace halflit
