#include "sh/time_limit.hpp"

#include <algorithm>

namespace halflit {
namespace {

constexpr TimeLimit::Clock::time_point kNever = TimeLimit::Clock::time_point::max();
thread_local TimeLimit::Clock::time_point current_end = kNever;

TimeLimit::Clock::time_point after(double seconds) {
    constexpr double kLongest = 1e9;  // 30 years
    if (!(seconds > 0.0)) return kNever;
    return TimeLimit::Clock::now() +
           std::chrono::duration_cast<TimeLimit::Clock::duration>(std::chrono::duration<double>(std::min(seconds, kLongest)));
}

}  // namespace

TimeLimit::TimeLimit(double seconds) : TimeLimit(std::min(current_end, after(seconds))) {}
TimeLimit::TimeLimit(Clock::time_point end) : outer_(current_end) { current_end = end; }
TimeLimit::~TimeLimit() { current_end = outer_; }
TimeLimit::Clock::time_point TimeLimit::end() { return current_end; }

bool time_is_over() { return current_end != kNever && TimeLimit::Clock::now() >= current_end; }

void check_time() {
    if (time_is_over()) throw OutOfTime{};
}

}  // namespace halflit
