// A fuzz target: a function that takes any bytes and must not crash, hang, leak or find a broken promise. libFuzzer calls it
// (fuzzer_main.cpp), and so does a plain program that runs it on files (replay.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

/// Replaces the bytes by similar ones, by what libFuzzer knows of the target and by its dictionary. Returns the new size, at most max_size.
/// replay.cpp has a simple one of its own.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace halflit::fuzz {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

/// Random numbers of a mutation. The same seed gives the same ones with every standard library.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed * 2 + 1) {}
    std::uint32_t next() {  // PCG's multiplier; the upper half of the product's bits are the random ones
        state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
        return static_cast<std::uint32_t>(state_ >> 32);
    }
    /// In [0, n); 0 if n is 0.
    std::size_t below(std::size_t n) { return n == 0 ? 0 : next() % n; }
    bool one_in(std::size_t n) { return below(n) == 0; }
    template <class Range>
    auto& pick(Range& range) {
        return range[below(std::size(range))];
    }

private:
    std::uint64_t state_;
};

struct FuzzTarget {
    const char* name;
    std::size_t max_bytes;  ///< largest input
    void (*run)(View input);
    /// Replaces the input by a similar one that gets past the parser. Null: mutate_bytes.
    void (*mutate)(Bytes& input, std::size_t max_bytes, Random& random) = nullptr;
};

/// By libFuzzer, which does not know the format.
inline void mutate_bytes(Bytes& bytes, std::size_t max_bytes) {
    const std::size_t size = bytes.size() < max_bytes ? bytes.size() : max_bytes;
    bytes.resize(max_bytes);
    bytes.resize(LLVMFuzzerMutate(bytes.data(), size, max_bytes));
}

extern const FuzzTarget kGltfText, kGlb, kModel, kPicture, kKtx2, kHdr, kScene, kCApi;

/// A promise that the input broke: the fuzzer keeps the input.
#define HALFLIT_PROMISE(condition)                                                               \
    do {                                                                                         \
        if (!(condition)) {                                                                      \
            std::fprintf(stderr, "%s:%d: broken promise: %s\n", __FILE__, __LINE__, #condition); \
            std::abort();                                                                        \
        }                                                                                        \
    } while (false)

}  // namespace halflit::fuzz
