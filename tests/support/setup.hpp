// Settings and execution in one, for tests that vary both.
#pragma once

#include "halflit/settings.hpp"

namespace halflit::test {

struct Setup : Settings {
    Execution execution;
};

}  // namespace halflit::test
