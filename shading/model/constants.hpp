// Numbers of the shading model that more than one place needs.
#pragma once

namespace halflit::shading {

/// Least roughness; smaller ones count as this. Its exponent is 8.3e4, the sharpest highlight that float32 normals still resolve.
inline constexpr float kMinRoughness = 0.07f;
/// GGX gives no highlight where N.(L + V) is less: both are within 0.06 degrees of the surface, where the half vector has few digits left.
inline constexpr float kLeastHalfVector = 1e-3f;
/// F0 of a coat: an index of refraction of 1.5.
inline constexpr float kCoatReflectance = 0.04f;
/// Least distance to a lamp; smaller ones count as this, whatever the lamp's radius.
inline constexpr float kMinSourceRadius = 1e-4f;
/// The largest power of the cosine to a spot's axis.
inline constexpr float kMaxConePower = 1e5f;

}  // namespace halflit::shading
