#include "raster/detail/executor.hpp"

#include "sh/fp_environment.hpp"
#include "sh/time_limit.hpp"

#ifdef HALFLIT_ONETBB
#include <tbb/cache_aligned_allocator.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <thread>

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

namespace halflit::raster {
namespace {

/// Runs `loop(task)`. The loop may use threads that an exception must not leave, so the first one is caught there and rethrown here.
template <class Loop>
void run_catching(const Loop& loop, const std::function<void(int)>& task) {
    std::exception_ptr failure;
    std::mutex mutex;
    loop([&](int i) {
        try {
            task(i);
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!failure) failure = std::current_exception();
        }
    });
    if (failure) std::rethrow_exception(failure);
}

/// Starts threads for each loop: about ten microseconds per loop more than oneTBB, which keeps its threads.
void run_by_new_threads(int threads, int count, const std::function<void(int)>& task) {
    std::atomic<int> next{0};
    const auto work = [&] {
        for (int i = next++; i < count; i = next++) task(i);
    };
    run_catching(
        [&](const std::function<void(int)>& part) {
            std::vector<std::jthread> others;
            try {
                for (int i = 1; i < std::min(threads, count); ++i) others.emplace_back(part, i);
            } catch (const std::system_error&) {
                // No further thread can be started: those that run, and this one, do all the work.
            }
            part(0);
        },
        [&](int) { work(); });
}

int hardware_threads() { return static_cast<int>(std::thread::hardware_concurrency()); }

}  // namespace

#ifdef HALFLIT_ONETBB

namespace {

/// True in a process that was forked from one in which oneTBB ran loops: its threads are not there, and its locks may be held for ever.
bool is_forked() {
#if defined(__unix__) || defined(__APPLE__)
    static std::atomic<pid_t> process{0};
    pid_t first = 0;
    const pid_t own = getpid();
    return !process.compare_exchange_strong(first, own) && first != own;
#else
    return false;
#endif
}

}  // namespace

struct Executor::Arena {
    explicit Arena(int thread_count) : threads(thread_count) {
        if (is_forked()) return;
        arena.emplace(thread_count);
        take_first_memory();
        // oneTBB starts its threads with the first loop. An exception for one that does not start is harmless here, not inside a frame.
        run(thread_count, [](int) {});
    }
    /// oneTBB 2022 waits for itself for ever where its memory ends while it starts. Here it throws instead, and keeps what it took.
    static void take_first_memory() {
        tbb::cache_aligned_allocator<std::byte> memory;
        constexpr std::size_t kBytes = 256 * 1024;
        memory.deallocate(memory.allocate(kBytes), kBytes);
    }
    /// Number of threads, at most `wanted`, that the system lets this process start. oneTBB's loops end with an exception where one of its
    /// threads does not start. A number that did start is not tried again.
    static int threads_that_start(int wanted) {
        static std::atomic<int> proven{0};
        if (wanted <= proven) return wanted;
        std::mutex gate;
        std::vector<std::thread> started;
        {
            const std::lock_guard closed(gate);  // they all live until the last has started
            try {
                started.reserve(static_cast<std::size_t>(wanted));
                while (static_cast<int>(started.size()) < wanted) started.emplace_back([&gate] { const std::lock_guard pass(gate); });
            } catch (const std::system_error&) {
            } catch (const std::bad_alloc&) {
            }
        }
        for (std::thread& thread : started) thread.join();
        const int count = static_cast<int>(started.size());
        if (count == wanted) proven = count;
        return count;
    }
    static int all_threads() { return is_forked() ? hardware_threads() : static_cast<int>(tbb::this_task_arena::max_concurrency()); }
    /// oneTBB runs no more threads than this, and prints a warning when asked for more.
    static int most_threads() {
        if (is_forked()) return std::max(hardware_threads(), 1);
        return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    }
    void run(int count, const std::function<void(int)>& task) {
        if (!arena) return run_by_new_threads(threads, count, task);
        arena->execute([&] { tbb::parallel_for(0, count, task, tbb::simple_partitioner()); });
    }
    /// False for an arena of oneTBB in a process that was forked.
    [[nodiscard]] bool is_usable() const { return !arena || !is_forked(); }
    /// oneTBB 2021 leaks about 7 kB with most arenas that end right after a loop, while its threads leave them. So arenas are kept for the
    /// next executor with as many threads. The list is never freed: at the end of the process oneTBB may be gone first.
    struct Idle {
        std::mutex mutex;
        std::vector<std::unique_ptr<Arena>> list;
    };
    static Idle& idle() {
        static Idle& kept = *new Idle;
        return kept;
    }
    static Arena* take(int thread_count) {
        if (!is_forked()) {
            Idle& kept = idle();
            const std::lock_guard lock(kept.mutex);
            const auto found = std::find_if(kept.list.begin(), kept.list.end(), [=](const auto& a) { return a->threads == thread_count; });
            if (found != kept.list.end()) {
                Arena* const arena = found->release();
                kept.list.erase(found);
                return arena;
            }
        }
        return std::make_unique<Arena>(thread_count).release();
    }
    static void give_back(std::unique_ptr<Arena> arena) {
        if (is_forked()) {
            if (!arena->is_usable()) (void)arena.release();  // its end would wait for threads that are not there
            return;
        }
        try {
            Idle& kept = idle();
            const std::lock_guard lock(kept.mutex);
            kept.list.push_back(std::move(arena));
        } catch (const std::bad_alloc&) {
        }
    }
    int threads;
    std::optional<tbb::task_arena> arena;  ///< none in a process that was forked
};

