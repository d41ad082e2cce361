// Textures as the kernels read them.
#pragma once

#include "halflit/material.hpp"
#include "halflit/shading.hpp"
#include "halflit/texture.hpp"
#include "shading/fragment_block.hpp"

#include <cstdint>
#include <span>

namespace halflit::shading {

/// A texture as a kernel sees it. Texel (x, y) of level l: data + 4 * (offset[l] + y * width[l] + x).
struct TexturePlan {
    const std::uint16_t* data = nullptr;  ///< null: not used
    const Texture* source = nullptr;      ///< used for bounds only
    std::int32_t level_count = 0;
    std::int32_t width[kMaxTextureLevels], height[kMaxTextureLevels], offset[kMaxTextureLevels];
    float row_u[3], row_v[3];  ///< texture transform
    std::int32_t uv_set = 0;
    std::int32_t taps = 0;  ///< equal for textures of a material that are read at the same places; 0: not used
    /// Texels that anisotropic filters fetch ahead: of this texture and those after it with the same taps, if they are large.
    const std::uint16_t* ahead[kTextureSlots];
    std::int32_t ahead_count = 0;
    bool transform = false;  ///< row_u, row_v are not the identity
    bool needs_lod = false;  ///< the kDu.. rows decide which level or which filter
    TextureWrap wrap_u, wrap_v;
    TextureFilter mag, min;
    MipFilter mip;
    std::int32_t anisotropy = 1;  ///< largest ratio of a footprint's length to its width that is filtered along its length
};

inline constexpr int kMostAnisotropy = 16;

/// Plans one use of a texture; `data` is null where the material has none. `available`: attribute slots that the material's meshes have.
[[nodiscard]] TexturePlan plan_texture(const TextureUse& use, std::span<const Texture> textures, SlotMask available,
                                       const ShadingSettings& options);

/// True if both read texels at the same places with the same weights: sizes, coordinates and filters are equal.
[[nodiscard]] bool same_taps(const TexturePlan& a, const TexturePlan& b);

/// True if both read the same texels in the same way, so that one fetch serves both.
[[nodiscard]] bool same_fetch(const TexturePlan& a, const TexturePlan& b);

}  // namespace halflit::shading
