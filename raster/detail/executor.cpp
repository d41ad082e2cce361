#include "raster/detail/executor.hpp"

#include "sh/available_cores.hpp"
#include "sh/fp_environment.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <system_error>
#include <thread>

#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
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

/// Threads of the process, which wait for loops: started when they are first asked for, kept to its end. A loop takes those that are free;
/// where loops run at once, there are as many threads as cores.
class Threads {
public:
    /// Never freed: the threads may wait while the process ends. A process that was forked has none of its parent's, and gets its own.
    static Threads& of_process() {
        static std::atomic<Threads*> kept{nullptr};
        Threads* found = kept;
        if (found != nullptr && found->is_own()) return *found;
        auto* const made = new Threads;
        if (kept.compare_exchange_strong(found, made)) return *made;
        delete made;  // another thread was faster
        return *found;
    }

    /// Number of threads that there are, at most `wanted`: the system may refuse to start more.
    int start(int wanted) {
        wanted = std::min(wanted, kMost);
        const std::lock_guard lock(mutex_);
        start_more(wanted);
        return std::min(started_, wanted);
    }

    /// Runs task(0) to task(count - 1) on this thread and at most `others` more. No task throws.
    void run(int others, int count, const std::function<void(int)>& task) {
        const int places = std::min(others, count - 1);
        Loop loop{task, count, places};
        {
            const std::lock_guard lock(mutex_);
            if (idle_ < places) start_more(std::min(started_ + places - idle_, cores_ - 1));
            loops_.push_back(&loop);
        }
        for (int i = 0; i < places; ++i) wake_.notify_one();
        loop.work();
        std::unique_lock lock(mutex_);
        std::erase(loops_, &loop);
        loop.left.wait(lock, [&] { return loop.inside == 0; });
    }

private:
    static constexpr int kMost = 1023;
    struct Loop {
        const std::function<void(int)>& task;
        int count;
        int open;        ///< places for threads
        int inside = 0;  ///< threads that work on it, besides the one that runs it
        std::atomic<int> next{0};
        std::condition_variable left{};

        void work() {
            for (int i = next++; i < count; i = next++) task(i);
        }
    };

    /// Requires: mutex_ is locked.
    void start_more(int wanted) {
        try {
            for (; started_ < wanted && start_one(); ++started_, ++idle_) {
            }
        } catch (const std::system_error&) {
        }
    }

#if defined(__unix__) || defined(__APPLE__)
    /// With a stack that tasks need: those of 8 MB by default would count against a limit of memory, 64 of them half a gigabyte.
    bool start_one() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
        constexpr std::size_t kStack = 8 << 20;
#else
        constexpr std::size_t kStack = 512 << 10;
#endif
        pthread_attr_t how;
        if (pthread_attr_init(&how) != 0) return false;
        pthread_attr_setstacksize(&how, kStack);
        pthread_attr_setdetachstate(&how, PTHREAD_CREATE_DETACHED);
        pthread_t thread;
        const auto wait = [](void* threads) -> void* {
            static_cast<Threads*>(threads)->wait_for_loops();
            return nullptr;
        };
        const int refused = pthread_create(&thread, &how, wait, this);
        pthread_attr_destroy(&how);
        return refused == 0;
    }
#else
    bool start_one() {
        std::thread([this] { wait_for_loops(); }).detach();
        return true;
    }
#endif

    void wait_for_loops() {
        std::unique_lock lock(mutex_);
        for (;; ++idle_) {
            wake_.wait(lock, [this] { return !loops_.empty(); });
            --idle_;
            Loop& loop = *loops_.back();  // of loops within loops the innermost
            if (--loop.open == 0) loops_.pop_back();
            ++loop.inside;
            lock.unlock();
            loop.work();
            lock.lock();
            if (--loop.inside == 0) loop.left.notify_one();
        }
    }

#if defined(__unix__) || defined(__APPLE__)
    [[nodiscard]] bool is_own() const { return process_ == getpid(); }
    pid_t process_ = getpid();
#else
    [[nodiscard]] static bool is_own() { return true; }
#endif
    std::mutex mutex_;
    std::condition_variable wake_;
    std::vector<Loop*> loops_;  ///< those that have open places
    int started_ = 0, idle_ = 0;
    const int cores_ = available_cores();
};

}  // namespace

void Executor::configure(const Execution& execution) {
    stop_.arm(execution);
    hook_ = execution.parallel_for;
    if (hook_) return;
    const int wanted = execution.threads > 0 ? execution.threads : available_cores();
    threads_ = wanted > 1 ? 1 + Threads::of_process().start(wanted - 1) : 1;
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
    } else if (threads_ > 1 && count > 1) {
        run_catching([&](const std::function<void(int)>& caught) { Threads::of_process().run(threads_ - 1, count, caught); }, task);
    } else {
        for (int i = 0; i < count; ++i) task(i);
    }
    if (left_out) stop_.check();
}

}  // namespace halflit::raster
