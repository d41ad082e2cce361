// Random materials, textures, lights and fragment blocks: one draw of everything that a shading kernel can be given.
#pragma once

#include "floats.hpp"
#include "shading/budget/power_fit.hpp"
#include "shading/material_properties.hpp"
#include "shading/planner.hpp"
#include "shading/reference/reference.hpp"

#include <vector>

namespace halflit::testing {

/// Textures of odd, even, tiny and larger sizes. `smooth` ones change little between neighbours, so that a coordinate's last bit hardly
/// changes the value.
inline std::vector<Texture> make_textures(FloatMaker& make, bool smooth) {
    std::vector<Texture> textures;
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 3}, {8, 8}, {13, 7}, {64, 32}, {1, 9}}) {
        std::vector<std::uint16_t> texels;
        for (int i = 0; i < width * height * 4; ++i)
            texels.push_back(static_cast<std::uint16_t>(smooth ? 30000 + make.below(2000) : make.below(65536)));
        textures.push_back(Texture::from_rgba16(texels, width, height, static_cast<MipRule>(make.below(3))).value());
    }
    return textures;
}

inline TextureUse make_use(FloatMaker& make) {
    using namespace shading;
    TextureUse use;
    use.texture = static_cast<int>(make.below(9)) - 2;  // -2, -1: not used; 6: no such texture
    use.uv_set = static_cast<int>(make.below(2));
    use.sampler.wrap_u = static_cast<TextureWrap>(make.below(3));
    use.sampler.wrap_v = static_cast<TextureWrap>(make.below(3));
    use.sampler.mag = static_cast<TextureFilter>(make.below(2));
    use.sampler.min = static_cast<TextureFilter>(make.below(2));
    use.sampler.mip = static_cast<MipFilter>(make.below(3));
    if (make.below(3) == 0) {
        use.row_u = {make.ordinary(-2, 2), make.ordinary(-2, 2), make.ordinary(-1, 1)};
        use.row_v = {make.ordinary(-2, 2), make.ordinary(-2, 2), make.ordinary(-1, 1)};
    }
    return use;
}

inline Lobe make_lobe(FloatMaker& make) {
    Lobe lobe;
    switch (make.below(8)) {
        case 0:
            lobe = Lobe::lambert();
            break;
        case 1:
            lobe = Lobe::green(make.ordinary(0, 1));
            break;
        case 2:
            lobe = Lobe::valve();
            break;
        case 3:
            lobe = Lobe::sloan(0.5f);
            break;
        case 4:
            lobe = Lobe::sloan(make.ordinary(0, 1));
            break;
        case 5:
            lobe = {make.ordinary(0, 1), 0.0f, false};
            break;
        case 6:
            lobe = {make.ordinary(0, 1), static_cast<float>(3 + make.below(5)), false};
            break;
        default:
            lobe = Lobe::mcauley(make.ordinary(0, 1), make.ordinary(0.2f, 9.0f));
            break;
    }
    lobe.normalize = lobe.normalize || make.below(4) == 0;
    return lobe;
}

