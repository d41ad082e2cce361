// The time limit of a thread's work, and the request to stop it. Long loops call check_time(), which throws OutOfTime once the limit has
// passed or the work is cancelled. The function that set the limit turns this into an error. The limit belongs to the thread, so that loops
// need no parameter for it. Work that moves to other threads takes it along.
#pragma once

#include "halflit/export.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>

namespace halflit {

/// Thrown by check_time().
struct HALFLIT_API OutOfTime {
    bool is_cancelled = false;  ///< cancelled before the time was over
    bool is_work = false;       ///< thrown by charge_work()
};

/// Sets a time limit for this thread while the object lives, and what may cancel its work.
class [[nodiscard]] TimeLimit {
public:
    using Clock = std::chrono::steady_clock;

    /// Asked by check_time(), from any thread that takes the limit along; true: the work ends.
    using Cancelled = std::function<bool()>;
    /// A limit that can be taken to another thread.
    struct Bounds {
        Clock::time_point end;                      ///< the largest time point: none
        const Cancelled* cancelled;                 ///< null: nothing cancels
        std::atomic<std::int64_t>* work = nullptr;  ///< what is left of a WorkLimit; null: none
    };

    /// The earliest of nested limits holds. 0: no limit of its own. cancelled: in place of the outer one, which stays if it is null or
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

/// Sets a limit for the work that this thread, and those that take its time limit along, do while the object lives. It is counted, not
/// measured, so that it ends the same work everywhere: long steps whose length a file decides say it by charge_work(). A unit is about a
/// nanosecond of one core. The limit replaces that of outer calls.
class [[nodiscard]] WorkLimit {
public:
    HALFLIT_API explicit WorkLimit(std::uint64_t units);  ///< 0: no limit
    HALFLIT_API ~WorkLimit();
    WorkLimit(const WorkLimit&) = delete;
    WorkLimit& operator=(const WorkLimit&) = delete;

private:
    std::atomic<std::int64_t> left_;
    std::atomic<std::int64_t>* outer_;
};

/// Says that work of so many units follows. Throws OutOfTime beyond the limit. About 5 ns.
HALFLIT_API void charge_work(std::uint64_t units);
/// Raises the limit: there is more to read.
HALFLIT_API void grant_work(std::uint64_t units);

/// True if this thread's limit is over or its work is cancelled.
[[nodiscard]] HALFLIT_API bool time_is_over();

/// Throws OutOfTime if this thread's limit is over or its work is cancelled. Takes about 30 ns with a limit, 2 ns without, and the time of
/// the caller's function.
HALFLIT_API void check_time();

/// Asks for the time once in 65,536 calls, and charges their work: for loops whose steps take nanoseconds.
class TimeCheck {
public:
    void operator()() {
        if (++steps_ % kSteps != 0) return;
        check_time();
        charge_work(kUnitsAStep * kSteps);
    }

private:
    static constexpr std::uint32_t kSteps = 65536, kUnitsAStep = 12;
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
inline constexpr const char *kOutOfTime = "the time limit was reached before the work was done", *kCancelled = "stopped on request",
                            *kOutOfWork = "takes more work than max_work allows";

}  // namespace halflit
