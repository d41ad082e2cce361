// Floats for tests: ordinary ones, every kind of special one, and comparison by bits.
#pragma once

#include "halflit/isa.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace halflit::testing {

/// Bit equality, except that all NaNs are one value: payload and sign of a NaN may differ between processors.
inline bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}

inline constexpr float kInf = std::numeric_limits<float>::infinity();
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

inline const std::vector<float>& special_floats() {
    static const std::vector<float> values = {0.0f,   -0.0f,  1.0f,       -1.0f,   0.5f,       -0.5f,      0.99999994f, 1.0000001f,
                                              2.0f,   -2.0f,  1e-45f,     -1e-45f, 1e-40f,     1.2e-38f,   1e-30f,      -1e-20f,
                                              1e-10f, 255.0f, 8388608.0f, 1e10f,   -1e20f,     1e30f,      3.4e38f,     -3.4e38f,
                                              kInf,   -kInf,  kNan,       -kNan,   0.0031308f, 4194304.0f, 1048576.0f,  -1.5f};
    return values;
}

/// One in eight values is special, one in eight has random bits; the rest are spread evenly over [low, high].
class FloatMaker {
public:
    explicit FloatMaker(std::uint32_t seed) : engine_(seed) {}
    float ordinary(float low, float high) { return low + (high - low) * (static_cast<float>(engine_() >> 8) * 0x1p-24f); }
    float wild(float low, float high) {
        const std::uint32_t kind = engine_() % 8;
        if (kind == 0) return special_floats()[engine_() % special_floats().size()];
        if (kind == 1) return std::bit_cast<float>(static_cast<std::uint32_t>(engine_()));
        return ordinary(low, high);
    }
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }

private:
    std::mt19937 engine_;
};

/// The sets to compare with scalar: built, and available here.
inline std::vector<Isa> other_isas() {
    std::vector<Isa> isas;
    for (const Isa isa : built_isas())
        if (isa != Isa::scalar && isa_available(isa)) isas.push_back(isa);
    return isas;
}

}  // namespace halflit::testing
