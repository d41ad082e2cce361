// True if a run of Google Benchmark failed. The member was renamed in version 1.8.
#pragma once

namespace halflit::bench {

template <class Run>
[[nodiscard]] bool failed(const Run& run) {
    if constexpr (requires { run.error_occurred; })
        return run.error_occurred;
    else
        return static_cast<int>(run.skipped) != 0;
}

}  // namespace halflit::bench
