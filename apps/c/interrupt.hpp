// The signal of Ctrl-C, which ends a frame or a call.
#pragma once

#include "halflit/settings.hpp"
#include "sh/time_limit.hpp"

#include <cstdint>

namespace halflit::c {

/// While one lives, SIGINT is counted before the process's own handler runs. The last one puts that handler back. A process that ignores
/// the signal goes on doing so. It moves neither to another process nor to another thread: a forked child has none.
class InterruptWatch {
public:
    /// is_wanted: otherwise it does nothing.
    explicit InterruptWatch(bool is_wanted);
    ~InterruptWatch();
    InterruptWatch(const InterruptWatch&) = delete;
    InterruptWatch& operator=(const InterruptWatch&) = delete;

    /// The signal came since this watch began.
    [[nodiscard]] bool raised() const noexcept;
    /// The same execution, which stops when raised() too. The watch has to outlive it.
    [[nodiscard]] Execution stopping(const Execution& execution) const;

private:
    bool is_wanted_;
    std::uint32_t start_ = 0;  ///< number of signals
    int process_ = 0;
};

/// While it lives, SIGINT cancels the thread's work (sh/time_limit.hpp), if halflit_stop_at_interrupt(1) was called.
class InterruptibleCall {
public:
    InterruptibleCall();
    InterruptibleCall(const InterruptibleCall&) = delete;
    InterruptibleCall& operator=(const InterruptibleCall&) = delete;

private:
    InterruptWatch watch_;
    TimeLimit::Cancelled cancelled_;
    TimeLimit limit_;
};

}  // namespace halflit::c
