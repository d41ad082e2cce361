#include "tests/faults/allocation_counter.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace {

std::atomic<long> live{0}, made_so_far{0}, first_failure{0}, last_failure{0};

std::atomic<std::int64_t> live_bytes{0}, peak_bytes{0};

std::int64_t bytes_of([[maybe_unused]] void* memory) {
#if defined(__GLIBC__)
    return static_cast<std::int64_t>(malloc_usable_size(memory));
#else
    return 0;
#endif
}

void* allocate(std::size_t size, std::size_t alignment) {
    const long number = ++made_so_far;
    if (number >= first_failure && number <= last_failure) throw std::bad_alloc();
    // aligned_alloc takes whole multiples of the alignment.
    const std::size_t room = (std::max<std::size_t>(size, 1) + alignment - 1) / alignment * alignment;
    void* const memory = alignment > alignof(std::max_align_t) ? std::aligned_alloc(alignment, room) : std::malloc(room);
    if (memory == nullptr) throw std::bad_alloc();
    ++live;
    const std::int64_t bytes = live_bytes += bytes_of(memory);
    for (std::int64_t peak = peak_bytes; bytes > peak && !peak_bytes.compare_exchange_weak(peak, bytes);) {
    }
    return memory;
}

void* allocate_or_null(std::size_t size) noexcept {
    try {
        return allocate(size, 1);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

void release(void* memory) {
    if (memory == nullptr) return;
    --live;
    live_bytes -= bytes_of(memory);
    std::free(memory);
}

}  // namespace

// All forms: the standard library's would call the first ones, but AddressSanitizer brings its own.
void* operator new(std::size_t size) { return allocate(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) { return allocate(size, static_cast<std::size_t>(alignment)); }
void* operator new[](std::size_t size) { return allocate(size, 1); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return allocate(size, static_cast<std::size_t>(alignment)); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate_or_null(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return allocate_or_null(size); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { release(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { release(memory); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace halflit::test {

long live_allocations() { return live; }

PeakOfBytes::PeakOfBytes() : before_(live_bytes) { peak_bytes = before_; }
std::int64_t PeakOfBytes::bytes() const { return peak_bytes - before_; }

AllocationFault::AllocationFault(long at, bool all_later) {
    made_so_far = 0;
    first_failure = at;
    last_failure = at == 0 ? -1 : all_later ? std::numeric_limits<long>::max() : at;
}

AllocationFault::~AllocationFault() { last_failure = -1; }

long AllocationFault::made() { return made_so_far; }

}  // namespace halflit::test
