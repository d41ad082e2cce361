// Threads as a host hands them in.
#pragma once

#include <functional>

namespace halflit::raster {

/// Runs body(i) for every i in [0, count), in any order, on any threads, and returns when all are done.
using ParallelFor = std::function<void(int count, const std::function<void(int)>& body)>;

/// Who does the work. Neither changes a result.
struct Workers {
    int threads = 0;             ///< 0: one a core
    ParallelFor parallel_for{};  ///< the hook for a host's own threads; empty: oneTBB
};

}  // namespace halflit::raster
