// A white diffuse surface of one lobe under one directional light of colour 1: a fragment's light is the lobe's value.
#pragma once

#include "shading/planner.hpp"

#include <span>
#include <vector>

namespace halflit::test {

/// The light comes from +x, so x of a unit normal is N.L.
inline shading::ShadingPlan plan_of_white(const Lobe& lobe) {
    Material material;
    material.metallic = 0;
    material.lobe = lobe;
    const Light light{.direction_ws = {-1, 0, 0}};
    const std::vector<shading::SlotMask> available{3u, 3u};
    ShadingSettings options;
    options.specular = SpecularModel::none;
    return shading::plan_shading({std::span(&material, 1), {}, available, shading::plan_lights(std::span(&light, 1)), {}, options});
}

}  // namespace halflit::test