#else

struct Executor::Arena {
    explicit Arena(int thread_count) : threads(thread_count) {}
    static int threads_that_start(int wanted) { return wanted; }  // each loop makes do with those that start
    static int all_threads() { return hardware_threads(); }
    static int most_threads() { return std::numeric_limits<int>::max(); }
    void run(int count, const std::function<void(int)>& task) { run_by_new_threads(threads, count, task); }
    [[nodiscard]] bool is_usable() const { return true; }
    static Arena* take(int thread_count) { return std::make_unique<Arena>(thread_count).release(); }
    static void give_back(std::unique_ptr<Arena>) {}
    int threads;
};

#endif

void Executor::GiveBack::operator()(Arena* arena) const noexcept { Arena::give_back(std::unique_ptr<Arena>(arena)); }

Executor::Executor() = default;
Executor::~Executor() = default;

void Executor::configure(const Execution& execution) {
    stop_.arm(execution);
    hook_ = execution.parallel_for;
    if (hook_) return;
    const int wanted =
        std::min(execution.threads > 0 ? execution.threads : std::max(Arena::all_threads(), 1), std::max(Arena::most_threads(), 1));
    if (arena_ && wanted == asked_ && arena_->is_usable()) return;
    asked_ = wanted;
    threads_ = 1 + Arena::threads_that_start(wanted - 1);
    arena_.reset();
    if (threads_ == 1) return;
    try {
        arena_.reset(Arena::take(threads_));
    } catch (const std::runtime_error&) {
        threads_ = 1;
    }
}

void Executor::run(int count, const std::function<void(int)>& body) {
    std::atomic<bool> left_out{false};
    const std::function<void(int)> task = [&, bounds = TimeLimit::bounds()](int i) {
        if (stop_.raised()) {
            left_out = true;
            return;
        }
        const FpEnvironment environment;
        const TimeLimit limit(bounds);
        body(i);
    };
    if (hook_) {
        std::vector<std::atomic<bool>> taken(static_cast<std::size_t>(count));
        std::atomic<int> done{0};
        std::atomic<bool> astray{false};
        run_catching([&](const std::function<void(int)>& caught) { hook_(count, caught); },
                     [&](int i) {
                         // A second run of an item may write what others read already, so it is not made.
                         if (i < 0 || i >= count || taken[static_cast<std::size_t>(i)].exchange(true)) {
                             astray = true;
                             return;
                         }
                         task(i);
                         ++done;
                     });
        if (done != count) throw WrongLoop("parallel_for returned before every item was done");
        if (astray) throw WrongLoop("parallel_for ran an item twice, or one outside of its range");
    } else if (arena_ && count > 1) {
        arena_->run(count, task);
    } else {
        for (int i = 0; i < count; ++i) task(i);
    }
    if (left_out) stop_.check();
}

}  // namespace halflit::raster
