#include "raster/detail/executor.hpp"

#include "raster/detail/fp_environment.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <exception>

namespace halflit::raster {

struct Executor::Arena {
    explicit Arena(int threads) : arena(threads) {}
    tbb::task_arena arena;
};

Executor::Executor() = default;
Executor::~Executor() = default;

void Executor::configure(int threads, const ParallelFor& hook) {
    hook_ = hook;
    const int wanted = threads > 0 ? threads : static_cast<int>(tbb::this_task_arena::max_concurrency());
    if (arena_ && wanted == threads_) return;
    threads_ = wanted;
    arena_ = threads_ > 1 ? std::make_unique<Arena>(threads_) : nullptr;
}

void Executor::run(int count, const std::function<void(int)>& body) {
    if (hook_) {
        // A host's loop may not carry exceptions across its threads.
        std::exception_ptr failure;
        std::mutex mutex;
        hook_(count, [&](int i) {
            const FpEnvironment environment;
            try {
                body(i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!failure) failure = std::current_exception();
            }
        });
        if (failure) std::rethrow_exception(failure);
        return;
    }
    if (!arena_ || count <= 1) {
        const FpEnvironment environment;
        for (int i = 0; i < count; ++i) body(i);
        return;
    }
    arena_->arena.execute([&] {
        tbb::parallel_for(
            0, count,
            [&](int i) {
                const FpEnvironment environment;
                body(i);
            },
            tbb::simple_partitioner());
    });
}

}  // namespace halflit::raster
