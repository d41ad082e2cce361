// Scenes of the peer bench, made by code: the same bits on every machine.
#pragma once

#include "halflit/renderer.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::peer {

/// The picture that a texture was made from.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba8;
};

/// One mesh in world space with one material, lights, and an environment with its sun.
struct BenchScene {
    std::string name;
    Scene scene;
    Camera camera;
    std::vector<Picture> pictures;  ///< of scene.textures, by index
};

/// A scene's name, and what it shows.
struct SceneEntry {
    std::string_view name, content;
};
[[nodiscard]] const std::vector<SceneEntry>& scene_entries();

/// True for the names of data sets: scenes that are drawn from all sides. The camera of their BenchScene counts for files alone.
[[nodiscard]] inline bool is_dataset(std::string_view name) { return name.starts_with("dataset-"); }

/// Makes a scene. `aspect`: the picture's width / height, which full-screen surfaces fill.
[[nodiscard]] BenchScene make_bench_scene(std::string_view name, float aspect);

/// One sphere that touches the upper and the lower edge of the picture, under 2 lights; without textures.
[[nodiscard]] BenchScene make_sphere_scene(std::int64_t triangles);

/// Squares that fill the picture one over another, the farthest first.
struct Squares {
    int layers = 1, lamps = 8;
    int texture_side = 1024;  ///< texels, of base colour and normals
};
[[nodiscard]] BenchScene make_squares_scene(const Squares& squares, float aspect);

/// Bands of spherical harmonics by which the environment is taken.
inline constexpr int kEnvironmentBands = 3;

/// Settings of halflit: exact accuracy, Blinn highlights, no shadows, three bands of the environment, an opaque black background.
[[nodiscard]] Settings bench_settings(int samples);

}  // namespace halflit::peer
