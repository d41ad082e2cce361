#include "apps/io/platform/process.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace halflit::platform {

#ifdef __GLIBC__

namespace {

constexpr std::size_t kReserved = 128 << 20;  // bytes of addresses; what is not touched takes no memory
constexpr int kLargestInHeap = 32 << 20;      // the most that glibc allows; larger blocks are mapped one by one
constexpr int kKeptFree = 1 << 30;            // the most free memory at the heap's end that is kept
constexpr std::size_t kFirstBlock = 1 << 20;  // more than is left of the small heap of the program's start
constexpr std::size_t kHeader = 32;           // more than glibc adds to a block
constexpr std::uintptr_t kHugePage = 2 << 20;

bool is_limited(int resource) {
    rlimit limit{};
    return ::getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0 || limit.rlim_cur != RLIM_INFINITY;
}

bool set_up_heap() {
    if (is_limited(RLIMIT_DATA) || is_limited(RLIMIT_AS)) return false;
    mallopt(M_MMAP_THRESHOLD, kLargestInHeap);
    mallopt(M_TRIM_THRESHOLD, kKeptFree);
    mallopt(M_ARENA_MAX, 1);  // other threads' heaps would have small pages; they allocate seldom. Overrides MALLOC_ARENA_MAX
    mallopt(M_TOP_PAD, static_cast<int>(kReserved));
    void* volatile const block = std::malloc(kFirstBlock);  // volatile: the compiler would leave out a block that is not used
    std::free(block);
    mallopt(M_TOP_PAD, static_cast<int>(kFirstBlock));
    const auto at = reinterpret_cast<std::uintptr_t>(block), after = reinterpret_cast<std::uintptr_t>(::sbrk(0));
    // Large pages begin behind what glibc has written to, the header after the block: a large page must be new as a whole.
    const std::uintptr_t first = (at + kFirstBlock + kHeader + kHugePage - 1) / kHugePage * kHugePage;
    if (at > after || after - at < kReserved || first >= after) return true;  // another allocator than glibc's, which stays as it is
    ::madvise(reinterpret_cast<void*>(first), after - first, MADV_HUGEPAGE);
    // What lies before would be taken in pages of 4 kB, some hundreds of faults: a block that nobody writes to covers it.
    void* volatile const gap = std::malloc(first - at - kHeader);
    static_cast<void>(gap);
    return true;
}

}  // namespace

void prepare_heap() { [[maybe_unused]] static const bool done = set_up_heap(); }

void give_back(std::byte* begin, std::size_t bytes) {
    const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE)), at = reinterpret_cast<std::uintptr_t>(begin);
    const std::uintptr_t first = (at + page - 1) / page * page, end = (at + bytes) / page * page;
    if (first < end) ::madvise(reinterpret_cast<void*>(first), end - first, MADV_DONTNEED);
}

#else

void give_back(std::byte*, std::size_t) {}

void prepare_heap() {}

#endif

}  // namespace halflit::platform
