// Handling of SIGINT, SIGTERM and SIGHUP. A thread of its own takes them, so that they work at once in every stage: while a file is read,
// or a picture is drawn or encoded.
#pragma once

#include <functional>

namespace halflit::cli {

/// Call once, before any other thread starts. From then on, an interrupted program removes its temporary files, calls the function of
/// set_last_words, and ends by the signal's default action; a shell shows that as exit code 128 + the signal's number. A signal that the
/// parent process ignores stays ignored. A closed pipe and a file size limit become errors of write() instead of signals.
void handle_signals();

/// Sets the function to call before a signal ends the process; `signal` is the signal's number. It runs on the signal thread, so it must
/// own all that it uses.
void set_last_words(std::function<void(int signal)> last_words);

}  // namespace halflit::cli
