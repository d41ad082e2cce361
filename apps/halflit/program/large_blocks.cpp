// The program's operator new: blocks from 4 MB on, such as the vertices and the tables of a large model, lie in pages of 2 MB. A page fault
// for each 4 kB takes 2 to 30 % of the time in which a model of millions of triangles is drawn. A twentieth more memory.
#include <cstddef>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define HALFLIT_OWN_OPERATOR_NEW 0
#endif
#endif
#if !defined(HALFLIT_OWN_OPERATOR_NEW) && defined(__linux__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20, kLarge = 2 * kHugePage;

void* allocate(std::size_t bytes) {
    if (bytes < kLarge) return std::malloc(bytes == 0 ? 1 : bytes);
    if (bytes > ~std::size_t{0} - kHugePage) return nullptr;
    const std::size_t pages = (bytes + kHugePage - 1) / kHugePage * kHugePage;
    void* const block = std::aligned_alloc(kHugePage, pages);
    if (block != nullptr) ::madvise(block, pages, MADV_HUGEPAGE);
    return block;
}

}  // namespace

void* operator new(std::size_t bytes) {
    for (;;) {
        if (void* const block = allocate(bytes)) return block;
        const std::new_handler handler = std::get_new_handler();
        if (handler == nullptr) throw std::bad_alloc();
        handler();
    }
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }

#endif
