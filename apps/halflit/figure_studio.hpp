// What the figures' pictures are taken with: plain scenes of matte things under few lights, and the renderer.
#pragma once

#include "apps/halflit/figure.hpp"
#include "raster/renderer.hpp"

#include <functional>

namespace halflit::cli {

/// All that a picture needs.
struct Shot {
    raster::Scene scene{};
    raster::Camera camera{};
    raster::Settings settings{};
    int width = 300, height = 300;
};

/// A shot of nothing: 8 samples a pixel on a dark ground, no highlights, no shadows.
[[nodiscard]] Shot empty_shot();

/// Looks along -z at `center` from far away, without perspective.
[[nodiscard]] raster::Camera front_camera(float half_height, Vec3f center = {0, 0, 0});

[[nodiscard]] shading::Material matte(const shading::Lobe& lobe, Vec3f color = {1, 1, 1});

/// Light of that strength from a direction that need not be of unit length.
[[nodiscard]] shading::Light light_from(Vec3f direction, float strength = 1.0f);

/// Adds a mesh and the material that it is made of.
void add_object(Shot& shot, raster::Mesh mesh, shading::Material material, Vec3f place = {0, 0, 0});

/// The two standing subjects: a sphere of radius 1 and the bust, with their cameras.
enum class Subject : std::uint8_t { sphere, bust };
[[nodiscard]] Shot shot_of(Subject subject, const shading::Lobe& lobe, Vec3f color = {1, 1, 1});

/// With rgba8 and rgba_linear.
[[nodiscard]] Result<raster::Image> take(const Shot& shot);

/// Fills the grid's pictures.
[[nodiscard]] Result<PictureGrid> take_grid(PictureGrid grid, const std::function<Shot(std::size_t row, std::size_t column)>& shot_at);

}  // namespace halflit::cli
