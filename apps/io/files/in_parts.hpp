// Long loops on several threads.
#pragma once

#include "sh/available_cores.hpp"
#include "sh/fp_environment.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace halflit::io::detail {

/// Threads that LoadOptions::threads allows.
inline std::size_t allowed_threads(int threads) {
    return threads > 0 ? static_cast<std::size_t>(threads) : static_cast<std::size_t>(available_cores());
}

/// Parts that loops of `count` steps are done in, on as many threads: threads, 0 for one per core; each part has at least `least` steps.
inline std::size_t parts_of(std::size_t count, std::size_t least, int threads) {
    return std::max<std::size_t>(1, std::min(allowed_threads(threads), count / least));
}

/// Calls body(part, begin, end) for the parts of [0, count), in order of their steps but side by side, within this thread's time limit.
/// Throws the exception of the first part that has one.
template <class Body>
void in_parts(std::size_t count, std::size_t parts, const Body& body) {
    std::vector<std::exception_ptr> failures(parts);
    const auto run = [&](std::size_t part) {
        try {
            body(part, count * part / parts, count * (part + 1) / parts);
        } catch (...) {
            failures[part] = std::current_exception();
        }
    };
    {
        std::vector<std::jthread> threads;  // end before what they use
        threads.reserve(parts);
        std::size_t begun = 1;
        try {
            for (; begun < parts; ++begun)
                threads.emplace_back([&run, begun, bounds = TimeLimit::bounds()] {
                    const FpEnvironment environment_of_host;
                    const TimeLimit limit(bounds);
                    run(begun);
                });
        } catch (const std::system_error&) {  // no more threads: this one does the rest
        }
        run(0);
        for (; begun < parts; ++begun) run(begun);
    }
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
}

}  // namespace halflit::io::detail
