// A global operator new that counts, and fails when told to. Linking allocation_counter.cpp replaces the standard one.
#pragma once

#include <cstdint>

namespace halflit::test {

/// Allocations that are not freed yet, of all threads.
long live_allocations();

/// The largest number of bytes that are allocated at a time, of all threads, while it lives. 0 where the C library does not tell sizes.
class PeakOfBytes {
public:
    PeakOfBytes();
    [[nodiscard]] std::int64_t bytes() const;  ///< beyond those that were allocated before

private:
    std::int64_t before_;
};

/// Failures of operator new while it lives: the `at`-th allocation from now on (from 1; 0: none) throws std::bad_alloc, and with
/// `all_later` those after it too.
class AllocationFault {
public:
    explicit AllocationFault(long at, bool all_later = false);
    ~AllocationFault();
    AllocationFault(const AllocationFault&) = delete;
    AllocationFault& operator=(const AllocationFault&) = delete;
    /// Allocations since the construction.
    [[nodiscard]] static long made();
};

}  // namespace halflit::test
