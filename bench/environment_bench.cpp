// What a fragment costs under an environment, for each number of bands and each instruction set. Order 0 is the same fragment under the
// two-colour ambient light, so the difference to it is what the bands cost.
#include "shading/environment.hpp"
#include "shading/kernels/shade_kernels.hpp"

#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>
#include <vector>

namespace halflit::shading {
namespace {

/// Deterministic filling in [-1, 1): a linear congruential generator's upper bits.
class Numbers {
public:
    float next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<float>(state_ >> 40) * 0x1p-23f - 1.0f;
    }

private:
    std::uint64_t state_ = 1;
};

FramePlan plan_of(int order) {
    Numbers numbers;
    std::vector<float> rgb(std::size_t{32} * 16 * 3);
    for (float& x : rgb) x = 1.0f + numbers.next();
    const Environment environment = make_environment({32, 16, rgb}, {false, 0.0});
    const Material material;
    const QuadMask quads[] = {3u, 3u};
    PlanOptions options;
    options.highlight = Highlight::none;  // one look-up a fragment
    options.environment_order.fixed = order;
    return make_frame_plan({&material, 1}, {}, quads, {}, Ambient{{0.4f, 0.5f, 0.6f}, {0.2f, 0.2f, 0.1f}}, options,
                           order > 0 ? &environment : nullptr);
}

void shade_block(benchmark::State& state, Isa isa, int order) {
    const FramePlan plan = plan_of(order);
    Numbers numbers;
    FragmentBlock block{};
    for (int row = kPosX; row <= kNormalZ; ++row)
        for (float& x : block.lane[row]) x = numbers.next();
    const ShadeKernels& kernels = shade_kernels(isa);
    for (auto _ : state) {
        kernels.shade(plan, plan.materials[0], all_lights(plan), block, kBlockSize);
        benchmark::DoNotOptimize(block.red);
        benchmark::ClobberMemory();
    }
    using benchmark::Counter;
    state.counters["per_fragment"] = Counter(kBlockSize, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

const bool kRegistered = [] {
    for (const Isa isa : built_isas()) {
        if (!isa_available(isa)) continue;
        for (int order = 0; order <= sh::kMaxBands; ++order)
            benchmark::RegisterBenchmark(("environment/" + std::string(isa_name(isa)) + "/order:" + std::to_string(order)).c_str(),
                                         shade_block, isa, order);
    }
    return true;
}();

}  // namespace
}  // namespace halflit::shading
