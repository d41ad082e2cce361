// The time limit of a thread's work, and the request to stop it. Long loops call check_time(), which throws OutOfTime once the limit has
// passed or the work is cancelled. The function that set the limit turns this into an error. The limit belongs to the thread, so that loops
// need no parameter for it. Work that moves to other threads takes it along.
#pragma once

#include "halflit/export.hpp"

#include <chrono>
#include <cstdint>
#include <functional>

namespace halflit {

/// Thrown by check_time().
struct HALFLIT_API OutOfTime {
    bool is_cancelled = false;  ///< cancelled before the time was over
};

/// Sets a time limit for this thread while the object lives, and what may cancel its work.
class [[nodiscard]] TimeLimit {
public:
    using Clock = std::chrono::steady_clock;

    /// Asked by check_time(), from any thread that takes the limit along; true: the work ends.
    using Cancelled = std::function<bool()>;
    /// A limit that can be taken to another thread.
    struct Bounds {
        Clock::time_point end;       ///< the largest time point: none
        const Cancelled* cancelled;  ///< null: nothing cancels
    };

    /// Of nested limits the earlier one holds. 0: no limit of its own. cancelled: in place of the outer one, which stays if it is null or
    /// empty. It has to outlive this object.
    HALFLIT_API explicit TimeLimit(double seconds, const Cancelled* cancelled = nullptr);
    /// For work that began on another thread, with its limit. It replaces this thread's limit, which may belong to other work.
    HALFLIT_API explicit TimeLimit(const Bounds& bounds);
    HALFLIT_API ~TimeLimit();
    TimeLimit(const TimeLimit&) = delete;
    TimeLimit& operator=(const TimeLimit&) = delete;

    /// This thread's limit.
    [[nodiscard]] HALFLIT_API static Bounds bounds();

private:
    Bounds outer_;
};

/// True if this thread's limit is over or its work is cancelled.
[[nodiscard]] HALFLIT_API bool time_is_over();

/// Throws OutOfTime if this thread's limit is over or its work is cancelled. Takes about 30 ns with a limit, 2 ns without, and the time of
/// the caller's function.
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

/// Messages of the errors for work that OutOfTime ended.
inline constexpr const char *kOutOfTime = "the time limit was reached before the work was done", *kCancelled = "stopped on request";

}  // namespace halflit
