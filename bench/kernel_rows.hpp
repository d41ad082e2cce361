// Rows of the kernel benchmark: the inner functions of a frame besides light, with the data that they run over.
#pragma once

#include "halflit/isa.hpp"

#include <functional>
#include <string>
#include <vector>

namespace halflit::bench {

/// One line of the table. `prepare` makes the data for an instruction set, and returns the function that is timed; the data lives as long
/// as that function.
struct KernelRow {
    std::string name;
    std::string unit;  ///< what the time is divided by
    double units = 1;  ///< in one call of the function
    std::function<std::function<void()>(Isa)> prepare;
    bool every_set = true;  ///< false: the work does not depend on the instruction set
};

[[nodiscard]] std::vector<KernelRow> geometry_rows();   ///< transform, vertex records, binning
[[nodiscard]] std::vector<KernelRow> rasterize_rows();  ///< set-up and visibility, by size of triangle; interpolation
[[nodiscard]] std::vector<KernelRow> texture_rows();    ///< two trilinear textures, by the place of their texels
[[nodiscard]] std::vector<KernelRow> output_rows();     ///< sRGB codes, samples, PNG

}  // namespace halflit::bench
