// The vocabulary's operations and the elementary functions on arrays, built once for each instruction set, so that tests can
// compare the sets with each other and with the C library.
#pragma once

#include "halflit/isa.hpp"

#include <cstdint>

namespace halflit::testing {

using Unary = void (*)(const float* x, float* out, int count);  ///< count: a multiple of 16
using Ternary = void (*)(const float* a, const float* b, const float* c, float* out, int count);

struct NamedUnary {
    const char* name;
    Unary run;
};
struct NamedTernary {
    const char* name;
    Ternary run;
};

struct Elementary {
    const NamedUnary* unary;
    int unary_count;
    const NamedTernary* ternary;
    int ternary_count;
    /// t^n as the general lobe path computes it.
    void (*power)(const float* t, float n, float* out, int count);
    /// (cos^2)^half_exponent from the squares of cosine and sine.
    void (*power_of_cosine)(const float* cosine_squared, const float* sine_squared, const float* half_exponent, float* out, int count);
    void (*normalize)(const float* x, const float* y, const float* z, float* out_x, float* out_y, float* out_z, int count);
    std::uint32_t (*mask_of_less)(const float* a, const float* b);  ///< one vector; bit l is lane l
    int width;
};

const Elementary& elementary(Isa isa);

}  // namespace halflit::testing
