// Cameras and lights, placed by the nodes.
#pragma once

#include "apps/io/gltf/build/nodes.hpp"
#include "halflit/scene.hpp"

#include <optional>

namespace halflit::io::detail {

/// Add cameras and lights in the order of the drawn nodes, and their indices to the nodes. One with invalid values is left out with a
/// warning.
void place_cameras(Document& document, const NodeTree& tree, LoadedScene& loaded);
void place_lights(Document& document, const NodeTree& tree, LoadedScene& loaded);

/// Sets a camera's projection. False if a value is out of range. scale: of the drawn world.
bool set_projection(const file::Camera& source, double scale, Camera& camera);
/// A camera without values out of range, in a world that is not scaled.
[[nodiscard]] bool is_valid(const file::Camera& source);

/// The light, not placed; nothing if its type is unknown. KHR_lights_punctual gives lux (directional) and candela (point, spot); colours
/// here are those values divided by pi. scale: of the drawn world; a point light falls with the squared distance.
[[nodiscard]] std::optional<Light> light_of(const file::Light& source, double scale);

/// The node's place and its view direction (-z), with scale, shear and mirroring taken out: z is kept, y is made orthogonal to it.
[[nodiscard]] Mat4 rigid_part(const Affine& world);
/// Sets a light's position and direction.
void place(const Affine& world, Light& light);

}  // namespace halflit::io::detail
