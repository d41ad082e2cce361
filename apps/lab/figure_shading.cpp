// Figures of shading rates and of types of light.
#include "apps/lab/figure_entries.hpp"
#include "apps/lab/figure_studio.hpp"
#include "halflit/camera.hpp"
#include "halflit/shapes.hpp"

#include <fmt/core.h>

namespace halflit::cli {
namespace {

constexpr int kSlices = 16, kStacks = 10;  ///< slices and stacks of the coarse sphere

Shot coarse_sphere(ShadingRate rate, bool glossy) {
    Shot shot = empty_shot();
    Material material = matte(Lobe::lambert(), {0.75f, 0.32f, 0.22f});
    material.roughness = 0.32f;
    add_object(shot, make_sphere(1.0f, kSlices, kStacks), material);
    shot.camera = front_camera(1.08f);
    shot.scene.lights = {light_from({0.55f, 0.62f, 0.75f}, 0.9f)};
    shot.scene.ambient = {{0.05f, 0.055f, 0.07f}, {0.03f, 0.03f, 0.03f}};
    shot.settings.shading.rate = rate;
    if (glossy) shot.settings.shading.specular = SpecularModel::blinn;
    shot.width = shot.height = 480;
    return shot;
}

/// Balls in a ring on a floor.
Shot ball_ring(const Light& light) {
    constexpr float kRadius = 0.42f;
    Shot shot = empty_shot();
    shot.width = 540;
    shot.height = 400;
    add_object(shot, make_plane(6.5f, 1), matte(Lobe::lambert(), {0.75f, 0.75f, 0.72f}));
    constexpr Vec3f kPlaces[] = {{-1.4f, 0, 0}, {1.4f, 0, 0}, {0, 0, -1.4f}, {0, 0, 1.4f}};
    for (const Vec3f place : kPlaces)
        add_object(shot, make_sphere(kRadius, 96, 48), matte(Lobe::lambert(), {0.80f, 0.48f, 0.30f}), place + Vec3f{0, kRadius, 0});
    Bounds bounds;
    bounds.add({-2.1f, -0.1f, -2.0f});
    bounds.add({2.1f, 0.9f, 2.0f});
    shot.camera = frame_bounds(bounds, 540.0f / 400.0f, {.azimuth_deg = 18, .elevation_deg = 34, .zoom = 1.15f, .fov_y_deg = 30});
    shot.scene.lights = {light};
    shot.scene.ambient = {{0.04f, 0.04f, 0.045f}, {0.03f, 0.03f, 0.03f}};
    shot.settings.shadows = ShadowMode::hard;
    return shot;
}

}  // namespace

Result<Figure> make_shading_rates_figure() {
    constexpr ShadingRate kRates[] = {ShadingRate::flat, ShadingRate::gouraud, ShadingRate::pixel};
    PictureGrid grid{.columns = {"flat", "Gouraud", "per pixel"}, .rows = {"matte", "with a\nhighlight"}, .width = 220};
    auto pictures =
        take_grid(std::move(grid), [&](std::size_t row, std::size_t column) { return coarse_sphere(kRates[column], row == 1); });
    if (!pictures) return tl::unexpected(pictures.error());
    return Figure{.caption = fmt::format(
                      "The same {} triangles three times, under one directional light and a little ambient light. Light is computed once "
                      "per triangle "
                      "with the triangle's normal, once per vertex and interpolated, and once per pixel with the interpolated normal. "
                      "Lambert's lobe; "
                      "below with a highlight of roughness 0.32. A highlight smaller than a triangle is smeared or lost between vertices.",
                      2 * kSlices * (kStacks - 1)),
                  .parts = {std::move(*pictures)}};
}

Result<Figure> make_light_sources_figure() {
    Light point{.type = LightType::point, .color_linear = {2, 2, 2}, .position_ws = {0, 1.5f, 0}};
    Light spot{.type = LightType::spot, .color_linear = {9, 9, 9}, .position_ws = {-1.4f, 2.8f, 1.2f}};
    spot.direction_ws = normalize_or({1.4f, -2.8f, -1.3f}, {0, -1, 0});
    spot.inner_cone_rad = 0.395f;
    spot.outer_cone_rad = 0.40f;
    spot.cone_power = 6.0f;
    const Light lights[] = {light_from({-1, 1.4f, 0.8f}, 0.9f), point, spot};
    PictureGrid grid{.columns = {"directional", "point", "spot"}, .rows = {""}, .width = 270};
    auto pictures = take_grid(std::move(grid), [&](std::size_t, std::size_t column) { return ball_ring(lights[column]); });
    if (!pictures) return tl::unexpected(pictures.error());
    return Figure{
        .caption =
            "Four balls on a floor, Lambert's lobe, a little ambient light, and shadow maps. Directional: the same light everywhere, from "
            "(−1, 1.4, 0.8), strength 0.9; shadows are parallel. Point: at (0, 1.5, 0) between the balls, strength 2 at distance 1, "
            "falling "
            "with the square of the distance; shadows point away from the light. Spot: from (−1.4, 2.8, 1.2) towards (0, 0, −0.1), "
            "strength "
            "9 on its axis at distance 1. Away from the axis it is multiplied by the sixth power of the cosine of the angle, and it ends "
            "at "
            "0.4 radians. It falls with the square of the distance too, unlike the source's.",
        .parts = {std::move(*pictures)}};
}

}  // namespace halflit::cli
