#include "apps/c/interrupt.hpp"

#include <halflit/halflit.h>

#include <atomic>
#include <csignal>
#include <thread>

#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#include <unistd.h>
#endif

namespace halflit::c {
namespace {

/// Signals of this process. It wraps around: a watch asks whether it has changed.
std::atomic<std::uint32_t> interrupts{0};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);  // the signal's handler writes it

/// The process whose thread changes the handlers; 0: none does.
std::atomic<int> changing_process{0};
int watches = 0;
int process_of_watches = 0;  ///< a forked process has no frames of its parent's threads, but its handler

#if defined(__unix__) || defined(__APPLE__)

int this_process() { return static_cast<int>(getpid()); }

struct sigaction handler_before;
// The same for the signal's handler, which may run while another thread changes it. At most one is null but while they change.
std::atomic<void (*)(int)> plain_before{nullptr};
std::atomic<void (*)(int, siginfo_t*, void*)> full_before{nullptr};
/// The thread that runs the handler before. That handler may call the one before itself, which may be ours.
std::atomic<pthread_t> calling{};
static_assert(std::atomic<pthread_t>::is_always_lock_free);

void note(int signal, siginfo_t* info, void* context) {
    const pthread_t self = pthread_self();
    ++interrupts;
    if (calling == self) return;
    const pthread_t before = calling.exchange(self);
    if (const auto full = full_before.load())
        full(signal, info, context);
    else if (const auto plain = plain_before.load())
        plain(signal);
    calling = before;
}

bool has_info(const struct sigaction& action) { return (action.sa_flags & SA_SIGINFO) != 0; }
bool is_note(const struct sigaction& action) { return has_info(action) && action.sa_sigaction == note; }
bool is(const struct sigaction& action, void (*handler)(int)) { return !has_info(action) && action.sa_handler == handler; }

void begin() {
    calling = pthread_t{};  // a handler that jumps out of itself leaves it
    struct sigaction now {};
    if (sigaction(SIGINT, nullptr, &now) != 0 || is_note(now) || is(now, SIG_IGN)) return;
    handler_before = now;
    if (has_info(now)) {
        full_before = now.sa_sigaction;
        plain_before = nullptr;
    } else {
        plain_before = is(now, SIG_DFL) ? nullptr : now.sa_handler;
        full_before = nullptr;
    }
    // Keeps the mask and the flags of the handler before, so that interrupted system calls end as the process expects.
    struct sigaction ours = now;
    ours.sa_sigaction = note;
    ours.sa_flags = (now.sa_flags | SA_SIGINFO) & ~static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &ours, nullptr);
}

void end() {
    // A handler that was set meanwhile stays.
    struct sigaction now {};
    if (sigaction(SIGINT, nullptr, &now) == 0 && is_note(now)) sigaction(SIGINT, &handler_before, nullptr);
}

#else

int this_process() { return 1; }

std::atomic<void (*)(int)> handler_before{SIG_DFL};

void note(int signal) {
    std::signal(SIGINT, note);  // some systems reset it
    ++interrupts;
    const auto before = handler_before.load();
    if (before != SIG_DFL && before != SIG_IGN && before != SIG_ERR) before(signal);
}

void begin() {
    const auto now = std::signal(SIGINT, note);
    if (now == SIG_IGN)
        std::signal(SIGINT, SIG_IGN);
    else if (now != note && now != SIG_ERR)
        handler_before = now;
}

void end() {
    // A handler that was set meanwhile stays.
    const auto now = std::signal(SIGINT, handler_before);
    if (now != note && now != SIG_ERR) std::signal(SIGINT, now);
}

#endif

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
    begin();  // a handler may have been set while another watch lives
}

InterruptWatch::~InterruptWatch() {
    if (!is_wanted_ || process_ != this_process()) return;
    const Changing changing;
    if (--watches == 0) end();
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
