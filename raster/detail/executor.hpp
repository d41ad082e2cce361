// Threads: the process's own, or the host's loop.
#pragma once

#include "halflit/settings.hpp"
#include "raster/detail/stop_signal.hpp"

#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

namespace halflit::raster {

/// Thrown where a host's loop did not run every item once.
class WrongLoop : public std::exception {
public:
    explicit WrongLoop(const char* what) : what_(what) {}
    [[nodiscard]] const char* what() const noexcept override { return what_; }

private:
    const char* what_;
};

/// Runs the parallel loops of a call. Every task runs in the library's floating-point environment. `run` rethrows the first exception of a
/// task: a lack of memory, or an exception of one of the host's functions. It throws Stopped if the call is to end before its work is done.
class Executor {
public:
    Executor() = default;
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    /// Begins a call: takes its threads, its loop and its limits.
    void configure(const Execution& execution);
    /// Number of threads that run. 0 with a host's loop, whose threads are not known.
    [[nodiscard]] int threads() const { return hook_ ? 0 : threads_; }
    void run(int count, const std::function<void(int)>& body);
    /// For tasks that take long: they check it now and then.
    [[nodiscard]] StopSignal& stop() { return stop_; }

private:
    ParallelFor hook_;
    int threads_ = 1;
    StopSignal stop_;
};

/// Pool of working memory. An item is lent to one task at a time; the pool grows to the largest number of tasks that ran at once.
template <class T>
class Pool {
public:
    class Loan {
    public:
        explicit Loan(Pool& pool) : pool_(pool), item_(pool.take()) {}
        ~Loan() { pool_.give(std::move(item_)); }
        Loan(const Loan&) = delete;
        Loan& operator=(const Loan&) = delete;
        T& operator*() { return *item_; }
        T* operator->() { return item_.get(); }

    private:
        Pool& pool_;
        std::unique_ptr<T> item_;
    };

private:
    std::unique_ptr<T> take() {
        {
            const std::lock_guard lock(mutex_);
            if (!free_.empty()) {
                std::unique_ptr<T> item = std::move(free_.back());
                free_.pop_back();
                return item;
            }
        }
        return std::make_unique<T>();
    }
    void give(std::unique_ptr<T> item) {
        // Runs in a destructor, where an exception would end the process. Without memory for the list, the item is dropped.
        try {
            const std::lock_guard lock(mutex_);
            free_.push_back(std::move(item));
        } catch (const std::bad_alloc&) {
        }
    }

    std::mutex mutex_;
    std::vector<std::unique_ptr<T>> free_;
};

}  // namespace halflit::raster
