// Instruction sets to test.
#pragma once

#include "halflit/isa.hpp"

#include <vector>

namespace halflit::test {

/// Instruction sets that are built in and that this CPU runs, scalar first.
inline std::vector<Isa> available_isas() {
    std::vector<Isa> isas;
    for (const Isa isa : built_isas())
        if (isa_available(isa)) isas.push_back(isa);
    return isas;
}

}  // namespace halflit::test
