#include "bench/peer/child.hpp"

#include <malloc.h>
#include <sched.h>
#include <time.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace halflit::peer {
namespace {

double status_mb(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        double kb = 0;
        if (word == key && status >> kb) return kb / 1024;
    }
    return 0;
}

}  // namespace

void set_up_process(int threads, PeerFilter filter) {
    cpu_set_t have, take;
    CPU_ZERO(&take);
    if (sched_getaffinity(0, sizeof have, &have) == 0) {
        for (std::size_t cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&take) < threads; ++cpu)
            if (CPU_ISSET(cpu, &have)) CPU_SET(cpu, &take);
        sched_setaffinity(0, sizeof take, &take);
    }
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    setenv("GALLIVM_PERF", filter == PeerFilter::fast ? "brilinear,rho_approx" : "", 1);
}

double now_ms(Clock clock) {
    timespec now{};
    clock_gettime(clock == Clock::cpu ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double resident_mb() { return status_mb("VmRSS:"); }
double peak_mb() { return status_mb("VmHWM:"); }

void reset_peak_memory() {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
}

}  // namespace halflit::peer
