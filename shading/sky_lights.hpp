// The light of the surroundings as lights in a few directions, for sky shadows: whether a surface sees each of them is looked up in a
// shadow map, and weighted by what the lobe receives from there.
#pragma once

#include "halflit/light.hpp"
#include "shading/environment.hpp"

#include <memory>
#include <vector>

namespace halflit::shading {

/// Fewest and most directions of Settings::sky_shadows.
inline constexpr int kLeastSkyDirections = 16, kMostSkyDirections = 1024;

/// n unit vectors spread evenly over the sphere: a spherical Fibonacci lattice about +y [Kein15].
[[nodiscard]] std::vector<Vec3d> sky_directions(int n);

/// The light of an environment's image in the cells of a grid over the sphere. Kept from frame to frame, as an image may have millions of
/// pixels.
struct SkyCells {
    std::shared_ptr<const ImageLight> light;  ///< whose image the cells are of; null: other cells, or none
    std::vector<Vec3d> cells;                 ///< radiance times solid angle, in the image's frame
};

/// Directional lights from sky_directions(n). Each has the light of the part of the sphere that is nearest to it, mean radiance times solid
/// angle over pi. An environment gives the radiance of its image without the suns, turned by its rotation. Ambient light is light through a
/// Lambert lobe already: it gives the radiance that this lobe would make it of, or 0 where that is negative. rows: of the grid whose cells
/// are given to the directions; it has twice as many columns.
[[nodiscard]] std::vector<Light> sky_lights(int n, int rows, const Environment* environment, const Ambient& ambient, SkyCells& kept);

}  // namespace halflit::shading