/// Any material: each property of the table is its default, an end of its range, or between.
inline Material make_material(FloatMaker& make) {
    using namespace shading;
    Material material;
    for (const MaterialNumber& number : kMaterialNumbers) {
        if (make.below(2) == 0) continue;
        float values[4];
        const float low = std::max(number.low, 0.0f), high = std::min(number.high, 2.0f);
        for (int c = 0; c < number.count; ++c)
            values[c] = make.below(4) == 0 ? (make.below(2) == 0 ? low : high) : make.ordinary(low, high);
        number.set(material, values);
    }
    if (make.below(8) == 0) material.specular_color.z = make.ordinary(0, 40);
    for (TextureUse& use : material.textures)
        if (make.below(2) == 0) use = make_use(make);
    // Each kind of layer is absent from half of the materials.
    for (unsigned bit = 0; bit < kStageCount; ++bit) {
        const std::size_t row = layer_row(static_cast<Stage>(1u << bit));
        if (row == kMaterialNumberCount) continue;
        float values[4];
        kMaterialNumbers[row].get(Material{}, values);
        if (values[0] == 0.0f && make.below(2) == 0) kMaterialNumbers[row].set(material, values);
    }
    if (make.below(3) != 0) {
        material.specular = 1, material.specular_color = {1, 1, 1};
        material.textures[TextureSlot::specular] = material.textures[TextureSlot::specular_color] = {};
    }
    material.alpha_mode = static_cast<AlphaMode>(make.below(3));
    material.double_sided = make.below(2) == 0;
    material.unlit = make.below(8) == 0;
    material.lobe = make_lobe(make);
    material.has_own_lobe = make.below(2) == 0;
    if (make.below(3) == 0) material.textures[TextureSlot::occlusion] = material.textures[TextureSlot::metallic_roughness];
    return material;
}

inline Light make_light(FloatMaker& make) {
    using namespace shading;
    Light light;
    light.type = static_cast<LightType>(make.below(3));
    light.color_linear = {make.ordinary(0, 3), make.ordinary(0, 3), make.ordinary(0, 3)};
    light.position_ws = {make.ordinary(-3, 3), make.ordinary(-3, 3), make.ordinary(-3, 3)};
    light.direction_ws = {make.ordinary(-1, 1), make.ordinary(-1, 1), make.ordinary(-1, 1)};
    light.range = make.below(2) == 0 ? 0.0f : make.ordinary(1, 6);
    light.source_radius = make.below(2) == 0 ? 0.0f : make.ordinary(0, 1);
    light.outer_cone_rad = make.ordinary(0.3f, 1.5f);
    light.inner_cone_rad = light.outer_cone_rad * make.ordinary(0, 0.9f);
    light.cone_power = make.below(2) == 0 ? 0.0f : make.ordinary(0, 60);
    return light;
}

/// Attribute rows for all lanes. `wild`: mixed with infinities, NaNs, denormals and random bits.
inline void fill_block(FloatMaker& make, shading::FragmentBlock& block, bool wild) {
    using namespace shading;
    const bool around = make.below(2) == 0;  // gradients of up to 0.1 or up to 0.01 a pixel
    for (int row = 0; row < kInputRows; ++row) {
        for (float& value : block.lane[row]) {
            float low = -1, high = 1;
            if (row <= kPosZ) low = -2, high = 2;
            if (row >= kColorR && row <= kColorA) low = 0;
            if (row >= kDu0Dx && row <= kDv1Dy) low = around ? -0.1f : -0.01f, high = around ? 0.1f : 0.01f;
            if (row == kTangentW || row == kFacing) {
                value = make.below(2) == 0 ? 1.0f : -1.0f;
                if (wild && make.below(16) == 0) value = make.wild(low, high);
            } else {
                value = wild ? make.wild(low, high) : make.ordinary(low, high);
            }
        }
    }
    if (!wild) return;
    // Adds zero vectors and coordinates far out.
    for (int lane = 0; lane < kBlockSize; lane += 5) {
        const int row = make.below(2) == 0 ? kNormalX : kTangentX;
        for (int i = 0; i < 3; ++i) block.lane[row + i][lane] = 0.0f;
        block.lane[kU0][lane] = make.ordinary(-1e7f, 1e7f);
        block.lane[kV1][lane] = make.ordinary(-300, 300);
    }
}

/// All that a frame shares.
struct Case {
    std::vector<Texture> textures;
    std::vector<Material> materials;
    std::vector<Light> lights;
    std::vector<shading::SlotMask> available;
    Ambient ambient;
    ShadingSettings options;
    std::vector<float> behind;  ///< what plan.behind reads
    shading::ShadingPlan plan;
};

