// Uninitialised arrays, large ones in huge pages where the system makes them on request. A fault for each page of 4 kB takes a tenth of the
// time to load a picture, and a sixth of the time to draw one whose shadow maps take 100 MB.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <type_traits>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace halflit::shading {

struct FreeBlock {
    std::align_val_t alignment{64};
    void operator()(void* block) const { ::operator delete(block, alignment); }
};

template <class T>
using LargeBlock = std::unique_ptr<T[], FreeBlock>;

/// An array aligned to a cache line at least. Throws std::bad_alloc.
template <class T>
[[nodiscard]] LargeBlock<T> make_large_block(std::size_t count) {
    static_assert(std::is_trivially_default_constructible_v<T> && std::is_trivially_destructible_v<T>);
    constexpr std::size_t kHugePage = std::size_t{2} << 20;
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = count * sizeof(T);
    const bool is_large = bytes >= 2 * kHugePage;
    const std::align_val_t alignment{is_large ? kHugePage : 64};
    LargeBlock<T> block(static_cast<T*>(::operator new(bytes, alignment)), FreeBlock{alignment});
#ifdef __linux__
    if (is_large) madvise(block.get(), bytes / kHugePage * kHugePage, MADV_HUGEPAGE);
#endif
    return block;
}

}  // namespace halflit::shading
