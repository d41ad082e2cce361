#include "apps/halflit/program/interrupt.hpp"

#include "apps/halflit/program/messages.hpp"
#include "apps/io/files/atomic_file.hpp"

#include <csignal>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

namespace halflit::cli {
namespace {

std::mutex last_words_mutex;
std::function<void(int)> last_words;

[[noreturn]] void end_by(int signal) {
    std::signal(signal, SIG_DFL);
    sigset_t only;
    sigemptyset(&only);
    sigaddset(&only, signal);
    pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
    std::raise(signal);
    std::_Exit(128 + signal);
}

void wait_for_signal(sigset_t taken) {
    int signal = 0;
    if (sigwait(&taken, &signal) != 0) return;
    io::abandon_files();
    print_error("interrupted by signal " + std::to_string(signal));
    // Never unlocked: a thread that calls set_last_words now waits until the process ends.
    last_words_mutex.lock();
    if (last_words) last_words(signal);
    end_by(signal);
}

}  // namespace

void handle_signals() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    sigset_t taken;
    sigemptyset(&taken);
    bool any = false;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction old {};
        if (sigaction(signal, nullptr, &old) != 0 || old.sa_handler == SIG_IGN) continue;
        sigaddset(&taken, signal);
        any = true;
    }
    if (!any) return;
    pthread_sigmask(SIG_BLOCK, &taken, nullptr);  // inherited by all threads that start later
    try {
        std::thread(wait_for_signal, taken).detach();
    } catch (const std::system_error&) {
        pthread_sigmask(SIG_UNBLOCK, &taken, nullptr);  // the thread could not start: the default action stays
    }
}

void set_last_words(std::function<void(int signal)> words) {
    const std::lock_guard lock(last_words_mutex);
    last_words = std::move(words);
}

}  // namespace halflit::cli
