// Reflections of an environment as the kernels read them.
#pragma once

#include "sh/trig.hpp"
#include "shading/reflection_map.hpp"

#include <memory>

namespace halflit::shading {

class ImageLight;

/// Share of a full turn, in [0, 1], that longitudes grow by where sh::rotation_about_y turns an environment: they fall as it turns.
inline float turned_share(double rotate_rad) {
    const double turns = rotate_rad / (2.0 * kPi);
    return static_cast<float>(turns - __builtin_floor(turns));
}

/// A ReflectionMap, with its numbers as lanes take them. Keeps it alive.
struct ReflectionPlan {
    const float* rgba = nullptr;  ///< null: nothing reflects an environment
    float rows[kReflectionLevels]{};
    std::int32_t first[kReflectionLevels]{};
    float turned = 0;  ///< turned_share() of the environment
    std::shared_ptr<const ReflectionMap> map;
    std::shared_ptr<const ImageLight> light;  ///< whose map it is

    ReflectionPlan() = default;
    ReflectionPlan(std::shared_ptr<const ReflectionMap> source, std::shared_ptr<const ImageLight> image, double rotate_rad)
        : rgba(source->rgba.data()->data()), map(std::move(source)), light(std::move(image)) {
        turned = turned_share(rotate_rad);
        for (int k = 0; k < kReflectionLevels; ++k) {
            rows[k] = static_cast<float>(map->rows[k]);
            first[k] = map->first[k];
        }
    }
};

}  // namespace halflit::shading
