// A sphere of light beside one directional light whose lobe is wrapped to match.
#include "apps/lab/figure_entries.hpp"
#include "apps/lab/figure_studio.hpp"
#include "apps/lab/sphere_light.hpp"
#include "sh/lobe_error.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>

#include <cmath>

namespace halflit::cli {
namespace {

constexpr int kShownDegrees[] = {0, 15, 30, 45, 60, 90};  ///< angular radii of the pictures
constexpr int kSphereLights = 500;                        ///< directional lights that stand for the sphere of light
constexpr Vec3d kToSphere{0.8, 0.5, 0.33166247903554};    // of length 1

double in_radians(double degrees) { return degrees * kPi / 180.0; }

/// Fits of each family, by whole degrees of the sphere's radius; at 0, a point of light, Lambert's lobe.
struct Fits {
    std::vector<LobeFit> green = of(LobeFamily::green), sloan = of(LobeFamily::sloan), any = of(LobeFamily::any);

    static std::vector<LobeFit> of(LobeFamily family) {
        std::vector<LobeFit> fits(1);
        for (int degrees = 1; degrees <= 90; ++degrees) fits.push_back(fit_sphere_light(family, in_radians(degrees)));
        return fits;
    }
};

/// Directional lights that fill the sphere of light: a spiral, each with the same solid angle. A surface that faces the sphere reflects 1.
std::vector<Light> spiral_of_lights(int degrees) {
    if (degrees == 0) return {light_from(to_float(kToSphere))};
    constexpr double kTurn = 2.399963229728653;  // golden angle, pi (3 - sqrt 5)
    const Vec3d side{kToSphere.y / std::hypot(kToSphere.x, kToSphere.y), -kToSphere.x / std::hypot(kToSphere.x, kToSphere.y), 0};
    const Vec3d up = cross(side, kToSphere);
    std::vector<Light> lights;
    double facing = 0;
    for (int i = 0; i < kSphereLights; ++i) {
        const double cosine = 1 - (1 - std::cos(in_radians(degrees))) * (i + 0.5) / kSphereLights, sine = std::sqrt(1 - cosine * cosine);
        const Vec3d direction = kToSphere * cosine + side * (sine * std::cos(kTurn * i)) + up * (sine * std::sin(kTurn * i));
        facing += cosine;
        lights.push_back(light_from(to_float(direction)));
    }
    for (Light& light : lights) light.color_linear = Vec3f{1, 1, 1} * static_cast<float>(1 / facing);
    return lights;
}

Shot sphere_lit_shot(const Fits& fits, Subject subject, std::size_t row, int degrees) {
    Lobe lobe = Lobe::lambert();
    if (row == 1) {
        const sh::WrapLobe& fit = fits.any[static_cast<std::size_t>(degrees)].lobe;
        lobe = {static_cast<float>(fit.wrap), static_cast<float>(fit.power), false};
    }
    Shot shot = shot_of(subject, lobe, {0.9f, 0.9f, 0.9f});
    shot.scene.lights = row == 0 ? spiral_of_lights(degrees) : std::vector<Light>{light_from(to_float(kToSphere))};
    return shot;
}

/// Series of fn(degrees) over the angular radius s, for each whole degree.
template <class Fn>
PlotSeries over_radius(std::string name, std::string color, std::string dash, int last, Fn&& fn) {
    PlotSeries series{.name = std::move(name), .points = {}, .color = std::move(color), .dash = std::move(dash)};
    for (int degrees = 1; degrees <= last; ++degrees) series.points.push_back({double(degrees), fn(degrees)});
    return series;
}

Plot light_over_angle(const Fits& fits) {
    Plot plot{.title = "Light of the sphere, and the nearest lobe (dashed)",
              .x = {.label = "angle θ between normal and centre, degrees", .min = 0, .max = 180, .step = 30},
              .y = {.label = "reflected", .min = 0, .max = 1.05}};
    constexpr const char* kColors[] = {"#000000", "#0072b2", "#56b4e9", "#009e73", "#e69f00", "#d55e00"};
    for (std::size_t i = 0; i < std::size(kShownDegrees); ++i) {
        const int degrees = kShownDegrees[i];
        const sh::WrapLobe& lobe = fits.any[static_cast<std::size_t>(degrees)].lobe;
        PlotSeries light{.name = fmt::format("s = {}°", degrees), .points = {}, .color = kColors[i]};
        PlotSeries fit{.name = "", .points = {}, .color = "#000000", .dash = "4 3", .line_width = 1.2};
        for (int angle = 0; angle <= 180; ++angle) {
            const double x = std::cos(in_radians(angle));
            light.points.push_back({double(angle), degrees == 0 ? std::max(x, 0.0) : sphere_light(x, in_radians(degrees))});
            fit.points.push_back({double(angle), sh::lobe_value(lobe, x)});
        }
        plot.series.push_back(std::move(light));
        if (degrees != 0) plot.series.push_back(std::move(fit));
    }
    return plot;
}

Plot wrap_over_radius(const Fits& fits) {
    const auto wrap_of = [](const std::vector<LobeFit>& family) {
        return [&family](int degrees) { return family[static_cast<std::size_t>(degrees)].lobe.wrap; };
    };
    const auto tangent_squared = [](int degrees) {
        const double tangent = std::tan(in_radians(degrees) / 2);
        return tangent * tangent;
    };
    Plot plot{.title = "Wrap and power of the nearest lobes",
              .x = {.label = "angular radius s of the sphere, degrees", .min = 0, .max = 90, .step = 15},
              .y = {.label = "w, n", .min = 0, .max = 3.4},
              .series = {},
              .marks = {},
              .legend = LegendPlace::top_left};
    plot.series = {over_radius("n", "#d55e00", "", 90, [&](int degrees) { return fits.any[static_cast<std::size_t>(degrees)].lobe.power; }),
                   over_radius("w", "#0072b2", "", 90, wrap_of(fits.any)),
                   over_radius("Sloan's a", "#009e73", "", 90, wrap_of(fits.sloan)),
                   over_radius("1/cos s − 1", "#009e73", "5 3", 60, [](int degrees) { return 1 / std::cos(in_radians(degrees)) - 1; }),
                   over_radius("Green's w", "#cc79a7", "", 90, wrap_of(fits.green)),
                   over_radius("tan^{2}(s/2)", "#cc79a7", "5 3", 90, tangent_squared)};
    return plot;
}

Plot error_over_radius(const Fits& fits) {
    const auto worst_of = [](const std::vector<LobeFit>& family) {
        return [&family](int degrees) { return family[static_cast<std::size_t>(degrees)].worst; };
    };
    Plot plot{.title = "Largest difference from the sphere's light",
              .x = {.label = "angular radius s of the sphere, degrees", .min = 0, .max = 90, .step = 15},
              .y = {.label = "share of the peak", .min = 0, .max = 0.2},
              .series = {},
              .marks = {},
              .legend = LegendPlace::top_left};
    plot.series = {
        over_radius("Lambert", "#000000", "2 3", 50, [](int degrees) { return lobe_against_sphere({}, in_radians(degrees)).worst; }),
        over_radius("Green", "#cc79a7", "", 90, worst_of(fits.green)), over_radius("Sloan", "#009e73", "", 90, worst_of(fits.sloan)),
        over_radius("w and n", "#0072b2", "", 90, worst_of(fits.any))};
    return plot;
}

}  // namespace

Result<Figure> make_area_light_figure() {
    const Fits fits;
    Figure figure;
    for (const Subject subject : {Subject::sphere, Subject::bust}) {
        PictureGrid grid{
            .columns = {}, .rows = {"sphere light,\nLambert", "one light,\nnearest lobe", "one light,\nLambert"}, .width = 150};
        for (const int degrees : kShownDegrees) grid.columns.push_back(fmt::format("s = {}°", degrees));
        auto pictures = take_grid(std::move(grid), [&](std::size_t row, std::size_t column) {
            return sphere_lit_shot(fits, subject, row, kShownDegrees[column]);
        });
        if (!pictures) return tl::unexpected(pictures.error());
        figure.parts.emplace_back(std::move(*pictures));
    }
    PlotRow plots{light_over_angle(fits), wrap_over_radius(fits), error_over_radius(fits)};
    for (Plot& plot : plots) plot.width = 370, plot.height = 310;
    figure.parts.emplace_back(std::move(plots));

    std::string table;
    for (int degrees = 10; degrees <= 90; degrees += 10) {
        const LobeFit& fit = fits.any[static_cast<std::size_t>(degrees)];
        table +=
            fmt::format("{} {}°: {:.2f}, {:.2f} ({:.3f})", degrees == 10 ? "" : ";", degrees, fit.lobe.wrap, fit.lobe.power, fit.worst);
    }
    figure.caption = fmt::format(
        "A sphere of uniform light of angular radius s, whose part below the horizon gives none, on a Lambert surface, without shadows, "
        "beside one directional light on a surface with the lobe (max(0, cos θ + w)/(1 + w))^{{n}}. Both give 1 where the surface faces "
        "the "
        "light. In the pictures {} directional lights stand for the sphere; the curves are its integral in closed form. The sphere's light "
        "is Lambert's cosine where the whole sphere is above the horizon, cos θ ≥ sin s, and ends at cos θ = −sin s. The nearest lobe has "
        "the least squared error over all directions of the normal, so every patch of a ball weighs the same. s, w, n and the largest "
        "difference:{}. At 90° the sphere fills a hemisphere, and half-Lambert is exact. With one parameter, Sloan's lobe comes "
        "near up to 60°; the wrap that keeps the sphere's total light is a = 1/cos s − 1, for Green's lobe w = tan^{{2}}(s/2).",
        kSphereLights, table);
    return figure;
}

}  // namespace halflit::cli
