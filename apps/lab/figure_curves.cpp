// Figures without pictures: curves computed by sh/.
#include "apps/lab/figure_entries.hpp"
#include "sh/lobe_error.hpp"

#include <fmt/core.h>

#include <cmath>

namespace halflit::cli {
namespace {

constexpr int kWrapSteps = 100;   ///< steps of the wrap a, from 0 to 1
constexpr int kAngleSteps = 720;  ///< steps from -180 to 180 degrees

/// Sloan's lobe with wrap a, [SNY11] eq. 3.
sh::WrapLobe sloan(double a) { return {a, 1.0 + a, 1.0}; }

PlotSeries over_angle(std::string name, const sh::WrapLobe& lobe, std::string color = {}) {
    PlotSeries series{.name = std::move(name), .points = {}, .color = std::move(color)};
    for (int i = 0; i <= kAngleSteps; ++i) {
        const double degrees = -180.0 + 360.0 * i / kAngleSteps;
        series.points.push_back({degrees, sh::lobe_value(lobe, std::cos(degrees * kPi / 180.0))});
    }
    return series;
}

/// Series of fn(a) over the wrap a.
template <class Fn>
PlotSeries over_wrap(std::string name, Fn&& fn) {
    PlotSeries series{.name = std::move(name), .points = {}};
    for (int i = 0; i <= kWrapSteps; ++i) {
        const double a = static_cast<double>(i) / kWrapSteps;
        series.points.push_back({a, fn(a)});
    }
    return series;
}

/// The integral of f^2 over the sphere, in closed form.
double energy(const sh::WrapLobe& lobe) { return 2.0 * kPi * (1.0 + lobe.wrap) / (2.0 * lobe.power + 1.0); }

/// The fraction of that energy that band l of Sloan's lobe has.
double energy_share(double a, int l) {
    const double f = sh::zonal_bands(sloan(a))[static_cast<std::size_t>(l)];
    return (2.0 * l + 1.0) * (kPi / 4.0) * f * f / energy(sloan(a));
}

}  // namespace

Result<Figure> make_curves_figure() {
    const PlotAxis angle{.label = "angle θ between normal and light, degrees", .min = -180, .max = 180, .step = 90},
        value{.label = "f(θ)", .min = 0, .max = 1.05};
    Plot models{.title = "Three models", .x = angle, .y = value, .series = {}, .marks = {}, .legend = LegendPlace::top_left};
    models.series = {over_angle("Lambert", {0, 1, 1}, "#2255cc"), over_angle("Valve", {1, 2, 1}, "#8833aa"),
                     over_angle("Green, w = 1", {1, 1, 1}, "#b8925a")};
    Plot family{.title = "Sloan's lobe", .x = angle, .y = value, .series = {}, .marks = {}, .legend = LegendPlace::top_left};
    for (const double a : {0.0, 0.25, 0.5, 0.75, 1.0}) family.series.push_back(over_angle(fmt::format("a = {:g}", a), sloan(a)));
    for (Plot* plot : {&models, &family}) plot->width = 460, plot->height = 330;
    return Figure{
        .caption =
            "A lobe is the light that a surface reflects, over the angle θ between its normal and the light. Left: Lambert's "
            "max(0, cos θ), Valve's ((cos θ + 1)/2)^{2}, and Green's max(0, cos θ + w)/(1 + w) at the wrap w = 1. At θ = 0 Valve's "
            "lobe has the first two derivatives of the cosine; Green's is flatter. Right: Sloan's (max(0, cos θ + a)/(1 + a))^{1+a} with "
            "the "
            "wrap a. It is Lambert's at a = 0 and Valve's at a = 1, has those derivatives for every a, and is 0 "
            "from arccos(−a) on.",
        .parts = {PlotRow{models, family}}};
}

Result<Figure> make_sh_error_figure() {
    const auto l2 = [](double a) { return sh::truncation_error(sloan(a), 3).l2; };
    Plot plot{.title = "Order-3 error of Sloan's lobe", .x = {.label = "a", .min = 0, .max = 1}, .y = {.label = "L^{2} error"}};
    plot.series = {over_wrap("absolute, |f − f_{3}|", l2),
                   over_wrap("relative, |f − f_{3}| / |f|", [&](double a) { return l2(a) / std::sqrt(energy(sloan(a))); }),
                   over_wrap("of the normalized lobe f / f_{0}", [&](double a) { return l2(a) / sh::zonal_bands(sloan(a))[0]; })};
    plot.series[1].dash = "6 3";
    plot.series[2].dash = "2 3";
    plot.width = 620;
    plot.height = 380;
    return Figure{
        .caption = fmt::format("The absolute error is the square root of the integral over the sphere of (f − f_{{3}})^{{2}}. Here f = "
                               "(max(0, cos θ + a)/(1 + a))^{{1+a}}, θ is the angle between normal and light, and f_{{3}} is the "
                               "series of three bands of spherical harmonics (nine coefficients). The error falls from {:.6f} "
                               "at a = 0, Lambert's cosine, to {:.6f} at a = 1/2 and {:g} at a = 1, where the lobe is a "
                               "polynomial of degree two in cos θ. The source does not say which scale it plots; all three "
                               "curves have the same shape.",
                               l2(0), l2(0.5), l2(1)),
        .parts = {PlotRow{plot}}};
}

Result<Figure> make_band_energy_figure() {
    Plot low{
        .title = "Shares of the energy", .x = {.label = "a", .min = 0, .max = 1}, .y = {.label = "% of the energy", .min = 0, .max = 100}};
    Plot high{
        .title = "The same on a logarithmic scale", .x = low.x, .y = {.label = "% of the energy", .min = 1e-4, .max = 100, .log = true}};
    for (int l = 0; l < 6; ++l) {
        PlotSeries series = over_wrap(fmt::format("band {}", l), [&](double a) { return 100.0 * energy_share(a, l); });
        low.series.push_back(series);
        high.series.push_back(std::move(series));
    }
    for (Plot* plot : {&low, &high}) plot->width = 460, plot->height = 360;
    high.legend = LegendPlace::none;
    const auto first_three = [](double a) { return 100.0 * (energy_share(a, 0) + energy_share(a, 1) + energy_share(a, 2)); };
    return Figure{.caption = fmt::format(
                      "The energy of a lobe f is the integral |f|^{{2}} of f^{{2}} over the sphere. For Sloan's lobe with the wrap "
                      "a, the plots show the share of each band l of spherical harmonics, (2l + 1)(π/4) f_{{l}}^{{2}} / |f|^{{2}}, "
                      "with the band's factor f_{{l}} and the closed form of |f|^{{2}}. As a grows, energy moves to the lower "
                      "bands: the first three hold {:.3f}% at a = 0, {:.3f}% at a = 1/2 and {:.3f}% at a = 1, where "
                      "bands 3 to 5 are exactly 0. Bands 3 and 5 are also 0 at a = 0, and band 4 is 0 once in between, "
                      "so none of these three falls steadily.",
                      first_three(0), first_three(0.5), first_three(1)),
                  .parts = {PlotRow{low, high}}};
}

}  // namespace halflit::cli
