// What the shading benchmark measures, and how many operations each of it is.
#pragma once

#include "bench/kernels/bare_kernels.hpp"

#include <string>
#include <vector>

namespace halflit::bench {

/// Which code a row runs over a block of 64 fragments.
enum class Work { sum, shade, environment, encode, pixel, peak };

/// Additions and multiplications, comparisons and selections not counted; divisions and square roots for themselves.
struct Operations {
    int flops = 0, divisions = 0, roots = 0;
    friend Operations operator+(Operations a, Operations b) { return {a.flops + b.flops, a.divisions + b.divisions, a.roots + b.roots}; }
};

/// One line of the table: the same work with as many lights as each of `frames` has.
struct Row {
    std::string name;
    Work work = Work::sum;
    bool specular = false;
    std::vector<int> lights;                   ///< for each variant; {0}: time is a fragment's, not a light's
    std::vector<shading::ShadingPlan> frames;  ///< for each variant
    Operations operations;                     ///< for a fragment, and a light where there are lights; zero: not counted
    double largest_price = 0.0;                ///< of exactness, that is thought fair; 0: none is set
    double least_gain = 0.0;                   ///< of AVX2 over scalar, with four lights or more
};

/// Textures that the rows' plans point into are kept for the program's life.
[[nodiscard]] std::vector<Row> shading_rows();

/// A block whose rows are filled as all of the rows want it.
[[nodiscard]] shading::FragmentBlock filled_block();

}  // namespace halflit::bench
