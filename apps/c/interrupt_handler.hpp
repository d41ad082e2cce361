// The handler of SIGINT: what differs among systems.
#pragma once

#include <atomic>
#include <cstdint>

namespace halflit::c {

/// Signals of this process. It wraps around: a watch asks whether it has changed.
extern std::atomic<std::uint32_t> interrupts;
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);  // the signal's handler writes it

/// Number of the process; not 0.
[[nodiscard]] int this_process();

/// Puts a handler in front of the process's own that counts the signals; does nothing where it is there, or where the process ignores the
/// signal. One thread calls these two at a time.
void begin_counting();
/// Puts the process's own handler back. One that was set meanwhile stays.
void end_counting();

}  // namespace halflit::c
