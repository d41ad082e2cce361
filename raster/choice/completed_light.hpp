// The light of auto_setup(), for callers that have a camera and need nothing else of it.
#pragma once

#include "halflit/auto_setup.hpp"

namespace halflit::raster {

struct CompletedLight {
    Lighting light;
    float exposure = 1.0f;  ///< chosen by it, whatever exposure the options give
};

/// The options' light, or else the scene's, with what it lacks. bounds: scene_bounds(scene).
[[nodiscard]] CompletedLight completed_light(const Scene& scene, const Bounds& bounds, const Camera& camera, const AutoOptions& options);

}  // namespace halflit::raster
