// The end of a call before its work is done: the caller cancels, or the call's time or memory is used up.
#pragma once

#include "halflit/error.hpp"
#include "halflit/settings.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>

namespace halflit::raster {

/// Thrown to end a call; guarded() returns the error.
struct Stopped {
    Error error;
};

/// The same for a lack of memory.
struct MemoryStopped : Stopped {};

class StopSignal {
public:
    /// Begins a call. The functions of `execution` must live until the call ends.
    void arm(const Execution& execution);

    /// True once the call is to end. Any thread may ask; asks the caller's `cancelled` and the clock.
    [[nodiscard]] bool raised();
    /// Throws Stopped if the signal is raised.
    void check();

    /// Working memory that the call holds. Throws Stopped, without counting, beyond the limit.
    void take_memory(std::size_t bytes);
    [[nodiscard]] std::size_t memory_limit() const { return memory_limit_; }  ///< of the call; 0: none
    [[nodiscard]] std::size_t memory() const { return memory_.load(std::memory_order_relaxed); }
    void give_memory(std::size_t bytes) { memory_.fetch_sub(bytes, std::memory_order_relaxed); }

private:
    enum Reason : int { none, cancelled, time };
    const std::function<bool()>* cancelled_ = nullptr;
    std::chrono::steady_clock::time_point deadline_{};
    double time_limit_s_ = 0.0;
    std::size_t memory_limit_ = 0;  ///< 0: none
    std::atomic<int> reason_{none};
    std::atomic<std::size_t> memory_{0};
};

/// Bytes that one holder has taken of a call's memory; given back by its destructor.
class MemoryShare {
public:
    MemoryShare() = default;
    ~MemoryShare() { release(); }
    MemoryShare(const MemoryShare&) = delete;
    MemoryShare& operator=(const MemoryShare&) = delete;

    /// Changes what is held. Throws Stopped, with what was held before, beyond the limit. The signal must outlive the share.
    void hold(StopSignal& signal, std::size_t bytes) {
        if (bytes > bytes_)
            signal.take_memory(bytes - bytes_);
        else
            signal.give_memory(bytes_ - bytes);
        signal_ = &signal;
        bytes_ = bytes;
    }

private:
    void release() {
        if (signal_ != nullptr) signal_->give_memory(bytes_);
    }
    StopSignal* signal_ = nullptr;
    std::size_t bytes_ = 0;
};

}  // namespace halflit::raster
