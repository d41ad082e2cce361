// The shapes that MuJoCo's classic renderer draws primitives with, with its triangles, since light is computed at their corners.
#pragma once

#include "halflit/mesh.hpp"

namespace halflit::engine::mujoco {

/// All reach from -1 to 1 on the axes that they have, but: caps are spheres around the origin moved by 1 along z (the upper one) or -1,
/// of which the outer half is there; a cone has its base at z = 0 and its tip at 1; a line goes from the origin to 1 on z; haze is a cone
/// without its tip, from z = 0 to 1, where its radius is 1.
enum class Shape {
    plane,
    box,
    box_top,
    box_rest,
    sphere,
    upper_cap,
    lower_cap,
    cylinder,
    tube,
    cone,
    line,
    line_box,
    triangle,
    haze,
    count
};

/// vis.quality, and vis.map.haze.
struct Fineness {
    int slices = 28, stacks = 16, quads = 4;
    float haze = 0.3f;
    Vec3f haze_color{1, 1, 1};
    bool has_uv = false;  ///< round shapes, boxes and triangles have texture coordinates, as from 3.12 on
};

[[nodiscard]] Mesh make_shape(Shape shape, const Fineness& fineness);

}  // namespace halflit::engine::mujoco
