#include "apps/halflit/program/interrupt.hpp"

#include "apps/halflit/program/messages.hpp"
#include "apps/io/files/atomic_file.hpp"
#include "apps/io/platform/process.hpp"

#include <mutex>
#include <string>
#include <utility>

namespace halflit::cli {
namespace {

std::mutex last_words_mutex;
std::function<void(int)> last_words;

void say_last_words(int signal) {
    io::abandon_files();
    print_error("interrupted by signal " + std::to_string(signal));
    // Never unlocked: a thread that calls set_last_words now waits until the process ends.
    last_words_mutex.lock();
    if (last_words) last_words(signal);
}

}  // namespace

void handle_signals() { platform::call_before_end(say_last_words); }

void set_last_words(std::function<void(int signal)> words) {
    const std::lock_guard lock(last_words_mutex);
    last_words = std::move(words);
}

}  // namespace halflit::cli
