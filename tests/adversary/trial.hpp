// A trial: a scene made of a genome, with all that the promise depends on.
#pragma once

#include "halflit/environment.hpp"
#include "halflit/scene.hpp"
#include "halflit/settings.hpp"
#include "shading/material_properties.hpp"
#include "tests/adversary/genome.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace halflit::adversary {

/// Parts of a scene that a known fault needs. A search leaves them out, so that it does not find that fault alone, again and again.
enum Avoid : std::uint32_t {
    kAvoidSoftSplit = 1u << 0,       ///< soft-split; off instead
    kAvoidMetalTextures = 1u << 1,   ///< base-colour and metallic-roughness textures under highlights
    kAvoidSuns = 1u << 2,            ///< suns taken out of an environment; they stay in it instead
    kAvoidZeroNormals = 1u << 3,     ///< zero normals; +y instead
    kAvoidOddCoordinates = 1u << 4,  ///< texture coordinates that are NaN; 0 instead
    kAvoidShortNormals = 1u << 5,    ///< normal maps whose normals, between texels, may be shorter than a half
};
using AvoidSet = std::uint32_t;

/// A texture's picture, kept to be written into a file.
struct Picture {
    int width = 0, height = 0;
    ColorSpace space = ColorSpace::linear;
    std::vector<std::uint8_t> rgba8;
    Texture texture;
};

struct Trial {
    Scene scene;
    Camera camera;
    Settings settings;  ///< the budget is in shading.max_error_codes
    int width = 64, height = 48;
    std::vector<std::shared_ptr<const Picture>> pictures;  ///< of scene.textures, by index
    EnvironmentImage sky;                                  ///< of scene.environment
    EnvironmentOptions sky_options;
    GeneSet read;  ///< genes that the scene depends on
};

/// Sections of a genome.
inline constexpr int kMaterials = 2, kBodies = 2, kLightKinds = 4;
/// A section of numbers of materials' extensions has eight.
inline constexpr int kLayerSections = [] {
    int rows = 0;
    for (const shading::MaterialNumber& number : shading::kMaterialNumbers) rows += number.gltf.starts_with("extensions/") ? 1 : 0;
    return (rows + 7) / 8;
}();
/// A section of textures has two slots. The first four slots were there first, and have their sections among the others.
inline constexpr int kFirstSlots = 4, kSlotSections = (kTextureSlots - kFirstSlots + 1) / 2;
enum Section : int {
    kFrame,
    kView,
    kSky,
    kMaterial,
    kMaterialTextures = kMaterial + kMaterials,
    kBody = kMaterialTextures + kMaterials * kFirstSlots / 2,
    kLight = kBody + kBodies,
    kLayers = kLight + kLightKinds,
    kLayerTextures = kLayers + kMaterials * kLayerSections,
    kSectionEnd = kLayerTextures + kMaterials * kSlotSections
};
static_assert(kSectionEnd <= kSections);

[[nodiscard]] Trial make_trial(const Genome& genome, AvoidSet avoid);

/// The parts of make_trial.
struct Aim {
    Vec3f point, normal, to_eye;  ///< on a surface in the middle of the picture, world space
    float size;                   ///< of the body there
    float distance;               ///< of the eye
};
void add_materials(const Genome& genome, AvoidSet avoid, Trial& trial);
/// Returns the aim without the eye.
[[nodiscard]] Aim add_bodies(const Genome& genome, AvoidSet avoid, Trial& trial);
void place_camera(const Genome& genome, Aim& aim, Trial& trial);
void add_lights(const Genome& genome, const Aim& aim, Trial& trial);
void add_sky(const Genome& genome, AvoidSet avoid, Trial& trial);

/// A unit vector from three numbers in [0, 1); +y for three zeros.
[[nodiscard]] Vec3f some_direction(Genes& genes);
[[nodiscard]] Vec3f some_color(Genes& genes);

}  // namespace halflit::adversary
