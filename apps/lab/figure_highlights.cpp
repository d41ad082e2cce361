// Two models of highlights: Phong's, by the mirrored light, and Blinn's, by the half vector.
#include "apps/lab/figure_entries.hpp"
#include "apps/lab/figure_studio.hpp"
#include "halflit/shapes.hpp"
#include "sh/trig.hpp"
#include "shading/model/scalar.hpp"

#include <fmt/core.h>

#include <cmath>

namespace halflit::cli {
namespace {

constexpr float kRoughness = 0.35f;

Material lacquer() {
    Material material = matte(Lobe::lambert(), {0.20f, 0.035f, 0.03f});
    material.roughness = kRoughness;
    return material;
}

Shot ball_shot(SpecularModel specular) {
    Shot shot = empty_shot();
    add_object(shot, make_sphere(1.0f, 128, 64), lacquer());
    shot.camera = front_camera(1.08f);
    shot.scene.lights = {light_from({0.5f, 0.6f, 0.8f}, 1.5f)};
    shot.scene.ambient = {{0.1f, 0.1f, 0.11f}, {0.05f, 0.05f, 0.05f}};
    shot.settings.shading.specular = specular;
    shot.width = shot.height = 520;
    return shot;
}

/// A floor to the horizon, the eye 1 above it, the light low in front.
Shot floor_shot(SpecularModel specular) {
    Shot shot = ball_shot(specular);
    shot.scene.meshes = {make_plane(60.0f, 60)};
    shot.scene.meshes[0].material = 0;
    shot.scene.lights = {light_from({0, 0.22f, -1}, 1.5f)};
    Camera camera;
    camera.world_from_camera = translation({0, 1, 0});
    camera.fov_y_rad = 0.9f;
    camera.near_z = 0.1f;
    shot.camera = camera;
    return shot;
}

/// Brightness over the angle between normal and half vector. At angle 0 the eye sees the mirrored light, at an incidence of
/// `incidence_deg`. The normal turns in the plane of eye and light or, if `across`, at a right angle to it.
PlotSeries shape(std::string name, bool phong, bool across, double incidence_deg) {
    const double s = shading::specular_exponent(static_cast<double>(kRoughness)), cos_i = std::cos(incidence_deg * kPi / 180.0);
    PlotSeries series{.name = std::move(name), .points = {}, .color = phong ? "#d55e00" : "#0072b2", .dash = phong ? "" : "6 3"};
    for (int i = -120; i <= 120; ++i) {
        const double degrees = i / 4.0, c = std::cos(degrees * kPi / 180.0);
        // Turning the normal by an angle turns the mirrored light by twice that in the plane, and less across it.
        const double in_plane = 2 * c * c - 1, aside = 2 * c * c * cos_i * cos_i - (2 * cos_i * cos_i - 1);
        series.points.push_back({degrees, phong ? std::pow(across ? aside : in_plane, s / 4) : std::pow(c, s)});
    }
    return series;
}

}  // namespace

Result<Figure> make_highlights_figure() {
    constexpr double kIncidence = 75;
    PictureGrid grid{.columns = {"Phong", "Blinn"}, .rows = {"ball", "floor, light\nlow in front"}, .width = 260};
    auto pictures = take_grid(std::move(grid), [](std::size_t row, std::size_t column) {
        const SpecularModel specular = column == 0 ? SpecularModel::phong : SpecularModel::blinn;
        return row == 0 ? ball_shot(specular) : floor_shot(specular);
    });
    if (!pictures) return tl::unexpected(pictures.error());
    PlotRow plots;
    for (const bool across : {false, true}) {
        Plot plot{.title = across ? fmt::format("Across that plane, incidence {:g} degrees", kIncidence) : "In the plane of light and eye",
                  .x = {.label = "normal to half vector, degrees", .min = -30, .max = 30},
                  .y = {.label = "part of the peak", .min = 0, .max = 1.05}};
        plot.series = {shape("Phong", true, across, kIncidence), shape("Blinn", false, across, kIncidence)};
        plot.width = 400;
        plots.push_back(std::move(plot));
    }
    return Figure{
        .caption = fmt::format("Phong's highlight is (R·V)^{{p}}, Blinn's is (N·H)^{{s}}: N is the normal, L the direction to the light, V "
                               "that to the eye, R the mirrored L, and H is half-way between L and V. On lacquer of roughness "
                               "{:g}, s = {:.0f}, and p = s/4 because R turns twice as fast as H. Both are multiplied by N·L and "
                               "normalised so that a mirror reflects no more light than it receives, which the source does not do. On the "
                               "ball the two look alike. At "
                               "grazing angles Blinn's highlight grows long, as on a wet road, while Phong's stays round. One "
                               "directional light of strength 1.5.",
                               static_cast<double>(kRoughness), shading::specular_exponent(static_cast<double>(kRoughness))),
        .parts = {std::move(*pictures), std::move(plots)}};
}

}  // namespace halflit::cli
