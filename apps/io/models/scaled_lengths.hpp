// Lengths of cameras and lights in another unit: between a file's, and that of the world in which a Placement draws it.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/light.hpp"

#include <algorithm>

namespace halflit::io {

inline constexpr double kLargestLength = 3e38;  ///< a finite float

[[nodiscard]] inline float scaled(float length, double factor) {
    return static_cast<float>(std::clamp(double{length} * factor, -kLargestLength, kLargestLength));
}

inline void scale_lengths(Camera& camera, double factor) {
    for (float* const length : {&camera.near_z, &camera.far_z, &camera.half_height, &camera.half_width}) *length = scaled(*length, factor);
    if (!camera.orthographic || !camera.sides) return;
    for (float* const side : {&camera.sides->left, &camera.sides->right, &camera.sides->bottom, &camera.sides->top})
        *side = scaled(*side, factor);
}

/// A light's lengths and its colour, which falls with the squared distance.
inline void scale_lengths(Light& light, double factor) {
    if (!kind_of(light.type).placed) return;
    for (float* const length : {&light.range, &light.source_radius, &light.shadow_radius}) *length = scaled(*length, factor);
    for (float* const channel : {&light.color_linear.x, &light.color_linear.y, &light.color_linear.z})
        *channel = scaled(*channel, factor * factor);
}

}  // namespace halflit::io
