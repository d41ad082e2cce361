#include "apps/c/interrupt_handler.hpp"

#include <csignal>

#ifndef NOMINMAX
#define NOMINMAX
#endif
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

namespace halflit::c {
namespace {

using Handler = void (*)(int);
using SetHandler = Handler(CDECL*)(int, Handler);

/// A process may have two C libraries, each with its own handler of Ctrl-C: that of this library, and the Universal C Runtime that Python
/// uses. Windows asks them in turn, the last one first, until one has a handler.
SetHandler set_in_other_library() {
    const HMODULE library = GetModuleHandleW(L"ucrtbase.dll");
    const auto found = library != nullptr ? GetProcAddress(library, "signal") : nullptr;
    return reinterpret_cast<SetHandler>(reinterpret_cast<void (*)()>(found));
}

std::atomic<SetHandler> set_handler{std::signal};  ///< of the library whose handler was replaced
std::atomic<Handler> handler_before{SIG_DFL};

void note(int signal) {
    set_handler.load()(SIGINT, note);  // it was reset
    ++interrupts;
    const Handler before = handler_before.load();
    if (before != SIG_DFL && before != SIG_IGN && before != SIG_ERR) before(signal);
}

/// False where the library has no handler of the process, so that the other one may have it.
bool begin_in(SetHandler set, bool also_without) {
    set_handler = set;
    const Handler now = set(SIGINT, note);
    if (now == SIG_ERR) return false;
    if (now == SIG_DFL && !also_without) {
        set(SIGINT, SIG_DFL);
        return false;
    }
    if (now == SIG_IGN)
        set(SIGINT, SIG_IGN);
    else if (now != note)
        handler_before = now;
    return true;
}

}  // namespace

int this_process() { return 1; }  // it has no forks

void begin_counting() {
    const SetHandler other = set_in_other_library();
    if (other != nullptr && begin_in(other, false)) return;
    (void)begin_in(std::signal, true);
}

void end_counting() {
    const SetHandler set = set_handler;
    const Handler now = set(SIGINT, handler_before);
    if (now != note && now != SIG_ERR) set(SIGINT, now);
}

}  // namespace halflit::c
