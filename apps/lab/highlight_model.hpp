// Light that a surface with a diffuse part and a highlight reflects of one directional light: in one direction, and altogether.
#pragma once

#include <cstdint>

namespace halflit::cli {

/// A material of the shading model, and the four forms of its highlight.
struct HighlightModel {
    double diffuse = 0;   ///< kd: the light reflected by Lambert's lobe, in all directions alike
    double specular = 1;  ///< ks: the highlight's factor, F0 of the shading model
    double exponent = 1;  ///< s of Blinn's (N.H)^s; Phong's (R.V)^p has p = s / 4, the same width near its peak
    bool phong = false;
    bool times_cosine = true;  ///< the highlight is multiplied by N.L, as in halflit; [CMSC] does not
};

/// Radiance reflected of a light of colour 1. light_rad: angle between the normal and the light, below pi/2. view_cosine: N.V, above 0.
/// turn_rad: azimuth of the eye, 0 on the light's side of the normal, pi opposite to it.
[[nodiscard]] double reflected_radiance(const HighlightModel& model, double light_rad, double view_cosine, double turn_rad);

/// Energy reflected into the hemisphere as a share of the energy received: the integral of radiance times N.V, over pi N.L.
[[nodiscard]] double reflected_share(const HighlightModel& model, double light_rad);

}  // namespace halflit::cli