/// Random surfaces behind glass, seen by a camera at z 5 that looks down -z.
inline void add_behind(FloatMaker& make, Case& c) {
    shading::BehindPlan& plan = c.plan.behind;
    plan = shading::BehindPlan(static_cast<int>(1 + make.below(40)), static_cast<int>(1 + make.below(40)));
    c.behind.resize(4 * plan.texels());
    for (float& value : c.behind) value = make.ordinary(0, 1);
    plan.rgba = c.behind.data();
    plan.x[0] = plan.width, plan.x[2] = -0.5f * plan.width, plan.x[3] = 2.5f * plan.width;
    plan.y[1] = -plan.height, plan.y[2] = -0.5f * plan.height, plan.y[3] = 2.5f * plan.height;
    plan.w[2] = -1, plan.w[3] = 5;
}

inline Case make_case(FloatMaker& make, bool smooth_textures) {
    using namespace shading;
    Case c;
    c.textures = make_textures(make, smooth_textures);
    c.materials.push_back(make_material(make));
    const std::uint32_t light_count = make.below(5);
    for (std::uint32_t i = 0; i < light_count; ++i) c.lights.push_back(make_light(make));
    if (make.below(2) == 0)
        c.ambient = {{make.ordinary(0, 1), make.ordinary(0, 1), make.ordinary(0, 1)}, {0.2f, make.ordinary(0, 1), 0.0f}};
    c.options.specular = static_cast<SpecularModel>(make.below(4));
    if (make.below(3) == 0) c.options.anisotropy = static_cast<int>(2 + make.below(15));
    c.options.normalize_specular = make.below(4) != 0;
    const bool override_lobe = make.below(4) == 0;
    if (const Lobe lobe = make_lobe(make); override_lobe) c.options.lobe = lobe;
    c.available = {3u | (make.below(8) << 2), 3u};
    c.plan = plan_shading({c.materials, c.textures, c.available, plan_lights(c.lights), c.ambient, c.options});
    c.plan.eye_ws = {make.ordinary(-4, 4), make.ordinary(-4, 4), 5.0f};
    c.plan.view_direction_ws = {0.6f, 0.0f, -0.8f};
    c.plan.orthographic = make.below(3) == 0;
    if (make.below(2) == 0) add_behind(make, c);
    return c;
}

/// Changes a plan as tiers and error budgets do: shorter polynomials, curves, cutoff radii and thresholds, however large their errors.
inline void shorten(FloatMaker& make, Case& c) {
    using namespace shading;
    for (MaterialPlan& material : c.plan.materials) {
        material.lobe.tier = material.specular_tier = static_cast<PowTier>(make.below(3));
        if (material.lobe.path == LobePath::general && material.lobe.power_minus_one > 0.0f && make.below(2) == 0) {
            const LobeFit fit = fit_lobe(static_cast<double>(material.lobe.power_minus_one) + 1.0, 2.0);
            material.lobe.path = LobePath::curve;
            std::copy_n(fit.c, kLobeCurveTerms, material.lobe.curve);
        }
        const float share = make.ordinary(0, 1);
        if (make.below(2) == 0)
            material.specular_curve = fit_specular(static_cast<double>(make.ordinary(1, 200)), static_cast<double>(share),
                                                   make.below(2) == 0 ? SpecularCurve::kFewTerms : SpecularCurve::kMostTerms)
                                          .curve;
        else if (make.below(2) == 0)
            material.specular_threshold = share;
    }
    for (LightPlan& light : c.plan.lights)
        if (light.type != LightType::directional && make.below(3) == 0) light.cutoff_squared = make.ordinary(0, 9);
}

/// Inputs of the reference for a case; valid as long as the case is not moved.
inline shading::reference::FrameInputs reference_frame(const Case& c) {
    return {c.textures, c.lights, c.ambient, c.options, c.plan.eye_ws, c.plan.view_direction_ws, c.plan.orthographic};
}

}  // namespace halflit::testing
