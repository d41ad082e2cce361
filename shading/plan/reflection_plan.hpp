// Reflections of an environment as the kernels read them.
#pragma once

#include "shading/reflection_map.hpp"

#include <memory>

namespace halflit::shading {

/// A ReflectionMap, with its numbers as lanes take them. Keeps it alive.
struct ReflectionPlan {
    const float* rgba = nullptr;  ///< null: nothing reflects an environment
    float rows[kReflectionLevels]{};
    std::int32_t first[kReflectionLevels]{};
    std::shared_ptr<const ReflectionMap> map;

    ReflectionPlan() = default;
    explicit ReflectionPlan(std::shared_ptr<const ReflectionMap> source) : rgba(source->rgba.data()->data()), map(std::move(source)) {
        for (int k = 0; k < kReflectionLevels; ++k) {
            rows[k] = static_cast<float>(map->rows[k]);
            first[k] = map->first[k];
        }
    }
};

}  // namespace halflit::shading
