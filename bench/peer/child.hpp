// Measurements in processes of their own: the driver reads its settings once a process, and peak memory is a process's.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <optional>
#include <type_traits>

namespace halflit::peer {

/// Runs `work` in a child and returns what it returned; nothing if the child ended early. To be called before the process has threads.
template <class Work>
auto in_child(const Work& work) -> std::optional<decltype(work())> {
    using Answer = decltype(work());
    static_assert(std::is_trivially_copyable_v<Answer>);
    int ends[2];
    if (pipe(ends) != 0) return std::nullopt;
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        const Answer answer = work();
        const bool sent = write(ends[1], &answer, sizeof answer) == static_cast<ssize_t>(sizeof answer);
        _exit(sent ? 0 : 1);
    }
    close(ends[1]);
    Answer answer;
    char* at = reinterpret_cast<char*>(&answer);
    std::size_t missing = sizeof answer;
    while (missing > 0) {
        const ssize_t got = read(ends[0], at, missing);
        if (got <= 0) break;
        at += got, missing -= static_cast<std::size_t>(got);
    }
    close(ends[0]);
    if (child > 0) waitpid(child, nullptr, 0);
    if (missing > 0) return std::nullopt;
    return answer;
}

/// Filters of llvmpipe. usual: as it comes, trilinear with one level for each 2 x 2 pixels. fast: with the shortcuts that a user may ask
/// for: two levels are mixed near their transition alone, and the footprint is the larger of |du| and |dv|.
enum class PeerFilter { usual, fast };

/// Restricts this process to its first `threads` processors, and llvmpipe to as many threads for rasterization. Its calling thread, which
/// does the geometry, shares these processors. llvmpipe may also run without threads; one thread is at least as fast.
void set_up_process(int threads, PeerFilter filter);

/// Time that passes, or CPU time of this process's threads together, which other programs on the machine disturb less.
enum class Clock { wall, cpu };
[[nodiscard]] double now_ms(Clock clock);
class Stopwatch {
public:
    explicit Stopwatch(Clock clock) : clock_(clock) {}
    /// Milliseconds since the last call, or since construction.
    double lap() {
        const double now = now_ms(clock_), passed = now - last_;
        last_ = now;
        return passed;
    }

private:
    Clock clock_;
    double last_ = now_ms(clock_);
};

/// Memory of this process in megabytes: what it holds now, and the most since reset_peak_memory().
[[nodiscard]] double resident_mb();
[[nodiscard]] double peak_mb();
/// Gives free memory back to the system and begins a new peak.
void reset_peak_memory();

}  // namespace halflit::peer
