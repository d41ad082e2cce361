// Lobes by the names users type, in flags and in a material's extras.halflit.
#pragma once

#include "halflit/error.hpp"
#include "halflit/lobe.hpp"

#include <optional>
#include <string_view>

namespace halflit::io {

/// Parameters besides the name; an empty one keeps the value that the name stands for.
struct LobeParameters {
    std::optional<float> wrap;   ///< [0, 1]
    std::optional<float> power;  ///< [0, 10000]
    std::optional<bool> normalize;
};

/// lambert, green, half-lambert, valve, sloan or mcauley. green, sloan and mcauley have wrap 0.5 unless one is given; the power of sloan
/// and mcauley is 1 + wrap unless one is given. The error (bad_input) lists what is allowed.
Result<Lobe> lobe_from_name(std::string_view name, const LobeParameters& parameters = {});

}  // namespace halflit::io
