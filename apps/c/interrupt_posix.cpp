#include "apps/c/interrupt_handler.hpp"

#include <csignal>

#include <pthread.h>
#include <unistd.h>

namespace halflit::c {
namespace {

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

}  // namespace

int this_process() { return static_cast<int>(getpid()); }

void begin_counting() {
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

void end_counting() {
    // A handler that was set meanwhile stays.
    struct sigaction now {};
    if (sigaction(SIGINT, nullptr, &now) == 0 && is_note(now)) sigaction(SIGINT, &handler_before, nullptr);
}

}  // namespace halflit::c
