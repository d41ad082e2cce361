// Two models of highlights: Phong's, by the mirrored light, and Blinn's, by the half vector; each with and without the factor N.L.
#include "apps/lab/figure_entries.hpp"
#include "apps/lab/figure_studio.hpp"
#include "apps/lab/highlight_model.hpp"
#include "halflit/shapes.hpp"
#include "sh/trig.hpp"
#include "shading/model/scalar.hpp"

#include <fmt/core.h>

#include <algorithm>
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

struct Form {
    const char *name, *color, *dash;
    bool phong, times_cosine;
};
constexpr Form kForms[] = {{"Phong", "#d55e00", "5 3", true, false},
                           {"Phong × N·L", "#d55e00", "", true, true},
                           {"Blinn", "#0072b2", "5 3", false, false},
                           {"Blinn × N·L", "#0072b2", "", false, true}};
constexpr double kDiffuse = 0.3, kSpecular = 0.6, kExponent = 40;  // reflect 0.9 together, and lobes wide enough to be seen

HighlightModel model_of(const Form& form, double diffuse, double specular) {
    return {diffuse, specular, kExponent, form.phong, form.times_cosine};
}

double angle_rad(double degrees) { return degrees * kPi / 180.0; }

/// Polar plot of the light reflected in the plane of incidence. The light comes from the left.
Plot polar_plot(double light_deg) {
    constexpr double kReach = 4.2, kInner = 306;  // pixels between the axes; half as high as wide
    Plot plot{.title = fmt::format("Reflected, light at {:g}° (grey)", light_deg),
              .x = {.label = "along the surface", .min = -kReach, .max = kReach, .step = 1},
              .y = {.label = "along the normal", .min = 0, .max = kReach, .step = 1},
              .series = {},
              .marks = {},
              .legend = LegendPlace::top_left,
              .width = kInner + 74,
              .height = kInner / 2 + 76};
    const double light = angle_rad(light_deg);
    for (const Form& form : kForms) {
        PlotSeries series{.name = form.name, .points = {}, .color = form.color, .dash = form.dash};
        for (int i = -180; i <= 180; ++i) {
            const double view = angle_rad(i / 2.0), turn = view < 0 ? 0 : kPi;
            const double length = reflected_radiance(model_of(form, kDiffuse, kSpecular), light, std::cos(view), turn);
            series.points.push_back({length * std::sin(view), length * std::cos(view)});
        }
        plot.series.push_back(std::move(series));
    }
    plot.series.push_back(
        {.name = "", .points = {{0, 0}, {-1.5 * std::sin(light), 1.5 * std::cos(light)}}, .color = "#777", .line_width = 3});
    return plot;
}

/// Energy over the light's angle.
Plot share_plot(std::string title, double diffuse, double specular) {
    Plot plot{.title = std::move(title),
              .x = {.label = "angle between normal and light, degrees", .min = 0, .max = 90, .step = 15},
              .y = {.label = "reflected of the light received", .min = 0, .max = 3},
              .series = {},
              .marks = {},
              .legend = LegendPlace::top_left};
    for (const Form& form : kForms) {
        PlotSeries series{.name = form.name, .points = {}, .color = form.color, .dash = form.dash};
        for (int degrees = 0; degrees < 90; ++degrees)
            series.points.push_back({double(degrees), reflected_share(model_of(form, diffuse, specular), angle_rad(degrees))});
        plot.series.push_back(std::move(series));
    }
    plot.series.push_back({.name = "all of it", .points = {{0, 1}, {90, 1}}, .color = "#777", .dash = "2 3", .line_width = 1.2});
    return plot;
}

/// The first angle, in whole degrees, at which the light reflected is more than received by a thousandth.
double first_above_1(const PlotSeries& shares) {
    for (const auto& point : shares.points)
        if (point.y > 1.001) return point.x;
    return 90;
}

double largest(const PlotSeries& shares) {
    double value = 0;
    for (const auto& point : shares.points) value = std::max(value, point.y);
    return value;
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
    const PlotRow lobes{polar_plot(0), polar_plot(45), polar_plot(75)};
    const PlotRow shares{share_plot(fmt::format("Energy, k_{{d}} = {:g}, k_{{s}} = {:g}", kDiffuse, kSpecular), kDiffuse, kSpecular),
                         share_plot("Energy, k_{d} = 0, k_{s} = 1", 0, 1)};
    const std::string balls = fmt::format(
        "Phong's highlight is (R·V)^{{p}}, Blinn's is (N·H)^{{s}}: N is the normal, L the direction to the light, V that to the eye, R the "
        "mirrored L, and H is half-way between L and V. p = s/4, because R turns twice as fast as H. Lacquer of roughness {:g}, s = "
        "{:.0f}, "
        "one directional light of strength 1.5. On the ball the two look alike. At grazing angles Blinn's grows long, as on a wet road, "
        "while Phong's stays round. Unlike in the source, both are multiplied by N·L and normalized.",
        static_cast<double>(kRoughness), shading::specular_exponent(static_cast<double>(kRoughness)));
    const std::string energy = fmt::format(
        " Polar plots: radiance reflected in the plane of incidence, k_{{d}} = {:g}, k_{{s}} = {:g}, s = {:g}, p = {:g}, with the factor "
        "N·L (solid) and without it (dashed). Last plots: energy reflected, as a share of that received. With N·L it is at most k_{{d}} + "
        "k_{{s}} (largest: {:.3f} for Phong, {:.3f} for Blinn). Without it, more than all is reflected from {:.0f}° on for Phong and from "
        "{:.0f}° for Blinn, with k_{{d}} = 0 and k_{{s}} = 1 from {:.0f}° and {:.0f}°.",
        kDiffuse, kSpecular, kExponent, kExponent / 4, largest(shares[0].series[1]), largest(shares[0].series[3]),
        first_above_1(shares[0].series[0]), first_above_1(shares[0].series[2]), first_above_1(shares[1].series[0]),
        first_above_1(shares[1].series[2]));
    return Figure{.caption = balls + energy, .parts = {std::move(*pictures), std::move(plots), lobes, shares}};
}

}  // namespace halflit::cli
