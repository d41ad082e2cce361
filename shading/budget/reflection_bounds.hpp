// How fast the levels of an environment's map change with direction, and from level to level.
#pragma once

#include "shading/reflection_map.hpp"

namespace halflit::shading {

/// Largest slopes or steps, as radiance and as a share of the smaller value (infinite where that is 0).
struct ReflectionSteps {
    struct Step {
        double absolute = 0, relative = 0;
    };
    double most = 0;                    ///< largest value
    Step angle[kReflectionLevels];      ///< per radian, within a level
    Step level[kReflectionLevels - 1];  ///< from a level to the next one, at any point
};
[[nodiscard]] ReflectionSteps reflection_steps(const ReflectionMap& map);

}  // namespace halflit::shading
