// Rows of the shading benchmark: the work that each measures, and its number of operations.
#pragma once

#include "bench/kernels/bare_kernels.hpp"

#include <string>
#include <vector>

namespace halflit::bench {

/// Code that a row runs over a block of 64 fragments.
enum class Work { sum, shade, environment, encode, pixel, peak };

/// Numbers of operations: additions and multiplications together, divisions, square roots. Comparisons and selections do not count.
struct Operations {
    int flops = 0, divisions = 0, roots = 0;
    friend Operations operator+(Operations a, Operations b) { return {a.flops + b.flops, a.divisions + b.divisions, a.roots + b.roots}; }
};

/// One line of the table: the same work in variants that differ in the number of lights.
struct Row {
    std::string name;
    Work work = Work::sum;
    bool specular = false;
    std::vector<int> lights;                   ///< per variant: number of lights; {0}: times are per fragment, not per light
    std::vector<shading::ShadingPlan> frames;  ///< per variant
    Operations operations;                     ///< per fragment, or per fragment and light; zero: not counted
    double largest_price = 0.0;                ///< limit for the price of exactness; 0: none
    double least_gain = 0.0;                   ///< limit for time of scalar / time of AVX2 with four lights or more
};

/// Makes all rows. Textures that their plans point to live as long as the program.
[[nodiscard]] std::vector<Row> shading_rows();

/// Makes a block with valid input for every row.
[[nodiscard]] shading::FragmentBlock filled_block();

}  // namespace halflit::bench
