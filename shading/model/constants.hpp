// Numbers of the shading model that more than one place needs.
#pragma once

namespace halflit::shading {

/// Least roughness; smaller ones count as this. Its exponent is 8.3e4, the sharpest highlight that float32 normals still resolve.
inline constexpr float kMinRoughness = 0.07f;
/// GGX gives no highlight where N.(L + V) is less: both are within 0.06 degrees of the surface, where the half vector has few digits left.
inline constexpr float kLeastHalfVector = 1e-3f;
/// F0 of a coat: an index of refraction of 1.5.
inline constexpr float kCoatReflectance = 0.04f;
/// Least distance to a light; smaller ones count as this, whatever the light's radius.
inline constexpr float kMinSourceRadius = 1e-4f;
/// The largest power of the cosine to a spot's axis.
inline constexpr float kMaxConePower = 1e5f;

/// Inverse square of the length below which the direction of a brushed surface counts less.
inline constexpr float kShortDirection = 4.0f;
/// Reflections of a brushed surface: mirrors whose normals lean along its direction, by shares of the root of along^2 - across^2, alphas of
/// both. Fitted to integrals over three skies, roughness 0.2 to 0.6, strength 0.4 to 1.
struct StretchTap {
    float place, weight;
};
constexpr StretchTap kStretchTaps[] = {{-1.035f, 0.204f}, {-0.524f, 0.296f}, {0.524f, 0.296f}, {1.035f, 0.204f}};
/// alpha^2 of each of these mirrors, besides across^2, is the square of this share.
inline constexpr float kStretchWidth = 0.152f;
/// Least N.V of these mirrors.
inline constexpr float kStretchEdge = 0.001f;

}  // namespace halflit::shading
