// Scenes made by code that together use all that the renderer can do, each with a camera.
#pragma once

#include "halflit/scene.hpp"

#include <string>
#include <utility>
#include <vector>

namespace halflit::raster::test {

struct NamedScene {
    std::string name;
    Scene scene;
    Camera camera;
};

/// Textures with mips, normal maps, every wrap and filter; opaque, MASK and BLEND; metal and clay; all kinds of lights and lobes; mirrored
/// and unevenly scaled instances; vertex colours and a second set of texture coordinates; a triangle through the near plane.
[[nodiscard]] NamedScene materials_scene();

/// Thousands of triangles of about a pixel, and some across the whole picture behind them.
[[nodiscard]] NamedScene small_triangles_scene();

/// Transparent layers that cross each other, over a masked fence.
[[nodiscard]] NamedScene layers_scene();

/// Numbers at the limits of float: huge and tiny instances, degenerate normals, vertices that are not finite.
[[nodiscard]] NamedScene rough_scene();

/// Some fifty small lights, each of which reaches a few tiles, and some that reach all.
[[nodiscard]] NamedScene many_lights_scene();

/// Bodies with coats: smooth, rough, in part, with normals of their own, above metal, emission and glass.
[[nodiscard]] NamedScene coats_scene();

/// Bodies with sheen: smooth, rough, coloured by textures, below coats, above metal and glass.
[[nodiscard]] NamedScene fabrics_scene();
/// Objects below thin films: on glass, metal and plastic, thickness and share by textures, below coats and sheen.
[[nodiscard]] NamedScene films_scene();
/// Brushed objects: turned, by textures, with bumps, below a film and a coat, under sheen.
[[nodiscard]] NamedScene brushed_scene();

/// All above, and the built-in demo scene.
[[nodiscard]] std::vector<NamedScene> all_scenes();

}  // namespace halflit::raster::test
