// Hook for a host's own threads.
#pragma once

#include <functional>

namespace halflit::raster {

/// Runs body(i) for every i in [0, count), in any order, on any threads, and returns when all are done.
using ParallelFor = std::function<void(int count, const std::function<void(int)>& body)>;

/// Threads that do the work. Neither member changes a result.
struct Workers {
    int threads = 0;             ///< 0: one per core
    ParallelFor parallel_for{};  ///< empty: oneTBB, or the standard library's threads if built without it
};

}  // namespace halflit::raster
