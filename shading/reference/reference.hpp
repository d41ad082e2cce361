// Reference for the shading kernels: the same model in float64, written in the plainest way, with the C library's functions, and from the
// user's data instead of the plan. It is slow and does not give the same bits everywhere. It is used for tests and for measuring errors.
#pragma once

#include "halflit/light.hpp"
#include "halflit/material.hpp"
#include "halflit/texture.hpp"
#include "shading/environment.hpp"
#include "shading/fragment_block.hpp"
#include "shading/plan/behind_plan.hpp"
#include "shading/plan/plan.hpp"
#include "shading/plan/reflection_plan.hpp"
#include "shading/reference/shadow.hpp"

#include <span>

namespace halflit::shading::reference {

struct Rgba {
    double r = 0, g = 0, b = 0, a = 0;
};

/// Light from all around that reaches a surface with a given normal, channel by channel.
class Irradiance {
public:
    virtual ~Irradiance() = default;
    [[nodiscard]] virtual Vec3d at(Vec3d normal) const = 0;
};

/// Data that all fragments of a frame share.
struct FrameInputs {
    std::span<const Texture> textures;
    std::span<const Light> lights;
    Ambient ambient;
    ShadingSettings options;
    Vec3f eye_ws{0, 0, 0};
    Vec3f view_direction_ws{0, 0, -1};  ///< used when orthographic
    bool orthographic = false;
    ShadowMode shadow_mode = ShadowMode::off;
    /// Where not null: the sun that a light stands for. The lobe is integrated over its pieces; highlights are those of the light. Empty:
    /// no light is a sun.
    std::span<const SunShape* const> suns{};
};

/// Data of one fragment besides its block's rows.
struct Surroundings {
    /// Hidden shares of each light; empty: nothing is hidden.
    std::span<const Hidden> hidden;
    /// Environment light at a normal. Where it is given, it replaces the two-colour ambient light.
    const Irradiance* diffuse = nullptr;
    /// Source of the environment's reflections, and their number of lobes; used where `diffuse` is given and highlights are on.
    const ReflectionPlan* reflections = nullptr;
    int reflection_lobes = 1;
    /// Sky shadows: the lights that stand for the surroundings, and their hidden shares; empty: there are none.
    std::span<const LightPlan> sky{};
    std::span<const Hidden> hidden_sky{};
    std::span<const Hidden> hidden_far{}, hidden_sky_far{};  ///< the same for the far side; of materials with diffuse transmission
    double sky_focus = 0;                                    ///< ShadingPlan::sky_focus
    const SkyGridPlan* sky_grid = nullptr;                   ///< hides it, in place of maps
    std::span<const double> sky_terms{}, sky_terms_far{};    ///< of the light that it hides, and the same for the far side
    /// The picture behind glass that blurs or bends light; null: the light behind is kept as it is.
    const BehindPlan* behind = nullptr;
};

/// f(x; w, n) with its scale, by std::pow.
[[nodiscard]] double lobe_value(const Lobe& lobe, double x);

/// The texture's value at (u, v), before any transform, with a footprint of 2^lod texels of level 0.
[[nodiscard]] Rgba sample(const Texture& texture, const Sampler& sampler, double u, double v, double lod);

/// log2 of the longer side of the footprint that the kDu.. rows of `uv_set` describe, in texels of level 0.
[[nodiscard]] double level_of_detail(const Texture& texture, const TextureUse& use, const FragmentBlock& block, int lane);

/// The colour and alpha of one lane. `available` as in plan_shading.
[[nodiscard]] Rgba shade(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane,
                         const Surroundings& around = {});

/// Shares of the light from behind that a lane keeps, in red, green and blue; of materials that transmit. What comes from
/// Surroundings::behind instead is in the colour.
[[nodiscard]] Vec3d kept(const FrameInputs& frame, const Material& material, SlotMask available, const FragmentBlock& block, int lane,
                         const Surroundings& around = {});

/// The sRGB curve times 255, not rounded; x is clamped to [0, 1].
[[nodiscard]] double srgb_code(double linear);

}  // namespace halflit::shading::reference
