// The floating-point environment that all results assume: round to nearest even, denormals kept, exceptions masked. A host may
// have set something else (flush to zero is common in games and audio), so every entry and every task sets and restores it.
#pragma once

#include <cstdint>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace halflit::raster {

class [[maybe_unused]] FpEnvironment {
public:
    FpEnvironment(const FpEnvironment&) = delete;
    FpEnvironment& operator=(const FpEnvironment&) = delete;

#if defined(__x86_64__)
    FpEnvironment() : saved_(_mm_getcsr()) { _mm_setcsr(0x1f80); }
    ~FpEnvironment() { _mm_setcsr(saved_); }

private:
    unsigned saved_;
#elif defined(__aarch64__)
    FpEnvironment() {
        asm volatile("mrs %0, fpcr" : "=r"(saved_));
        asm volatile("msr fpcr, %0" : : "r"(std::uint64_t{0}));
    }
    ~FpEnvironment() { asm volatile("msr fpcr, %0" : : "r"(saved_)); }

private:
    std::uint64_t saved_;
#else
    FpEnvironment() = default;
#endif
};

}  // namespace halflit::raster
