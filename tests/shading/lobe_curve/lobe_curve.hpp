// The lobe as the kernels compute it, for any x = N.L instead of a normal and a light, on each instruction set.
#pragma once

#include "halflit/isa.hpp"
#include "shading/plan/plan.hpp"

namespace halflit::testing {

/// Lobe values f(x), scale included. count: a multiple of 16.
using LobeCurve = void (*)(const shading::LobePlan& lobe, const float* x, float* out, int count);

LobeCurve lobe_curve(Isa isa);

}  // namespace halflit::testing
