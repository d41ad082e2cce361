// Surface properties at each lane: colour and alpha, shading normal, metallic and roughness.
#pragma once

#include "shading/kernels/anisotropic_kernel.hpp"
#include "shading/kernels/vector.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

HALFLIT_INLINE bool has(const shading::MaterialPlan& material, Stage stage) { return (material.stages & stage) != 0; }

/// Base colour factor * texture * vertex colour, with alpha; `a` is what MASK compares and BLEND uses.
HALFLIT_INLINE Sample base_color(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int lane, TexelTaps& taps) {
    Sample color{F(material.base_color[0]), F(material.base_color[1]), F(material.base_color[2]), F(material.base_color[3])};
    if (has(material, kStageBaseColorTexture)) {
        const Sample texture = sample_texture(material.textures[TextureSlot::base_color], block, lane, taps);
        color = {color.r * texture.r, color.g * texture.g, color.b * texture.b, color.a * texture.a};
    }
    if (has(material, kStageVertexColor)) {
        color = {color.r * row(block, shading::kColorR, lane), color.g * row(block, shading::kColorG, lane),
                 color.b * row(block, shading::kColorB, lane), color.a * row(block, shading::kColorA, lane)};
    }
    return color;
}

/// A unit normal turned by a texel of a normal map, about the tangent at a lane.
HALFLIT_INLINE V3 mapped_normal(const shading::FragmentBlock& block, int lane, V3 normal, V3 texel, float scale) {
    const V3 tangent = normalize_any(row3(block, shading::kTangentX, lane));
    const V3 bitangent = cross(normal, tangent) * row(block, shading::kTangentW, lane);
    const F x = mad(F(2.0f), texel.x, F(-1.0f)) * F(scale);
    const F y = mad(F(2.0f), texel.y, F(-1.0f)) * F(scale);
    const F z = mad(F(2.0f), texel.z, F(-1.0f));
    return normalize((tangent * x + bitangent * y) + normal * z);
}

/// Unit normals, turned to the visible side: `surface` without the normal map, `shading` with it.
struct Normals {
    V3 surface, shading;
};
/// `texel`: the normal map's red, green and blue; unused without one.
HALFLIT_INLINE Normals normals(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int lane, V3 texel) {
    V3 surface = normalize_any(row3(block, shading::kNormalX, lane));
    V3 normal = surface;
    if (has(material, kStageNormalMap)) normal = mapped_normal(block, lane, normal, texel, material.normal_scale);
    if (material.double_sided) {
        const F facing = row(block, shading::kFacing, lane);
        surface = surface * facing;
        normal = normal * facing;
    }
    return {surface, normal};
}
HALFLIT_INLINE Normals normals(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int lane, TexelTaps& taps) {
    V3 texel{F(0.0f), F(0.0f), F(0.0f)};
    if (has(material, kStageNormalMap)) {
        const Sample texture = sample_texture(material.textures[TextureSlot::normal], block, lane, taps);
        texel = {texture.r, texture.g, texture.b};
    }
    return normals(material, block, lane, texel);
}

/// Roughness r >= kMinRoughness of a surface whose normals were filtered. lost: the root of what is added to alpha^2 = r^4 for that
/// (MomentLevels), 0 where nothing is lost; then it is r itself.
HALFLIT_INLINE F rougher(F roughness, F lost) {
    const F squared = roughness * roughness, more = lost * lost;
    const F wider = vmin(vsqrt(vsqrt(mad(squared, squared, more))), F(1.0f));
    return sel(more > F(0.0f), wider, roughness);
}

/// Metallic-roughness parameters and the occlusion of ambient light.
struct Reflectance {
    F metallic, roughness, occlusion;
};
HALFLIT_INLINE Reflectance reflectance(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int lane,
                                       TexelTaps& taps) {
    Reflectance result{F(material.metallic), F(material.roughness), F(1.0f)};
    F occlusion_texture(1.0f);
    if (has(material, kStageMetallicRoughnessTexture)) {
        const Sample texture = sample_texture(material.textures[TextureSlot::metallic_roughness], block, lane, taps);
        result.roughness = result.roughness * texture.g;
        result.metallic = result.metallic * texture.b;
        occlusion_texture = texture.r;
    }
    if (has(material, kStageOcclusionTexture)) {
        if (!material.occlusion_is_metallic_roughness)
            occlusion_texture = sample_texture(material.textures[TextureSlot::occlusion], block, lane, taps).r;
        result.occlusion = mad(F(material.occlusion_strength), occlusion_texture - F(1.0f), F(1.0f));
    }
    return result;
}

HALFLIT_INLINE V3 emitted(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int lane, TexelTaps& taps) {
    V3 emissive = broadcast(material.emissive);
    if (has(material, kStageEmissiveTexture)) {
        const Sample texture = sample_texture(material.textures[TextureSlot::emissive], block, lane, taps);
        emissive = emissive * V3{texture.r, texture.g, texture.b};
    }
    return emissive;
}

/// Unit vector from the surface to the viewer.
HALFLIT_INLINE V3 view_vector(const shading::ShadingPlan& frame, V3 position) {
    if (frame.orthographic) return V3{F(0.0f), F(0.0f), F(0.0f)} - broadcast(frame.view_direction_ws);
    return normalize_any(broadcast(frame.eye_ws) - position);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
