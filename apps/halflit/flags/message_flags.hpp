// --verbose and --quiet.
#pragma once

#include "apps/engine/request/flags.hpp"
#include "apps/halflit/program/messages.hpp"

namespace halflit::cli {

[[nodiscard]] inline std::vector<Flag> message_flags() {
    const auto choose = [](Verbosity chosen) -> ReadValue {
        return [chosen](const std::string&) -> Result<void> {
            set_verbosity(chosen);
            return {};
        };
    };
    return {{"-v,--verbose", "", "Also say what was chosen and how long each step took", choose(Verbosity::verbose)},
            {"-q,--quiet", "", "Print errors alone, no warnings, notes or progress", choose(Verbosity::quiet)}};
}

}  // namespace halflit::cli
