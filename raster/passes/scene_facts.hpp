// What an error budget has to know of a scene: how close its surfaces come to its lights, and how bright vertex colours are.
#pragma once

#include "raster/passes/frame.hpp"
#include "shading/budget/error_budget.hpp"

namespace halflit::raster {

/// Needs the frame's plan and draws.
[[nodiscard]] shading::SceneFacts scene_facts(const Frame& frame);

}  // namespace halflit::raster
