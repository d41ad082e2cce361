#include "raster/detail/stop_signal.hpp"

#include "sh/time_limit.hpp"

#include <string>

namespace halflit::raster {

void StopSignal::arm(const Execution& execution) {
    cancelled_ = execution.cancelled ? &execution.cancelled : nullptr;
    time_limit_s_ = execution.time_limit_s;
    memory_limit_ = execution.memory_limit;
    reason_ = none;
    if (time_limit_s_ > 0.0) {
        const auto limit = std::chrono::duration<double>(time_limit_s_ < 1e9 ? time_limit_s_ : 1e9);
        deadline_ = std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(limit);
    }
}

bool StopSignal::raised() {
    if (reason_.load(std::memory_order_relaxed) != none) return true;
    const Reason found = cancelled_ != nullptr && (*cancelled_)()                               ? cancelled
                         : time_limit_s_ > 0.0 && std::chrono::steady_clock::now() >= deadline_ ? time
                                                                                                : none;
    if (found == none) return false;
    int first = none;
    reason_.compare_exchange_strong(first, found);  // the first reason stays
    return true;
}

void StopSignal::check() {
    if (!raised()) return;
    if (reason_ == cancelled) throw Stopped{{ErrorCode::cancelled, kCancelled}};
    throw Stopped{{ErrorCode::limit, kOutOfTime}};
}

void StopSignal::take_memory(std::size_t bytes) {
    const std::size_t before = memory_.fetch_add(bytes, std::memory_order_relaxed);
    if (memory_limit_ == 0 || before + bytes <= memory_limit_) return;
    memory_.fetch_sub(bytes, std::memory_order_relaxed);
    throw MemoryStopped{
        {{ErrorCode::limit, "drawing needs more than " + std::to_string(memory_limit_) + " bytes of working memory, which is the limit"}}};
}

}  // namespace halflit::raster
