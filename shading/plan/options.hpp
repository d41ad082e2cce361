// Settings that change what a plan contains.
#pragma once

#include "shading/lobe.hpp"
#include "shading/material.hpp"
#include "shading/plan/accuracy.hpp"
#include "shading/plan/environment_plan.hpp"

#include <cstdint>

namespace halflit::shading {

/// Shape of the highlight. Phong uses the mirrored light, Blinn the half vector. Blinn's exponent is four times Phong's, which gives the
/// same width.
enum class SpecularModel : std::uint8_t { none, phong, blinn };

/// Upper limit of the texture filters.
enum class TextureDetail : std::uint8_t {
    full,      ///< the sampler's own filters
    bilinear,  ///< one mip level, the nearest
    nearest    ///< one texel of that level, the nearest
};

/// Rate at which light is evaluated. Textures and base colour are always read at every pixel.
enum class ShadingRate : std::uint8_t {
    flat,     ///< once a visible triangle, at its centroid, with the triangle's own normal
    gouraud,  ///< once a vertex, interpolated
    pixel
};

/// Settings that change what a plan contains.
struct PlanOptions {
    ShadingRate rate = ShadingRate::pixel;
    bool override_lobe = false;  ///< use `lobe` for all materials that do not bring their own
    Lobe lobe;
    SpecularModel specular = SpecularModel::blinn;  ///< none: no specular stage, albedo is the base colour itself
    bool normalize_specular = true;  ///< times (s + 8) / 8, so that sharper highlights are brighter; off: a peak of 1 for every exponent
    EnvironmentOrder environment_order;
    Accuracy accuracy = Accuracy::exact;
    double max_error_codes = 0.0;  ///< 0: `accuracy` decides; otherwise the cheapest way whose bound is below this (error_budget.hpp)
    TextureDetail texture_detail = TextureDetail::full;
    friend bool operator==(const PlanOptions&, const PlanOptions&) = default;
};

/// The lobe that a material is drawn with.
[[nodiscard]] inline const Lobe& lobe_of(const Material& material, const PlanOptions& options) {
    return options.override_lobe && !material.has_own_lobe ? options.lobe : material.lobe;
}

}  // namespace halflit::shading
