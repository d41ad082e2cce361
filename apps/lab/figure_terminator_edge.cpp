// Many lights and an environment on a ball: where the edge of the first light's terminator goes unnoticed.
#include "apps/lab/figure_entries.hpp"
#include "apps/lab/figure_studio.hpp"
#include "apps/lab/terminator_contrast.hpp"
#include "halflit/shapes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace halflit::cli {
namespace {

constexpr int kLightCounts[] = {1, 2, 4, 8, 16};
constexpr int kMostLights = 16;
constexpr double kShares[] = {0, 0.1, 0.2, 0.35, 0.5};  ///< of the pictures
constexpr double kDashedShare = 0.2;                    ///< environment of the dashed curves

struct EdgeLobe {
    const char *name, *color;
    Lobe lobe;
};
const EdgeLobe kEdgeLobes[] = {
    {"Lambert", "#0072b2", Lobe::lambert()}, {"Sloan, a = 0.5", "#d55e00", Lobe::sloan(0.5f)}, {"Valve", "#009e73", Lobe::valve()}};

sh::WrapLobe in_double(const Lobe& lobe) { return {static_cast<double>(lobe.wrap), static_cast<double>(lobe.power), 1.0}; }

Result<Shot> rig_shot(const Lobe& lobe, const LightRig& rig) {
    Shot shot = empty_shot();
    add_object(shot, make_sphere(1.0f, 256, 128), matte(lobe));
    shot.camera = front_camera(1.08f);
    const auto strength = static_cast<float>((1 - rig.environment) / rig.lights);
    for (const Vec3d& direction : rig_directions(rig.lights)) shot.scene.lights.push_back(light_from(to_float(direction), strength));
    if (rig.environment > 0) {
        EnvironmentImage sky{.width = 16, .height = 8, .rgb = {}, .calibrated = true};
        sky.rgb.assign(std::size_t{3} * 16 * 8, static_cast<float>(rig.environment));
        const auto environment = make_environment(sky, {.extract_suns = false});
        if (!environment) return tl::unexpected(environment.error());
        shot.scene.environment = *environment;
    }
    return shot;
}

constexpr int kRowPixels = 400;  ///< a step of the contrast is 10 pixels: pixel i is at p = i / 200 - 1

/// Linear light along the middle row, drawn by the renderer.
Result<std::vector<double>> drawn_row(Shot shot) {
    constexpr float kHalfPixel = 1.0f / kRowPixels;
    shot.camera = front_camera(1.0f, {-kHalfPixel, kHalfPixel, 0});
    shot.width = shot.height = kRowPixels;
    shot.settings.samples = 1;
    shot.settings.background_linear = {0, 0, 0, 0};
    shot.settings.region = {0, kRowPixels / 2, kRowPixels, 1};
    const auto picture = take(shot);
    if (!picture) return tl::unexpected(picture.error());
    std::vector<double> row;
    for (std::size_t i = 0; i < kRowPixels; ++i)
        row.push_back(static_cast<double>(picture->rgba_linear[4 * (std::size_t{kRowPixels} * kRowPixels / 2 + i)]));
    return row;
}

/// The edge's contrast, from pictures with all light and with the first light alone. The wrap is at most 0.9, so that all steps stay on the
/// ball.
Result<double> drawn_contrast(const Lobe& lobe, const LightRig& rig) {
    auto shot = rig_shot(lobe, rig);
    if (!shot) return tl::unexpected(shot.error());
    const auto all = drawn_row(*shot);
    if (!all) return tl::unexpected(all.error());
    shot->scene.lights.resize(1);
    shot->scene.environment.reset();
    const auto first = drawn_row(*shot);
    if (!first) return tl::unexpected(first.error());
    constexpr int kStep = kRowPixels / 40;
    static_assert(kStep == kEdgeStep * kRowPixels / 2);
    const int edge = static_cast<int>(std::lround((1 - static_cast<double>(lobe.wrap)) * kRowPixels / 2));
    double largest = 0;
    for (int i = edge - kStep; i <= edge + kStep; ++i) {
        const auto at = [&](int pixel) { return (*first)[static_cast<std::size_t>(pixel)]; };
        const double departs = 0.5 * (at(i - kStep) + at(i + kStep)) - at(i);
        largest = std::max(largest, std::fabs(departs) / ((*all)[static_cast<std::size_t>(i)] + kFlare));
    }
    return largest;
}

/// fn(rig) for each count of lights.
template <class Fn>
PlotSeries over_lights(std::string name, const EdgeLobe& lobe, double environment, Fn&& fn) {
    PlotSeries series{.name = std::move(name), .points = {}, .color = lobe.color, .dash = environment > 0 ? "5 3" : ""};
    for (int n = 1; n <= kMostLights; ++n) series.points.push_back({double(n), fn(in_double(lobe.lobe), LightRig{n, environment})});
    return series;
}

Plot plot_over_lights(std::string title, PlotAxis y) {
    return {.title = std::move(title), .x = {.label = "lights", .min = 0, .max = 17, .step = 2}, .y = std::move(y)};
}

PlotSeries threshold(double to) {
    return {.name = "1 %, visible", .points = {{0, 100 * kVisibleContrast}, {to, 100 * kVisibleContrast}}, .color = "#777", .dash = "2 3"};
}

Result<Plot> contrast_over_lights() {
    Plot plot = plot_over_lights("Contrast of the edge", {.label = "contrast, %", .min = 0.001, .max = 10000, .log = true});
    const auto percent = [](const sh::WrapLobe& lobe, const LightRig& rig) { return 100 * edge_contrast(lobe, rig); };
    for (const EdgeLobe& lobe : kEdgeLobes) {
        plot.series.push_back(over_lights(lobe.name, lobe, 0, percent));
        plot.series.push_back(over_lights("", lobe, kDashedShare, percent));
        plot.series.back().name = fmt::format("{}, e = {:.0f} %", lobe.name, 100 * kDashedShare);
    }
    for (const EdgeLobe& lobe : kEdgeLobes) {
        if (lobe.lobe == Lobe::valve()) continue;  // the step reaches the outline, where a pixel is covered in part
        PlotSeries drawn{.name = fmt::format("{}, drawn", lobe.name), .points = {}, .color = lobe.color, .mark = PlotSeries::Mark::dots};
        for (const int n : kLightCounts) {
            const auto contrast = drawn_contrast(lobe.lobe, {n, 0});
            if (!contrast) return tl::unexpected(contrast.error());
            drawn.points.push_back({double(n), 100 * *contrast});
        }
        plot.series.push_back(std::move(drawn));
    }
    plot.series.push_back(threshold(17));
    return plot;
}

Plot codes_over_lights() {
    Plot plot = plot_over_lights("Largest second difference of codes", {.label = "codes", .min = 0.01, .max = 100, .log = true});
    for (const EdgeLobe& lobe : kEdgeLobes) {
        if (lobe.lobe == Lobe::valve()) continue;  // its edge is the outline, where the ball's own curvature is all that would be seen
        plot.series.push_back(over_lights(lobe.name, lobe, 0, edge_codes));
        plot.series.push_back(over_lights(fmt::format("{}, e = {:.0f} %", lobe.name, 100 * kDashedShare), lobe, kDashedShare, edge_codes));
    }
    return plot;
}

template <class Fn>
Plot plot_over_share(std::string title, PlotAxis y, Fn&& fn) {
    Plot plot{.title = std::move(title), .x = {.label = "environment e, %", .min = 0, .max = 50, .step = 10}, .y = std::move(y)};
    for (const int n : kLightCounts) {
        PlotSeries series{.name = n == 1 ? "1 light" : fmt::format("{} lights", n), .points = {}};
        for (int e = 0; e <= 50; ++e) series.points.push_back({double(e), fn(LightRig{n, e / 100.0})});
        plot.series.push_back(std::move(series));
    }
    return plot;
}

bool goes_unnoticed(const Lobe& lobe, const LightRig& rig) { return edge_contrast(in_double(lobe), rig) < kVisibleContrast; }

/// The count from which on the edge is below the threshold.
int unnoticed_from(const Lobe& lobe, double environment) {
    int n = kMostLights + 1;
    while (n > 1 && goes_unnoticed(lobe, {n - 1, environment})) --n;
    return n;
}

/// "8 %", the whole percent of environment from which on the edge is below the threshold.
std::string share_needed(const Lobe& lobe, int lights) {
    int e = 100;
    while (e > 0 && goes_unnoticed(lobe, {lights, (e - 1) / 100.0})) --e;
    return e == 0 ? "none" : fmt::format("{} %", e);
}

std::string numbers_found() {
    const Lobe lambert = kEdgeLobes[0].lobe, sloan = kEdgeLobes[1].lobe, valve = kEdgeLobes[2].lobe;
    std::string text = fmt::format(
        "Below 1 % without an environment: Lambert from {} lights on, Sloan from {}, Valve from {}; with e = {:.0f} %: "
        "from {}, {} and {}. Environment needed by Lambert:",
        unnoticed_from(lambert, 0), unnoticed_from(sloan, 0), unnoticed_from(valve, 0), 100 * kDashedShare,
        unnoticed_from(lambert, kDashedShare), unnoticed_from(sloan, kDashedShare), unnoticed_from(valve, kDashedShare));
    for (const int n : kLightCounts)
        text += fmt::format("{} {} with {} light{}", n == 1 ? "" : ",", share_needed(lambert, n), n, n == 1 ? "" : "s");
    return text + fmt::format("; with 1 light, by Sloan {}, by Valve {}.", share_needed(sloan, 1), share_needed(valve, 1));
}

std::string edge_caption() {
    constexpr double kMiddle = 0.25;  // Lambert's light at the edge of one of two lights
    return fmt::format(
        "White balls under n equal lights: the first from the right, the others spread evenly over the viewer's side. Their strengths sum "
        "to "
        "1 − e, and an environment has the constant radiance e. The first light ends at N·L = −w. The contrast of this edge is the "
        "departure "
        "of the first light from its mean {:g}° to either side, divided by all light there plus {:g} % of white (the flare of sRGB's "
        "viewing "
        "conditions); the ball is {:g}° wide in the visual field. A step of 1 % is visible (Weber): a jump of the slope by {:.0f} % of the "
        "luminance per degree, which at {:g} of white is {:.1f} codes per degree. Dots are measured in pictures of the renderer. {} "
        "Lambert's "
        "contrast is h/2 (1 − e)/n over the light, h = {:g} radii. Valve's edge is the outline; its number is the bend of the whole curve "
        "there. The second difference is that of all light; its floor is the bend of the other lights and of the sRGB curve.",
        kEdgeStepDeg, 100 * kFlare, 2 * kBallRadiusDeg, 200 * kVisibleContrast / kEdgeStepDeg, kMiddle,
        2 * kVisibleContrast / kEdgeStepDeg * (kMiddle + kFlare) * code_slope(kMiddle), numbers_found(), kEdgeStep);
}

/// Draws the grid's pictures from rigs.
template <class Fn>
Result<PictureGrid> take_rigs(PictureGrid grid, Fn&& rig_at) {
    for (std::size_t row = 0; row < grid.rows.size(); ++row)
        for (std::size_t column = 0; column < grid.columns.size(); ++column) {
            const std::pair<Lobe, LightRig> rig = rig_at(row, column);
            const auto shot = rig_shot(rig.first, rig.second);
            if (!shot) return tl::unexpected(shot.error());
            auto picture = take(*shot);
            if (!picture) return tl::unexpected(picture.error());
            grid.pictures.push_back(std::move(*picture));
        }
    return grid;
}

}  // namespace

