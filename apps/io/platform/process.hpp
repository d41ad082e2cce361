// The process and its machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace halflit::platform {

/// Words of the command line after the program's name, as UTF-8. On Windows '\\' becomes '/', so that a path has one form.
[[nodiscard]] std::vector<std::string> arguments(int argc, char** argv);

[[nodiscard]] std::int64_t process_id();
/// False if it is known that no process has this number.
[[nodiscard]] bool may_be_running(std::int64_t process);
/// The most physical memory that the process has held, in bytes.
[[nodiscard]] std::int64_t peak_memory();
/// The limit of a thread's stack in bytes; 0: none, or it is not told.
[[nodiscard]] std::size_t stack_limit();
/// From now on, an allocation fails that would take the process beyond this. A lower limit that it has already stays. Returns 0 or errno.
[[nodiscard]] int limit_memory(std::size_t bytes);

/// Keeps freed memory, and asks for pages of 2 MB. To be called once, before a scene is loaded; later calls do nothing. Otherwise memory of
/// more than 128 kB is returned to the system and taken anew, and page faults, one for each 4 kB, take a fifth of the time to draw a model.
/// With glibc on Linux alone. Takes about 3 MB more. Nothing is done where the process has a limit of memory, as 128 MB of addresses are
/// reserved, which would count; so not for a process that sets one later.
void prepare_heap();

/// Gives the memory of whole pages within [begin, begin + bytes) back to the system: what is read there afterwards is 0. With glibc on
/// Linux alone; elsewhere nothing happens.
void give_back(std::byte* begin, std::size_t bytes);

/// "Linux 6.1.0 x86_64, Debian GNU/Linux 12 (bookworm)"
[[nodiscard]] std::string system_name();
/// Empty where the system does not tell it.
[[nodiscard]] std::string processor_name();

/// Before a signal ends the process (Ctrl-C, and the system's wish that it ends), a thread of its own calls `last_words` with the signal's
/// number, and ends the process as the signal does: a shell shows exit code 128 + the number. Call once, before any other thread starts. A
/// signal that the parent process ignores stays ignored. A closed pipe and a file size limit become errors of writing instead of signals.
void call_before_end(void (*last_words)(int signal));
[[noreturn]] void wait_for_end();

}  // namespace halflit::platform
