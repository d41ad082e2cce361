// A scene: everything that a picture shows. Plain data that the caller owns; nothing in it refers to a file.
#pragma once

#include "raster/scene/bounds.hpp"
#include "raster/scene/camera.hpp"
#include "raster/scene/mesh.hpp"
#include "shading/environment.hpp"
#include "shading/light.hpp"
#include "shading/material.hpp"
#include "shading/texture.hpp"

#include <memory>
#include <vector>

namespace halflit::raster {

struct Scene {
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;  ///< drawn in this order
    std::vector<shading::Material> materials;
    std::vector<shading::Texture> textures;  ///< shared by materials
    std::vector<shading::Light> lights;      ///< summed in this order; empty: see add_default_lights
    shading::Ambient ambient;
    std::shared_ptr<const shading::Environment> environment;  ///< replaces `ambient`; its suns must be in `lights`
    std::vector<Camera> cameras;                              ///< empty: see frame_scene in framing.hpp
};

/// World-space bounds of everything drawn. Vertices that are not finite are left out.
[[nodiscard]] Bounds scene_bounds(const Scene& scene);

/// Adds light to a scene that has none: a key light over the viewer's left shoulder, and ambient light from sky and ground.
void add_default_lights(Scene& scene, const Camera& camera);

/// The built-in scene, drawn when no file is named: a row of spheres with wrap 0 to 1 in front of a knot on a plinth, under several lights.
/// Made by code; it has its own camera.
[[nodiscard]] Scene demo_scene();

}  // namespace halflit::raster