Result<Figure> make_terminator_edge_figure() {
    PictureGrid counts{
        .title = "More lights, no environment", .columns = {}, .rows = {"Lambert", "Sloan,\na = 0.5", "Valve"}, .width = 150};
    for (const int n : kLightCounts) counts.columns.push_back(n == 1 ? "1 light" : fmt::format("{} lights", n));
    auto by_count = take_rigs(std::move(counts), [](std::size_t row, std::size_t column) {
        return std::pair{kEdgeLobes[row].lobe, LightRig{kLightCounts[column], 0}};
    });
    if (!by_count) return tl::unexpected(by_count.error());
    PictureGrid shares{.title = "More environment",
                       .columns = {},
                       .rows = {"Lambert,\n1 light", "Lambert,\n2 lights", "Sloan,\na = 0.5,\n1 light"},
                       .width = 150};
    for (const double e : kShares) shares.columns.push_back(fmt::format("e = {:.0f} %", 100 * e));
    auto by_share = take_rigs(std::move(shares), [](std::size_t row, std::size_t column) {
        return std::pair{kEdgeLobes[row / 2].lobe, LightRig{row == 1 ? 2 : 1, kShares[column]}};
    });
    if (!by_share) return tl::unexpected(by_share.error());

    auto contrast = contrast_over_lights();
    if (!contrast) return tl::unexpected(contrast.error());
    PlotRow first{std::move(*contrast), codes_over_lights()};
    PlotRow second{plot_over_share("Contrast of Lambert's edge", {.label = "contrast, %", .min = 0.1, .max = 1000, .log = true},
                                   [](const LightRig& rig) { return 100 * edge_contrast({}, rig); }),
                   plot_over_share("Jump of the slope at Lambert's edge",
                                   {.label = "codes per degree", .min = 0.1, .max = 1000, .log = true}, lambert_slope_jump)};
    second[0].series.push_back(threshold(50));
    for (PlotRow* row : {&first, &second})
        for (Plot& plot : *row) plot.width = 470, plot.height = row == &first ? 420 : 340;
    return Figure{.caption = edge_caption(), .parts = {std::move(*by_count), std::move(*by_share), std::move(first), std::move(second)}};
}

}  // namespace halflit::cli
