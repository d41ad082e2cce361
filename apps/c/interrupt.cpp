#include "apps/c/interrupt.hpp"

#include <atomic>
#include <csignal>
#include <mutex>

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

namespace halflit::c {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // the signal's handler writes it

std::mutex watching;  ///< guards the handlers
int watches = 0;

#if defined(__unix__) || defined(__APPLE__)

struct sigaction handler_before;
pid_t process = 0;  ///< that `watches` counts in: a forked one has no frames of its parent's threads, but its handler

void note(int signal, siginfo_t* info, void* context) {
    interrupted = true;
    if ((handler_before.sa_flags & SA_SIGINFO) != 0)
        handler_before.sa_sigaction(signal, info, context);
    else if (handler_before.sa_handler != SIG_DFL && handler_before.sa_handler != SIG_IGN)
        handler_before.sa_handler(signal);
}

bool is_note(const struct sigaction& action) { return (action.sa_flags & SA_SIGINFO) != 0 && action.sa_sigaction == note; }

void begin() {
    struct sigaction now {};
    if (sigaction(SIGINT, nullptr, &now) != 0 || is_note(now)) return;
    handler_before = now;
    // Keeps the mask and the flags of the handler before, so that interrupted system calls end as the process expects.
    struct sigaction ours = now;
    ours.sa_sigaction = note;
    ours.sa_flags = (handler_before.sa_flags | SA_SIGINFO) & ~static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &ours, nullptr);
}

void end() {
    // A handler that was set meanwhile stays.
    struct sigaction now {};
    if (sigaction(SIGINT, nullptr, &now) == 0 && is_note(now)) sigaction(SIGINT, &handler_before, nullptr);
}

void forget_parent() {
    if (process != getpid()) watches = 0;
    process = getpid();
}

#else

void (*handler_before)(int) = SIG_DFL;

void forget_parent() {}

void note(int signal) {
    std::signal(SIGINT, note);  // some systems reset it
    interrupted = true;
    if (handler_before != SIG_DFL && handler_before != SIG_IGN && handler_before != SIG_ERR) handler_before(signal);
}

void begin() { handler_before = std::signal(SIGINT, note); }

void end() {
    if (handler_before != SIG_ERR) std::signal(SIGINT, handler_before);
}

#endif

}  // namespace

InterruptWatch::InterruptWatch(bool is_wanted) : is_wanted_(is_wanted) {
    if (!is_wanted) return;
    const std::lock_guard lock(watching);
    forget_parent();
    if (watches++ > 0) return;
    interrupted = false;
    begin();
}

InterruptWatch::~InterruptWatch() {
    if (!is_wanted_) return;
    const std::lock_guard lock(watching);
    if (--watches == 0) end();
}

bool InterruptWatch::raised() noexcept { return interrupted; }

}  // namespace halflit::c
