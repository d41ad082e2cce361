#include "tests/faults/allocation_counter.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

std::atomic<long> live{0}, made_so_far{0}, first_failure{0}, last_failure{0};

void* allocate(std::size_t size, std::size_t alignment) {
    const long number = ++made_so_far;
    if (number >= first_failure && number <= last_failure) throw std::bad_alloc();
    // aligned_alloc takes whole multiples of the alignment.
    const std::size_t room = (std::max<std::size_t>(size, 1) + alignment - 1) / alignment * alignment;
    void* const memory = alignment > alignof(std::max_align_t) ? std::aligned_alloc(alignment, room) : std::malloc(room);
    if (memory == nullptr) throw std::bad_alloc();
    ++live;
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

AllocationFault::AllocationFault(long at, bool all_later) {
    made_so_far = 0;
    first_failure = at;
    last_failure = at == 0 ? -1 : all_later ? std::numeric_limits<long>::max() : at;
}

AllocationFault::~AllocationFault() { last_failure = -1; }

long AllocationFault::made() { return made_so_far; }

}  // namespace halflit::test
