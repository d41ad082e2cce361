// The pieces of the built-in scene, made by code: a studio backdrop, a torus knot, a round plinth and its mosaic. Only + - * / sqrt
// and sh/trig.hpp, so that the picture has the same pixels everywhere.
#pragma once

#include "halflit/mesh.hpp"
#include "halflit/texture.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::raster::detail {

/// A ball or an upright cylinder that stands on the floor and hides part of the sky from its surroundings.
struct Occluder {
    Vec3f foot;  ///< point of the floor below its centre
    float radius = 0.5f;
    float height = 0.0f;  ///< height of the cylinder; 0: a ball
};

/// Floor and back wall in one sheet, joined by a quarter circle, `half_width` to both sides. Vertex colours are `tint` darkened by
/// the share of the sky that the occluders hide (closed forms: a ball, and a wall as high as the cylinder).
[[nodiscard]] Mesh make_cyclorama(float half_width, Vec3f tint, std::span<const Occluder> occluders);

/// A trefoil knot, a tube whose middle runs on a torus around the z axis. Radii: `radius` and `swing` of the torus, `tube` of the tube.
[[nodiscard]] Mesh make_trefoil(float radius, float swing, float tube, int slices, int sides);

/// The side of a plinth on y = 0, with tangents. u repeats `repeats` times around the side; v runs once from top to bottom.
[[nodiscard]] Mesh make_plinth_side(float radius, float height, int repeats, int slices);

/// The plinth's lid, from y = 0 to 2 * lip: overhangs by `lip`, with a rounded rim of that radius. Vertex colours are white, darkened
/// around `contact`, the round body that stands on it.
[[nodiscard]] Mesh make_plinth_lid(float radius, float lip, int slices, const Occluder& contact);

/// Textures of glazed tiles, 64 texels each, that repeat in both directions. RGBA, 8 bits.
struct Mosaic {
    int width = 0, height = 0;
    std::vector<std::uint8_t> color_srgb;       ///< base colour
    std::vector<std::uint8_t> normal;           ///< tangent space: bevelled tiles, each slightly tilted
    std::vector<std::uint8_t> roughness_metal;  ///< G roughness, B metallic: glaze, gilt, joints
};
[[nodiscard]] Mosaic make_mosaic(int columns, int rows);

}  // namespace halflit::raster::detail
