// Test of the flag -ffp-contract=off: without it the results differ, so tests that compare results notice when the flag is lost.
#include "elementary/contraction.hpp"
#include "elementary/elementary.hpp"
#include "floats.hpp"
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

using namespace halflit;
using namespace halflit::testing;

namespace {

/// True if the two objects may be run: on x86-64 they are built for processors with FMA.
[[maybe_unused]] bool has_fma() {
#if defined(__x86_64__)
    __builtin_cpu_init();
    return __builtin_cpu_supports("fma") != 0;
#else
    return true;
#endif
}

}  // namespace

TEST_CASE("contraction: the project's flags keep multiply and add apart where they could be fused, the compiler's own do not",
          "[shading][simd]") {
#if defined(__x86_64__) || defined(__aarch64__)
    if (!has_fma()) HALFLIT_SKIP("this processor has no fused multiply-add");
    constexpr int kCount = 1 << 12;
    std::vector<float> t(kCount), want(kCount), apart(kCount), fused(kCount);
    for (int i = 0; i < kCount; ++i) t[static_cast<std::size_t>(i)] = static_cast<float>(i) / kCount;
    elementary(Isa::scalar).power(t.data(), 1.3f, want.data(), kCount);
    power_uncontracted(t.data(), apart.data(), kCount);
    power_contracted(t.data(), fused.data(), kCount);
    int apart_differ = 0, fused_differ = 0;
    for (std::size_t i = 0; i < t.size(); ++i) {
        apart_differ += !same_bits(want[i], apart[i]);
        fused_differ += !same_bits(want[i], fused[i]);
    }
    CHECK(apart_differ == 0);
    CHECK(fused_differ > kCount / 100);
#else
    HALFLIT_SKIP("not known here how to ask for fused multiply-add");
#endif
}
