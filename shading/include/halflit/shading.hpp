// Settings of shading: how often light is computed, by which lobes and highlights, how exactly, and the bound on the error.
#pragma once

#include "halflit/lobe.hpp"

#include <cstdint>
#include <optional>
#include <string_view>

namespace halflit {

/// Arithmetic of shading: its error, and so its time.
enum class Accuracy : std::uint8_t {
    reference,  ///< float64 and the C library, environments by direct integration: slow; errors are measured against it
    exact       ///< float32, elementary functions within about 2 ulp
};

/// Factors by which a tone curve may enlarge the codes that an error of light costs.
struct ErrorGrowth {
    double absolute = 1;  ///< of an error of a fixed size
    double relative = 1;  ///< of an error that is a share of the light
    double other = 1;     ///< of all other errors
    friend bool operator==(const ErrorGrowth&, const ErrorGrowth&) = default;
};

/// Bound on the difference of a frame from the exact one, the frame without a budget, in 8-bit sRGB codes: 255 times the encoded value,
/// before it is rounded to a whole code, of a pixel that one surface fills. `codes` is the sum of the parts below it, for the material
/// where that sum is largest; it is never above the budget, and 0 where nothing can be left out.
struct ErrorBound {
    double budget = 0;        ///< codes asked for; 0: no budget, and nothing below is known
    double codes = 0;         ///< the bound
    double rounding = 0;      ///< of what is computed in another way than in the exact picture
    double lobes = 0;         ///< shorter polynomials for t^n, or curves
    double specular = 0;      ///< shorter polynomials for cos^s, or curves
    double environment = 0;   ///< bands left out
    double cells = 0;         ///< light fitted over cells of 8 x 8 pixels
    double left_out = 0;      ///< lights beyond their cutoff radius, highlights too weak to see, and faint or hidden parts of splats
    ErrorGrowth tone_growth;  ///< factors by which the tone curve may enlarge errors; all numbers above are those after the curve
};

/// Effect of a shadow on light through a lobe f that reaches past the terminator, where x = N.L = 0. V is the visibility by the shadow map.
enum class ShadowMode : std::uint8_t {
    off,        ///< f
    hard,       ///< V f: a step of f(0) where the surface turns away from the light
    soft_split  ///< V core + W excess, core = min(f, max(0, x)), excess = f - core, W = max(V, T) for each texel; T: raster/README.md
};

/// Shape of the highlight. Phong uses the mirrored light, Blinn the half vector. Blinn's exponent is four times Phong's, which gives the
/// same width. ggx is the model by which environments are mirrored: a longer tail, and Fresnel's rise towards grazing views.
enum class SpecularModel : std::uint8_t { none, phong, blinn, ggx };

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
    pixel     ///< once a pixel for each triangle that it shows
};

/// How fragments are shaded: the part of Settings that decides light and texture.
struct ShadingSettings {
    ShadingRate rate = ShadingRate::pixel;          ///< how often light is evaluated
    std::optional<Lobe> lobe;                       ///< replaces the lobe of all materials but those with Material::has_own_lobe
    SpecularModel specular = SpecularModel::blinn;  ///< model of highlights; none: albedo is the base colour itself
    /// sharper highlights are brighter, for the same light in all; off: a peak of 1 for every exponent; ggx always is
    bool normalize_specular = true;
    float emission_scale = 1.0f;  ///< factor on the light that all surfaces emit (not on colours of unlit materials)
    float normal_scale = 1.0f;    ///< factor on x and y of all normal maps, a coat's too; 0: surfaces have the normals of their meshes
    int environment_bands = 0;    ///< of spherical harmonics, 1 to 10; 0: the fewest whose error is within environment_tolerance
    double environment_tolerance = 1.0 / 510.0;  ///< of bands that are left out, relative to white, in linear light; half an 8-bit code
    Accuracy accuracy = Accuracy::exact;         ///< arithmetic; exact if there is an error budget
    /// largest difference from the exact picture in 8-bit codes: the cheapest way that is proven to keep it, for light once a pixel, full
    /// texture filters and exact arithmetic alone; 0: none
    double max_error_codes = 0.0;
    TextureDetail texture_detail = TextureDetail::full;  ///< upper limit of the texture filters
    /// largest ratio of a footprint's length to its width that is filtered along its length, 1 to 16; 1: footprints count as squares;
    /// for textures that are linear within and between levels
    int anisotropy = 1;
    friend bool operator==(const ShadingSettings&, const ShadingSettings&) = default;
};

/// Tone curve: maps light, which has no upper limit, to the light of a display, 0 to 1. Formulas and sources: shading/README.md.
enum class ToneCurve : std::uint8_t {
    none,      ///< light above 1 is cut off
    reinhard,  ///< light / (1 + its luminance): keeps hue and saturation; a saturated channel may still be cut off
    aces,      ///< film-like contrast in each channel: darkens shadows, brightens the middle
    neutral    ///< Khronos PBR Neutral: keeps colours from 0.08 to 0.8 but for 0.04, compresses what is brighter
};
/// Curve of settings that name none.
inline constexpr ToneCurve kDefaultToneCurve = ToneCurve::none;

/// Stages of shading, one bit each. A fragment runs only those that its material requires.
enum Stage : std::uint32_t {
    kStageBaseColorTexture = 1u << 0,
    kStageVertexColor = 1u << 1,
    kStageNormalMap = 1u << 2,
    kStageMetallicRoughnessTexture = 1u << 3,
    kStageOcclusionTexture = 1u << 4,
    kStageEmissiveTexture = 1u << 5,
    kStageLights = 1u << 6,
    kStageSpecular = 1u << 7,
    kStageAmbient = 1u << 8,
    kStageUnlit = 1u << 9,
    kStageGradients = 1u << 10,            ///< some texture's level or filter depends on how fast its coordinates change
    kStagePrelit = 1u << 11,               ///< the fragments bring their light: a shading rate below one a pixel
    kStageEnvironment = 1u << 12,          ///< the ambient light is an environment's, in spherical harmonics
    kStageTransmission = 1u << 13,         ///< light from behind passes through the surface
    kStageSpecularColor = 1u << 14,        ///< where not metallic, F0 has a colour, a weight or textures of its own
    kStageShadowCatcher = 1u << 15,        ///< alpha is the share of light that is hidden; nothing else is seen
    kStageClearcoat = 1u << 16,            ///< a coat above the surface mirrors
    kStageSheen = 1u << 17,                ///< fibres above the surface glow at grazing views
    kStageIridescence = 1u << 18,          ///< a thin film colours what the surface mirrors
    kStageAnisotropy = 1u << 19,           ///< highlights and reflections are longer along a direction
    kStageDiffuseTransmission = 1u << 20,  ///< light that falls on the far side is scattered to this one
    kStageCount = 21
};
/// Names of the stages in reports, by bit.
inline constexpr std::string_view kStageNames[kStageCount] = {"base colour texture",
                                                              "vertex colour",
                                                              "normal map",
                                                              "metallic roughness texture",
                                                              "occlusion texture",
                                                              "emissive texture",
                                                              "lights",
                                                              "specular",
                                                              "ambient",
                                                              "unlit",
                                                              "texture gradients",
                                                              "light at vertices or triangles",
                                                              "environment",
                                                              "transmission",
                                                              "specular colour",
                                                              "shadow catcher",
                                                              "clearcoat",
                                                              "sheen",
                                                              "iridescence",
                                                              "anisotropy",
                                                              "diffuse transmission"};

}  // namespace halflit
