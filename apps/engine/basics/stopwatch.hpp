// Wall-clock time and CPU time.
#pragma once

#include <time.h>

#include <chrono>

namespace halflit::engine {

class Stopwatch {
public:
    /// Milliseconds since construction.
    [[nodiscard]] double ms() const { return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// CPU time of all threads of the process. On a busy machine it varies less than wall-clock time.
class CpuStopwatch {
public:
    /// Where that is less than a step of the system's clock, which takes 16 ms on Windows: the wall-clock time.
    [[nodiscard]] double ms() const {
        const double cpu_ms = now_ms() - start_ms_;
        return cpu_ms > 0.0 ? cpu_ms : wall_.ms();
    }

private:
    static double now_ms() {
        struct timespec now {};
        ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
        return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
    }
    double start_ms_ = now_ms();
    Stopwatch wall_;
};

}  // namespace halflit::engine
