// Instruction sets to test.
#pragma once

#include "shading/isa.hpp"

#include <vector>

namespace halflit::test {

/// Instruction sets that are built in and that this CPU runs, scalar first.
inline std::vector<shading::Isa> available_isas() {
    std::vector<shading::Isa> isas;
    for (const shading::Isa isa : shading::built_isas())
        if (shading::isa_available(isa)) isas.push_back(isa);
    return isas;
}

}  // namespace halflit::test
