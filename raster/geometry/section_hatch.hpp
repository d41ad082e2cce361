// Materials of caps.
#pragma once

#include "halflit/scene.hpp"
#include "halflit/section.hpp"

#include <map>
#include <tuple>

namespace halflit::raster {

/// Texture coordinates of a point of a cap are hatch_scale() times its coordinates in the plane.
[[nodiscard]] double hatch_scale(double spacing, int part);

/// Adds materials of caps to a scene, and the textures of hatches with the first ones.
class CapMaterials {
public:
    CapMaterials(Scene& scene, bool hatch) : scene_(scene), hatch_(hatch) {}
    /// Index of a material, a new one where none looks the same: rough, not metallic, in the colour of the instance. color: factor for the
    /// mesh's colours.
    [[nodiscard]] int add(const Instance& instance, Vec3f color, int part);

private:
    [[nodiscard]] int texture(bool falls);

    Scene& scene_;
    bool hatch_;
    int textures_[2] = {-1, -1};
    std::map<std::tuple<int, bool, float, float, float>, int> made_;  // by material of the instance, direction of lines, and colour
};

}  // namespace halflit::raster
