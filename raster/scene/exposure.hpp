// Automatic exposure. It depends on the lights and the scene's bounds, never on pixels: a crop, a tile or a second frame of the same scene
// keeps its values. Only + - * / and sqrt: the same bits on every machine.
#pragma once

#include "raster/scene/scene.hpp"

namespace halflit::raster {

/// Estimate of the light at the centre of the bounds, irradiance / pi: the sum over the lights of what a surface there receives that faces
/// the light. Directional: its colour. Point and spot: colour / max(distance from the centre, radius of the bounds / 2, 1e-4)^2, as if the
/// centre were in the cone. A light whose range does not reach the bounds adds nothing.
[[nodiscard]] Vec3f light_level(const Scene& scene, const Bounds& bounds);

/// Factor that scales the luminance (Rec. 709) of light_level to 1. So white surfaces come out near white, whatever unit the file's lights
/// are in. 1 if there is no light, or if its luminance is outside (1e-18, 1e18).
[[nodiscard]] float auto_exposure(const Scene& scene, const Bounds& bounds);

/// Ambient light for a scene whose lights leave the far sides black: a tenth of light_level from above, a twentieth from below.
[[nodiscard]] shading::Ambient soft_ambient(const Scene& scene, const Bounds& bounds);

/// 2^ev: each step of 1 doubles the light. Exact for whole numbers, otherwise within one float ulp. ev in [-64, 64], clamped.
[[nodiscard]] float exposure_factor(float ev);

}  // namespace halflit::raster
