// Lobes by the names users type, in flags and in a material's extras.halflit.
#pragma once

#include "shading/lobe.hpp"
#include "shading/result.hpp"

#include <optional>
#include <string_view>

namespace halflit::io {

/// What may be said besides the name; what is not said keeps the value that the name stands for.
struct LobeParameters {
    std::optional<float> wrap;   ///< [0, 1]
    std::optional<float> power;  ///< [0, 10000]
    std::optional<bool> normalize;
};

/// lambert, green, half-lambert, valve, sloan or mcauley. green, sloan and mcauley take their wrap from the parameters (0.5 if not said);
/// sloan's power follows its wrap unless it is said. The error (bad_input) lists what is allowed.
Result<shading::Lobe> lobe_from_name(std::string_view name, const LobeParameters& parameters = {});

}  // namespace halflit::io
