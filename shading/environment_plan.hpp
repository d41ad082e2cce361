// What the kernels and the planner need to know of light from all around.
#pragma once

#include "sh/basis.hpp"

namespace halflit::shading {

/// How a lobe takes light from an environment, as the kernels read it: at unit normal N the sum of c[i] Y_i(N), not below 0.
struct EnvironmentPlan {
    int bands = 0;         ///< 1..10
    double bound = 0.0;    ///< of the error of leaving out the others, any normal, worst channel, before exposure
    bool within = true;    ///< whether that is within the tolerance asked for
    alignas(64) float red[sh::kMaxCoefficients]{};
    float green[sh::kMaxCoefficients]{}, blue[sh::kMaxCoefficients]{};
};

/// How many bands to use.
struct EnvironmentOrder {
    int fixed = 0;              ///< 1..10, or 0: the smallest whose bound is within the tolerance
    double tolerance = 1.0 / 510.0;  ///< of display white, in linear light: half an 8-bit code
    double exposure = 1.0;      ///< display white is 1 / exposure
};

}  // namespace halflit::shading
