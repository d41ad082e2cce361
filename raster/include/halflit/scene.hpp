// A scene: everything that a picture shows. Plain data that the caller owns; nothing in it refers to a file.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/export.hpp"
#include "halflit/lighting.hpp"
#include "halflit/material.hpp"
#include "halflit/mesh.hpp"
#include "halflit/texture.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace halflit {

/// Geometry, its materials, its own light, and views of it. Indices in it begin at 0.
struct Scene : Lighting {
    std::vector<Mesh> meshes;         ///< triangles; drawn where an instance places them
    std::vector<Instance> instances;  ///< drawn in this order
    std::vector<Material> materials;  ///< shared by meshes
    std::vector<Texture> textures;    ///< shared by materials
    std::vector<Camera> cameras;      ///< views to choose from; none is in use by itself
    bool faces_back = false;          ///< its front is towards -z: auto_setup looks from there
    /// Work that preparing it, choosing its picture, and a frame beside what its pixels allow may take, in nanoseconds of one core by
    /// estimate; beyond it they fail (limit). 0: no limit. Loaders set it by the size of the file, so that a small file cannot take long.
    std::uint64_t frame_work = 0;
};

/// World-space bounds of everything drawn but shadow catchers, instances whose alpha is 0, and those that their matrix gives no extent.
/// Vertices that are not finite are left out.
[[nodiscard]] HALFLIT_API Bounds scene_bounds(const Scene& scene);

/// Adds a key light over the viewer's left shoulder, and sets ambient light from sky and ground: light for a scene that has none.
HALFLIT_API void add_default_lights(Lighting& light, const Camera& camera);

/// The built-in studio, made by code: large bright soft boxes in a grey room, and a light floor. 128 x 64 pixels, calibrated; a white
/// Lambert surface in it reaches 0.5 (facing down) to 0.7 (facing up), and with the key light of add_studio 1.6.
[[nodiscard]] HALFLIT_API EnvironmentImage studio_image();

/// The studio turned with the camera about the vertical, its main soft box over the viewer's left shoulder, with its image kept.
/// turn_rad: a further turn, counter-clockwise seen from above; level: a factor on its light.
[[nodiscard]] HALFLIT_API std::shared_ptr<const Environment> studio_environment(const Camera& camera, double turn_rad = 0.0,
                                                                                float level = 1.0f);

/// Sets the studio as the environment, and adds a key light from the left above the viewer that casts shadows. They are for the exposure
/// 1 / level.
HALFLIT_API void add_studio(Lighting& light, const Camera& camera, double turn_rad = 0.0, float level = 1.0f);

/// Adds a ground that is invisible but for the shadows on it (Material::shadow_catcher): a horizontal square below the lowest point of the
/// bounds, ten of their radii to each side. Views are framed as without it. bounds: scene_bounds(scene).
HALFLIT_API void add_ground(Scene& scene, const Bounds& bounds);

/// Estimate of the light at the centre of the bounds, irradiance / pi: the sum over the lights of what a surface there receives that faces
/// the light. Directional: its colour. Point and spot: colour / max(distance from the centre, radius of the bounds / 2, 1e-4)^2, as if the
/// centre were in the cone. A light whose range does not reach the bounds adds nothing.
[[nodiscard]] HALFLIT_API Vec3f light_level(const Lighting& light, const Bounds& bounds);

/// Exposure: the factor that scales the luminance (Rec. 709) of light_level to 1. So white surfaces come out near white, whatever unit the
/// file's lights are in. 1 if there is no light, or if its luminance is outside (1e-24, 1e24). It depends on the lights and the scene's
/// bounds, never on pixels: a crop, a tile or a second frame of the same scene keeps its values.
[[nodiscard]] HALFLIT_API float auto_exposure(const Lighting& light, const Bounds& bounds);

/// Ambient light for a scene whose lights leave the far sides black: a tenth of light_level from above, a twentieth from below.
[[nodiscard]] HALFLIT_API Ambient soft_ambient(const Lighting& light, const Bounds& bounds);

/// 2^ev: each step of 1 doubles the light. Exact for whole numbers, otherwise within one float ulp. ev in [-64, 64], clamped.
[[nodiscard]] HALFLIT_API float exposure_factor(float ev);

/// The built-in scene, drawn when no file is named: a row of spheres with wrap 0 to 1 in front of a knot on a plinth, under several lights.
/// Made by code; it has its own camera.
[[nodiscard]] HALFLIT_API Scene demo_scene();

}  // namespace halflit
