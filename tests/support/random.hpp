// Random test data from fixed seeds, the same on every machine: the standard fixes the engine, not its distributions.
#pragma once

#include <cstdint>
#include <random>

namespace halflit::test {

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// Integer in [low, high]. The bias of the remainder is below 2^-32 for the ranges that tests use.
    std::int64_t integer(std::int64_t low, std::int64_t high) {
        return low + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(high - low + 1));
    }
    int index(int count) { return static_cast<int>(integer(0, count - 1)); }
    /// Number in [low, high).
    double real(double low, double high) { return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53); }
    float real32(double low, double high) { return static_cast<float>(real(low, high)); }
    bool chance(double probability) { return real(0, 1) < probability; }

private:
    std::mt19937_64 engine_;
};

}  // namespace halflit::test
