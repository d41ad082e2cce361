// Checks and changes of what decides how a frame is computed.
#pragma once

#include "halflit/settings.hpp"

namespace halflit::raster {

/// The instruction set to use. Fails (usage) for a tile size that is not offered, and for an instruction set that this CPU does not run.
[[nodiscard]] Result<Isa> check_execution(const Execution& execution);

/// The execution of the rest of a call, of which this many seconds are gone.
[[nodiscard]] Execution with_time_left(Execution execution, double spent_s);

}  // namespace halflit::raster
