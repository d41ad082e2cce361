#include "shading/plan/texture_plan.hpp"

#include <algorithm>

namespace halflit::shading {

TexturePlan plan_texture(const TextureUse& use, std::span<const Texture> textures, SlotMask available, const ShadingSettings& options) {
    const TextureDetail detail = options.texture_detail;
    TexturePlan plan{};
    if (use.texture < 0 || static_cast<std::size_t>(use.texture) >= textures.size()) return plan;
    const Texture& texture = textures[static_cast<std::size_t>(use.texture)];
    if (texture.levels().empty()) return plan;
    plan.data = texture.data().data();
    plan.source = &texture;
    plan.level_count = static_cast<std::int32_t>(texture.levels().size());
    for (std::size_t l = 0; l < texture.levels().size(); ++l) {
        plan.width[l] = texture.levels()[l].width;
        plan.height[l] = texture.levels()[l].height;
        plan.offset[l] = texture.levels()[l].offset;
    }
    plan.uv_set = use.uv_set == 1 ? 1 : 0;
    Vec3f row_u = use.row_u, row_v = use.row_v;
    if (plan.uv_set == 1 && (available & kUv1Slot) == 0) {
        // No mesh of the material has this set: its coordinates read as (0, 0), to which the transform still applies.
        plan.uv_set = 0;
        row_u = {0, 0, row_u.z};
        row_v = {0, 0, row_v.z};
    }
    plan.transform = !(row_u == Vec3f{1, 0, 0} && row_v == Vec3f{0, 1, 0});
    plan.row_u[0] = row_u.x, plan.row_u[1] = row_u.y, plan.row_u[2] = row_u.z;
    plan.row_v[0] = row_v.x, plan.row_v[1] = row_v.y, plan.row_v[2] = row_v.z;
    plan.wrap_u = use.sampler.wrap_u;
    plan.wrap_v = use.sampler.wrap_v;
    plan.mag = use.sampler.mag;
    plan.min = use.sampler.min;
    plan.mip = use.sampler.mip;
    if (detail != TextureDetail::full && plan.mip == MipFilter::linear) plan.mip = MipFilter::nearest;
    if (detail == TextureDetail::nearest) plan.mag = plan.min = TextureFilter::nearest;
    const bool smooth = plan.mag == TextureFilter::linear && plan.min == TextureFilter::linear && plan.mip == MipFilter::linear;
    plan.anisotropy = smooth && plan.level_count > 1 ? options.anisotropy : 1;
    plan.needs_lod = (plan.mip != MipFilter::none && plan.level_count > 1) || plan.mag != plan.min;
    return plan;
}

bool same_taps(const TexturePlan& a, const TexturePlan& b) {
    return a.level_count == b.level_count && a.width[0] == b.width[0] && a.height[0] == b.height[0] && a.uv_set == b.uv_set &&
           a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v && a.mag == b.mag && a.min == b.min && a.mip == b.mip &&
           a.anisotropy == b.anisotropy && std::equal(a.row_u, a.row_u + 3, b.row_u) && std::equal(a.row_v, a.row_v + 3, b.row_v);
}

bool same_fetch(const TexturePlan& a, const TexturePlan& b) { return a.data == b.data && same_taps(a, b); }

}  // namespace halflit::shading
