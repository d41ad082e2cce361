// Long tests on all cores.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace halflit::test {

/// Calls body(i) for every i in [0, count), in any order, on as many threads as there are cores. Catch2's assertions are not thread-safe:
/// the body collects results, and the caller checks them.
template <class Body>
void on_all_cores(std::int64_t count, const Body& body) {
    std::atomic<std::int64_t> next{0};
    std::vector<std::jthread> threads;
    for (unsigned t = 0; t == 0 || t < std::thread::hardware_concurrency(); ++t)
        threads.emplace_back([&] {
            for (std::int64_t i = next++; i < count; i = next++) body(i);
        });
}

}  // namespace halflit::test
