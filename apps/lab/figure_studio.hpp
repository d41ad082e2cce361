// Scenes for the figures' pictures, matte objects under few lights, and functions that render them.
#pragma once

#include "apps/lab/figure.hpp"
#include "halflit/renderer.hpp"

#include <functional>

namespace halflit::cli {

/// A scene with the camera, settings and size of its picture.
struct Shot {
    Scene scene{};
    Camera camera{};
    Settings settings{.shadow_size = 2048};  ///< figures show formulas, not the size of texels
    int width = 300, height = 300;
};

/// An empty scene: 8 samples per pixel, a dark background, no highlights, no shadows.
[[nodiscard]] Shot empty_shot();

/// An orthographic camera that looks along -z at `center`; the picture shows `half_height` above and below it.
[[nodiscard]] Camera front_camera(float half_height, Vec3f center = {0, 0, 0});

[[nodiscard]] Material matte(const Lobe& lobe, Vec3f color = {1, 1, 1});

/// Light of that strength from a direction that need not be of unit length.
[[nodiscard]] Light light_from(Vec3f direction, float strength = 1.0f);

/// Adds a mesh with its material, moved to `place`.
void add_object(Shot& shot, Mesh mesh, Material material, Vec3f place = {0, 0, 0});

/// The two usual subjects, with their cameras: a sphere of radius 1, and the bust.
enum class Subject : std::uint8_t { sphere, bust };
[[nodiscard]] Shot shot_of(Subject subject, const Lobe& lobe, Vec3f color = {1, 1, 1});

/// Renders a picture, with rgba8 and rgba_linear.
[[nodiscard]] Result<Image> take(const Shot& shot);

/// Renders the grid's pictures.
[[nodiscard]] Result<PictureGrid> take_grid(PictureGrid grid, const std::function<Shot(std::size_t row, std::size_t column)>& shot_at);

}  // namespace halflit::cli
