// Programs of others that turn bytes into bytes, with as few rights as the system can take from them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace halflit::platform {

struct ChildLimits {
    std::size_t memory_bytes = 0;  ///< addresses of its own
    std::size_t output_bytes = 0;
    unsigned cpu_s = 0;  ///< seconds of processor time
};

struct ChildResult {
    enum class End : std::uint8_t { code, signal, out_of_time, too_much_output, not_started };
    End end = End::not_started;
    int number = 0;  ///< exit code or signal; errno if it did not start
    std::vector<std::byte> output;
    std::string messages;  ///< of its standard error, at most 4 kB of its end
};

/// True where programs can be run: on Linux and other systems of POSIX, but not in a page.
[[nodiscard]] bool can_run_children();

/// Runs a program, words[0] of which is its path, with `input` as a file on its standard input, and takes what it writes to its standard
/// output. It has no other open files, no terminal, and hardly any environment. It cannot write to files or dump its memory; on Linux it
/// starts no processes, opens no sockets (seccomp), and reads the system's programs and libraries and its own folder alone (Landlock),
/// where the kernel has them. It and what it may have started end with this call, also if check_time() throws: that is asked fifty times a
/// second.
[[nodiscard]] ChildResult run_confined(const std::vector<std::string>& words, std::span<const std::byte> input, const ChildLimits& limits);

/// Folder of the program or the shared library that this function is in; empty: not known.
[[nodiscard]] std::string own_folder();

}  // namespace halflit::platform
