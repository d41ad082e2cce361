// The wrap family on a sphere and on a bust.
#include "apps/lab/figure_entries.hpp"
#include "apps/lab/figure_studio.hpp"
#include "sh/lobe_error.hpp"

#include <fmt/core.h>

namespace halflit::cli {
namespace {

constexpr Subject kSubjects[] = {Subject::sphere, Subject::bust};
constexpr float kWraps[] = {0.0f, 0.25f, 0.5f, 0.75f, 1.0f};
constexpr Vec3f kSkin{0.86f, 0.62f, 0.50f};

Shot lit(Shot shot, Vec3f direction, float strength) {
    shot.scene.lights = {light_from(direction, strength)};
    return shot;
}

/// The lobe, with its scale, over the cosine from -1 to 1.
PlotSeries over_cosine(std::string name, const Lobe& lobe, std::string color = {}, std::string dash = {}) {
    const sh::WrapLobe in_double{
        static_cast<double>(lobe.wrap), static_cast<double>(lobe.power),
        lobe.normalize ? sh::normalizing_scale(static_cast<double>(lobe.wrap), static_cast<double>(lobe.power)) : 1.0};
    PlotSeries series{.name = std::move(name), .points = {}, .color = std::move(color), .dash = std::move(dash)};
    for (int i = -100; i <= 100; ++i) series.points.push_back({i / 100.0, sh::lobe_value(in_double, i / 100.0)});
    return series;
}

}  // namespace

Result<Figure> make_wrap_form_figure() {
    constexpr float kStrength = 1.0f;
    PictureGrid grid{.columns = {"a = 0, Lambert", "a = 1/2", "a = 1"}, .rows = {""}, .width = 270};
    auto pictures = take_grid(std::move(grid), [](std::size_t, std::size_t column) {
        Shot shot = lit(shot_of(Subject::bust, Lobe::sloan(0.5f * static_cast<float>(column)), kSkin), {1.0f, 0.35f, -0.30f}, kStrength);
        shot.width = shot.height = 540;
        return shot;
    });
    if (!pictures) return tl::unexpected(pictures.error());
    return Figure{
        .caption =
            "One directional light of strength 1 from the right, a little above and behind (direction 1, 0.35, −0.3), on a bust whose "
            "diffuse lobe is Sloan's, (max(0, cos θ + a)/(1 + a))^{1+a}, with θ the angle between normal and light. No ambient light, no "
            "shadows. The terminator is the line where the surface turns away from the light. The further the lobe reaches beyond it, the "
            "softer the form looks.",
        .parts = {std::move(*pictures)}};
}

Result<Figure> make_backlight_figure() {
    PictureGrid grid{.columns = {"Green, w = 1", "Valve"}, .rows = {""}, .width = 300};
    auto pictures = take_grid(std::move(grid), [](std::size_t, std::size_t column) {
        Shot shot = lit(shot_of(Subject::sphere, column == 0 ? Lobe::green(1) : Lobe::valve()), {0, 0, -1}, 2.0f);
        shot.settings.background_linear = {0, 0, 0, 1};
        shot.width = shot.height = 600;
        return shot;
    });
    if (!pictures) return tl::unexpected(pictures.error());
    return Figure{
        .caption =
            "A white sphere with a directional light of strength 2 directly behind it. With θ the angle between normal and light, "
            "all visible points have cos θ ≤ 0. Left: (1 + cos θ)/2, which times the strength is 1 at the outline. Right: its "
            "square, ((1 + cos θ)/2)^{2}, which leaves a narrower and dimmer rim.",
        .parts = {std::move(*pictures)}};
}

Result<Figure> make_green_sloan_figure() {
    Figure figure{
        .caption =
            "White matte surfaces under one directional light of strength 1 from the upper right (direction 1, 1, 0.6), no ambient "
            "light; θ is the angle between normal and light. Upper rows: Green's lobe max(0, cos θ + w)/(1 + w). Lower rows: "
            "Sloan's (max(0, cos θ + a)/(1 + a))^{1+a}. Both are Lambert's at 0. At 1 Green's is much flatter, while Sloan's "
            "keeps the cosine's shape around its peak.",
        .parts = {}};
    for (const Subject subject : kSubjects) {
        PictureGrid grid{.columns = {"0", "1/4", "1/2", "3/4", "1"}, .rows = {"Green, w =", "Sloan, a ="}, .width = 150};
        auto pictures = take_grid(std::move(grid), [&](std::size_t row, std::size_t column) {
            const float w = kWraps[column];
            return lit(shot_of(subject, row == 0 ? Lobe::green(w) : Lobe::sloan(w)), {1, 1, 0.6f}, 1.0f);
        });
        if (!pictures) return tl::unexpected(pictures.error());
        figure.parts.emplace_back(std::move(*pictures));
    }
    return figure;
}

Result<Figure> make_normalized_figure() {
    constexpr float kStrength = 0.6f;  // 0.6 * 5/3, the largest normalizing factor, is 1
    const Lobe lobes[] = {Lobe::valve(), Lobe::sloan(0.5f), {0.5f, 4.0f, false}};
    const auto normalized = [](Lobe lobe, bool on) {
        lobe.normalize = on;
        return lobe;
    };
    PictureGrid grid{.columns = {"as it is", "normalized", "as it is", "normalized"},
                     .rows = {"Valve\n(w 1, n 2)", "Sloan, a = 0.5\n(w 0.5, n 1.5)", "generic\n(w 0.5, n 4)"},
                     .width = 165};
    auto pictures = take_grid(std::move(grid), [&](std::size_t row, std::size_t column) {
        return lit(shot_of(kSubjects[column / 2], normalized(lobes[row], column % 2 == 1), {0.95f, 0.90f, 0.82f}), {0.8f, 0.6f, 0.5f},
                   kStrength);
    });
    if (!pictures) return tl::unexpected(pictures.error());
    Plot plot{.title = "The three lobes, as they are (dashed) and normalized",
              .x = {.label = "cos θ", .min = -1, .max = 1},
              .y = {.label = "reflected", .min = 0, .max = 1.75},
              .series = {},
              .marks = {},
              .legend = LegendPlace::top_left,
              .width = 620,
              .height = 330};
    const char* const names[] = {"Valve", "Sloan, a = 0.5", "w 0.5, n 4"};
    const char* const colors[] = {"#0072b2", "#d55e00", "#009e73"};
    for (std::size_t i = 0; i < 3; ++i) {
        plot.series.push_back(over_cosine(std::string(names[i]) + ", as it is", normalized(lobes[i], false), colors[i], "5 3"));
        plot.series.push_back(over_cosine(std::string(names[i]) + ", normalized", normalized(lobes[i], true), colors[i]));
    }
    return Figure{
        .caption =
            "The lobe (max(0, cos θ + w)/(1 + w))^{n} as it is, and normalized: times (n + 1)/(2(1 + w)), which makes the mean over all "
            "light "
            "directions Lambert's. Here θ is the angle between normal and light. The factors are 3/4, 5/6 and 5/3, so the first two lobes "
            "get darker and the last one brighter. One directional light of strength 0.6 (direction 0.8, 0.6, 0.5), chosen so that nothing "
            "clips. From single directions more light may be reflected than arrives; only the mean is kept.",
        .parts = {std::move(*pictures), PlotRow{plot}}};
}

Result<Figure> make_half_lambert_figure() {
    const Lobe lobes[] = {Lobe::lambert(), Lobe::half_lambert(), Lobe::valve()};
    PictureGrid grid{.columns = {"max(0, x)", "(1 + x)/2", "((1 + x)/2)^{2}"}, .rows = {"", ""}, .width = 220};
    auto pictures = take_grid(std::move(grid), [&](std::size_t row, std::size_t column) {
        Shot shot = lit(shot_of(kSubjects[row], lobes[column]), {1, 0.7f, 0.25f}, 1.0f);
        shot.width = shot.height = 440;
        return shot;
    });
    if (!pictures) return tl::unexpected(pictures.error());
    PlotRow plots;
    const PlotAxis x{.label = "x = N·L", .min = -1, .max = 1}, y{.label = "reflected", .min = 0, .max = 1};
    for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
        Plot plot{.title = i == 1 ? "Linear" : "Squared",
                  .x = x,
                  .y = y,
                  .series = {},
                  .marks = {},
                  .legend = LegendPlace::top_left,
                  .width = 380,
                  .height = 290};
        plot.series = {over_cosine("max(0, x)", lobes[0], "#cc2222"),
                       i == 1 ? over_cosine("(1 + x)/2", lobes[1], "#2255cc") : over_cosine("((1 + x)/2)^{2}", lobes[2], "#e08214")};
        plots.push_back(std::move(plot));
    }
    return Figure{
        .caption =
            "One directional light of strength 1 (direction 1, 0.7, 0.25), no ambient light, sRGB output and nothing else; x = N·L is the "
            "cosine between normal and light. Lambert leaves half of the form black. Half-Lambert shows all of it, but too brightly. Its "
            "square has Lambert's values and slopes at x = −1 and x = 1. Both are exactly Lambert under other lights: half-Lambert under a "
            "hemisphere of constant light, its square under a hemisphere of 2 cos^{2} of the angle to its axis.",
        .parts = {std::move(*pictures), std::move(plots)}};
}

}  // namespace halflit::cli
