// Threads: oneTBB's, the standard library's where halflit is built without oneTBB, or the host's own loop.
#pragma once

#include "raster/parallel_for.hpp"

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace halflit::raster {

/// Runs loops of a frame. Every task runs in the library's floating-point environment. The first exception of a task
/// (only memory can run out) is rethrown by `run`.
class Executor {
public:
    Executor();
    ~Executor();
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    /// threads: 0 for one a core. An empty hook means the threads of this build.
    void configure(int threads, const ParallelFor& hook);
    [[nodiscard]] int threads() const { return threads_; }
    void run(int count, const std::function<void(int)>& body);

private:
    struct Arena;
    std::unique_ptr<Arena> arena_;
    ParallelFor hook_;
    int threads_ = 1;
};

/// Working memory lent to one task at a time; grows to as many as ran at once.
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
        const std::lock_guard lock(mutex_);
        free_.push_back(std::move(item));
    }

    std::mutex mutex_;
    std::vector<std::unique_ptr<T>> free_;
};

}  // namespace halflit::raster
