// SIGINT, SIGTERM and SIGHUP. They are taken by a thread of their own, so that they work at once in every stage: while a file is read,
// a picture drawn or encoded.
#pragma once

#include <functional>

namespace halflit::cli {

/// Call once, before any other thread starts. From here on an interrupted program removes its temporary files, runs the last words and
/// ends by the same signal with its default action, which a shell shows as 128 + its number. A signal that the parent process
/// had ignored stays ignored. Also makes a closed pipe and a file size limit errors of write() instead of signals.
void handle_signals();

/// What to do before the end; `signal` is the number. Runs on the signal thread: it must own all that it touches.
void set_last_words(std::function<void(int signal)> last_words);

}  // namespace halflit::cli
