#include "apps/c/interrupt.hpp"

#include "apps/c/interrupt_handler.hpp"

#include <halflit/halflit.h>

#include <atomic>
#include <thread>

namespace halflit::c {

std::atomic<std::uint32_t> interrupts{0};

namespace {

/// The process whose thread changes the handlers; 0: none does.
std::atomic<int> changing_process{0};
int watches = 0;
int process_of_watches = 0;  ///< a forked process has no frames of its parent's threads, but its handler

/// Set by halflit_stop_at_interrupt().
thread_local bool stops_calls = false;

/// One thread changes the handlers at a time. A mutex that another thread holds while the process forks would stay locked in the child.
class Changing {
public:
    Changing() {
        const int self = this_process();
        for (int holder = 0; !changing_process.compare_exchange_weak(holder, self);) {
            if (holder == self) {
                std::this_thread::yield();
                holder = 0;
            }  // otherwise it is 0, or the parent's, whose thread is not here: it is taken over
        }
    }
    ~Changing() { changing_process = 0; }
    Changing(const Changing&) = delete;
    Changing& operator=(const Changing&) = delete;
};

}  // namespace

InterruptWatch::InterruptWatch(bool is_wanted) : is_wanted_(is_wanted) {
    if (!is_wanted) return;
    const Changing changing;
    process_ = this_process();
    if (process_of_watches != process_) watches = 0;
    process_of_watches = process_;
    ++watches;
    start_ = interrupts;
    begin_counting();  // a handler may have been set while another watch lives
}

InterruptWatch::~InterruptWatch() {
    if (!is_wanted_ || process_ != this_process()) return;
    const Changing changing;
    if (--watches == 0) end_counting();
}

bool InterruptWatch::raised() const noexcept { return is_wanted_ && interrupts != start_; }

Execution InterruptWatch::stopping(const Execution& execution) const {
    Execution made = execution;
    if (is_wanted_) made.cancelled = [this, before = execution.cancelled] { return raised() || (before && before()); };
    return made;
}

InterruptibleCall::InterruptibleCall()
    : watch_(stops_calls),
      cancelled_(stops_calls ? TimeLimit::Cancelled([this] { return watch_.raised(); }) : TimeLimit::Cancelled()),
      limit_(0.0, &cancelled_) {}

}  // namespace halflit::c

void halflit_stop_at_interrupt(int32_t stops) { halflit::c::stops_calls = stops != 0; }
