// Lengths of cameras and lights in another unit: between a file's, and that of the world in which a Placement draws it.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/light.hpp"

#include <algorithm>
#include <cstdint>

namespace halflit::io {

inline constexpr double kLargestLength = 3e38;  ///< a finite float

[[nodiscard]] inline float scaled(float length, double factor) {
    return static_cast<float>(std::clamp(double{length} * factor, -kLargestLength, kLargestLength));
}

/// Quantities of light_members.def and camera_members.def.
enum class Quantity : std::uint8_t { number, truth, color, place, direction, angle, length };
template <Quantity quantity, class T>
void scale_length(T& value, double factor) {
    if constexpr (quantity == Quantity::length) value = scaled(value, factor);
}

inline void scale_lengths(Camera& camera, double factor) {
#define HALFLIT_CAMERA(member, quantity, ...) scale_length<Quantity::quantity>(camera.member, factor);
#include "raster/camera_members.def"
    if (!camera.orthographic || !camera.sides) return;
    for (float* const side : {&camera.sides->left, &camera.sides->right, &camera.sides->bottom, &camera.sides->top})
        *side = scaled(*side, factor);
}

/// A light's lengths and its colour, which falls with the squared distance.
inline void scale_lengths(Light& light, double factor) {
    if (!kind_of(light.type).placed) return;
#define HALFLIT_LIGHT(member, name, having, quantity, ...) scale_length<Quantity::quantity>(light.member, factor);
#include "shading/light_members.def"
    for (float* const channel : {&light.color_linear.x, &light.color_linear.y, &light.color_linear.z})
        *channel = scaled(*channel, factor * factor);
}

}  // namespace halflit::io
