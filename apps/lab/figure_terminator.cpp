// Effect of shadow maps on wrapped light: three bodies, three modes, five wraps, and profiles of the light across the terminator.
#include "apps/lab/figure_entries.hpp"
#include "apps/lab/figure_studio.hpp"
#include "halflit/shapes.hpp"

#include <fmt/core.h>

#include <cmath>

namespace halflit::cli {
namespace {

constexpr float kSphereWraps[] = {0.0f, 0.25f, 0.5f, 0.75f, 1.0f};
constexpr ShadowMode kModes[] = {ShadowMode::off, ShadowMode::hard, ShadowMode::soft_split};
constexpr const char* kModeNames[] = {"off", "hard", "soft-split"};

enum class Body { smooth, coarse, shadowed };

/// A white body of radius 1, the light from the right.
Shot shot_of(Body body, ShadowMode mode, float wrap) {
    Shot shot = empty_shot();
    const bool coarse = body == Body::coarse;
    add_object(shot, make_sphere(1.0f, coarse ? 32 : 256, coarse ? 16 : 128), matte(Lobe::sloan(wrap)));
    // The ball is outside the picture, and farther from the body than wrapped light takes to fade.
    if (body == Body::shadowed) add_object(shot, make_sphere(0.2f, 96, 48), matte(Lobe::lambert()), {5.0f, 0.0f, 0.8f});
    shot.camera = front_camera(1.08f);
    shot.scene.lights = {light_from({1, 0, 0})};
    shot.settings.shadows = mode;
    return shot;
}

/// Profile of linear light over x, along a row of pixels a tenth of the radius above the middle. On a sphere lit from the right, x is N.L.
Result<PlotSeries> profile(Body body, ShadowMode mode, float wrap) {
    constexpr int kPixels = 600, kRow = kPixels * 45 / 100;
    Shot shot = shot_of(body, mode, wrap);
    shot.camera = front_camera(1.0f);
    shot.width = shot.height = kPixels;
    shot.settings.samples = 1;
    shot.settings.background_linear = {0, 0, 0, 0};
    shot.settings.region = {0, kRow, kPixels, 1};
    const auto picture = take(shot);
    if (!picture) return tl::unexpected(picture.error());
    PlotSeries series{.name = fmt::format("a = {:g}", static_cast<double>(wrap)), .points = {}, .line_width = 1.4};
    for (int i = 0; i < kPixels; ++i) {
        const float* pixel = &picture->rgba_linear[4 * (static_cast<std::size_t>(kRow) * kPixels + static_cast<std::size_t>(i))];
        if (pixel[3] > 0.0f) series.points.push_back({(2.0 * i + 1.0) / kPixels - 1.0, static_cast<double>(pixel[0])});
    }
    return series;
}

Result<PlotRow> profiles(Body body) {
    PlotRow plots;
    for (std::size_t mode = 0; mode < std::size(kModes); ++mode) {
        Plot plot{.title = kModeNames[mode],
                  .x = {.label = "x across the body", .min = -1, .max = 1},
                  .y = {.label = "linear light", .min = 0, .max = 1},
                  .series = {},
                  .marks = {{0, "x = 0"}},
                  .legend = LegendPlace::top_left,
                  .width = 330,
                  .height = 260};
        for (const float wrap : kSphereWraps) {
            auto series = profile(body, kModes[mode], wrap);
            if (!series) return tl::unexpected(series.error());
            plot.series.push_back(std::move(*series));
        }
        plots.push_back(std::move(plot));
    }
    return plots;
}

/// Two decimals, with a typographic minus.
std::string typographic(double value) { return fmt::format("{}{:.2f}", value < 0 ? "−" : "", std::abs(value)); }

/// The largest x where `cut` has less than half of the light of `whole`; -1 if there is none.
double cut_at(const PlotSeries& whole, const PlotSeries& cut) {
    double x = -1;
    for (std::size_t i = 0; i < cut.points.size(); ++i)
        if (cut.points[i].y < 0.5 * whole.points[i].y) x = cut.points[i].x;
    return x;
}

}  // namespace

Result<Figure> make_terminator_figure() {
    struct Section {
        Body body;
        const char *name, *short_name;
    };
    constexpr Section kSections[] = {{Body::smooth, "Sphere", "sphere"},
                                     {Body::coarse, "Coarse sphere, 32 × 16", "coarse sphere"},
                                     {Body::shadowed, "Sphere with the shadow of a ball", "ball's shadow"}};
    Figure figure;
    std::vector<double> cuts;
    for (const Section& section : kSections) {
        PictureGrid grid{.title = section.name,
                         .columns = {"a = 0", "a = 1/4", "a = 1/2", "a = 3/4", "a = 1"},
                         .rows = {kModeNames[0], kModeNames[1], kModeNames[2]},
                         .width = 170};
        auto pictures = take_grid(
            std::move(grid), [&](std::size_t row, std::size_t column) { return shot_of(section.body, kModes[row], kSphereWraps[column]); });
        if (!pictures) return tl::unexpected(pictures.error());
        auto plots = profiles(section.body);
        if (!plots) return tl::unexpected(plots.error());
        cuts.push_back(cut_at((*plots)[0].series.back(), (*plots)[1].series.back()));
        for (Plot& plot : *plots) plot.title = std::string(section.short_name) + ", " + plot.title;
        figure.parts.emplace_back(std::move(*pictures));
        figure.parts.emplace_back(std::move(*plots));
    }
    figure.caption = fmt::format(
        "White bodies of radius 1 with Sloan's lobe f, one directional light of strength 1 from the right, a shadow map of 2048 texels. "
        "Rows: shadows off (f); hard (f times visibility); soft-split (Lambert's part times visibility, while the wrapped rest fades with "
        "the distance to the blocker, here over 9a/4). The plots show linear light along a row of pixels a tenth of the radius above the "
        "middle. On the sphere x is N·L, the cosine between normal and light, and the first plot is f. The terminator, where a body turns "
        "away from the light, is at x = 0. There hard visibility cuts f off, a step of f(0) = (a/(1 + a))^{{1+a}}: 0, 0.134, 0.192, 0.227 "
        "and 0.250 for the five wraps. Because the map is looked up 3 texels off the surface, the step is seen at x = {} on the sphere "
        "and at {} on the coarse one, whose edges show. Soft-split is f on the lit side and continuous at the terminator. In the "
        "shadow "
        "of the ball, which has radius 0.2 and is 5 away towards the light, it is dark on both sides.",
        typographic(cuts[0]), typographic(cuts[1]));
    return figure;
}

}  // namespace halflit::cli
