// How bright the picture is made. Exposure is chosen from the lights and the scene's bounds, never from pixels: a crop, a tile or a
// second frame of the same scene keeps its values. Only + - * / and sqrt: the same bits on every machine.
#pragma once

#include "raster/scene/scene.hpp"

namespace halflit::raster {

/// An estimate of the light that falls on the middle of the scene, irradiance/pi: the sum over lights of what a surface there that faces
/// the light receives. Directional: its colour. Point and spot: colour / max(distance from the centre, radius / 2)^2, as if the centre
/// were in the cone; nothing from a light whose range does not reach the bounds.
[[nodiscard]] Vec3f light_level(const Scene& scene, const Bounds& bounds);

/// Factor that brings the luminance (Rec. 709) of light_level to 1, so that white surfaces end near white whatever unit the file's
/// lights are in. 1 when there is no light, or no finite amount of it.
[[nodiscard]] float auto_exposure(const Scene& scene, const Bounds& bounds);

/// Ambient for a scene whose lights leave the far sides black: a small, fixed share of light_level, more from above than from below.
[[nodiscard]] shading::Ambient soft_ambient(const Scene& scene, const Bounds& bounds);

/// 2^ev: each step of 1 doubles the light. Exact for whole numbers, otherwise within one float ulp. ev in [-64, 64], clamped.
[[nodiscard]] float exposure_factor(float ev);

}  // namespace halflit::raster
