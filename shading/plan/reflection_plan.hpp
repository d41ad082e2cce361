// Reflections of an environment as the kernels read them.
#pragma once

#include "sh/trig.hpp"
#include "shading/reflection_map.hpp"

#include <memory>

namespace halflit::shading {

class ImageLight;

/// A ReflectionMap, with its numbers as lanes take them. Keeps it alive.
struct ReflectionPlan {
    const float* rgba = nullptr;  ///< null: nothing reflects an environment
    float rows[kReflectionLevels]{};
    std::int32_t first[kReflectionLevels]{};
    float turned = 0;  ///< of the environment about +y (EnvironmentOptions): share of a full turn that a longitude grows by, in [0, 1]
    std::shared_ptr<const ReflectionMap> map;
    std::shared_ptr<const ImageLight> light;  ///< whose map it is

    ReflectionPlan() = default;
    ReflectionPlan(std::shared_ptr<const ReflectionMap> source, std::shared_ptr<const ImageLight> image, double rotate_rad)
        : rgba(source->rgba.data()->data()), map(std::move(source)), light(std::move(image)) {
        const double turns = rotate_rad / (2.0 * kPi);  // longitudes fall as sh::rotation_about_y turns
        turned = static_cast<float>(turns - __builtin_floor(turns));
        for (int k = 0; k < kReflectionLevels; ++k) {
            rows[k] = static_cast<float>(map->rows[k]);
            first[k] = map->first[k];
        }
    }
};

}  // namespace halflit::shading
