#include "sh/time_limit.hpp"

#include <algorithm>

namespace halflit {
namespace {

constexpr TimeLimit::Clock::time_point kNever = TimeLimit::Clock::time_point::max();
thread_local TimeLimit::Bounds current{kNever, nullptr};

TimeLimit::Clock::time_point after(double seconds) {
    constexpr double kLongest = 1e9;  // 30 years
    if (!(seconds > 0.0)) return kNever;
    return TimeLimit::Clock::now() +
           std::chrono::duration_cast<TimeLimit::Clock::duration>(std::chrono::duration<double>(std::min(seconds, kLongest)));
}

bool is_cancelled() { return current.cancelled != nullptr && (*current.cancelled)(); }
bool is_late() { return current.end != kNever && TimeLimit::Clock::now() >= current.end; }

}  // namespace

TimeLimit::TimeLimit(double seconds, const Cancelled* cancelled)
    : TimeLimit(Bounds{std::min(current.end, after(seconds)), cancelled != nullptr && *cancelled ? cancelled : current.cancelled,
                       current.work}) {}
TimeLimit::TimeLimit(const Bounds& bounds) : outer_(current) { current = bounds; }
TimeLimit::~TimeLimit() { current = outer_; }
TimeLimit::Bounds TimeLimit::bounds() { return current; }

namespace {
constexpr std::uint64_t kMostUnits = std::uint64_t{1} << 60;
}  // namespace

WorkLimit::WorkLimit(std::uint64_t units) : left_(static_cast<std::int64_t>(std::min(units, kMostUnits))), outer_(current.work) {
    current.work = units > 0 ? &left_ : nullptr;
}
WorkLimit::~WorkLimit() { current.work = outer_; }

void charge_work(std::uint64_t units) {
    if (current.work == nullptr) return;
    const auto charged = static_cast<std::int64_t>(std::min(units, kMostUnits));
    if (current.work->fetch_sub(charged, std::memory_order_relaxed) < charged) throw OutOfTime{.is_work = true};
}

void grant_work(std::uint64_t units) {
    if (current.work != nullptr) current.work->fetch_add(static_cast<std::int64_t>(std::min(units, kMostUnits)), std::memory_order_relaxed);
}

bool time_is_over() { return is_late() || is_cancelled(); }

void check_time() {
    if (is_cancelled()) throw OutOfTime{.is_cancelled = true};
    if (is_late()) throw OutOfTime{};
}

}  // namespace halflit
