// Figures of the course
// Lobes, shadows at the terminator and the contrast of its edge, as SVG. Dots are pixels of pictures.   halflit_figures FOLDER
#include <halflit/renderer.hpp>
#include <halflit/shapes.hpp>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

using namespace halflit;

namespace {

using std::numbers::pi;
using Points = std::vector<std::pair<double, double>>;

// ---- plots ----------------------------------------------------------------------------------------------------------------
struct Series {
    std::string name;
    Points points;
    bool dots = false;
    int color = -1;  ///< index into kColors; -1: the place among the series
};

struct Axis {
    std::string label;
    double min = 0, max = 1, step = 0.25;  ///< step: between ticks
    bool log = false;                      ///< min and max are powers of ten, and so are the ticks
};

struct Plot {
    std::string title;
    Axis x, y;
    std::vector<Series> series;
    bool names_right = false;  ///< the series' names are at the right edge, not at the left one
};

constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#a67c00"};
constexpr double kWidth = 300, kHeight = 220, kLeft = 52, kTop = 26, kBottom = 40, kRight = 14;

[[gnu::format(printf, 1, 2)]] std::string text_of(const char* format, ...) {
    char text[512];
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
    return text;
}

/// Place of a value on an axis, 0 to 1.
double place(const Axis& axis, double value) {
    const auto scaled = [&](double v) { return axis.log ? std::log10(std::max(v, axis.min)) : v; };
    return std::clamp((scaled(value) - scaled(axis.min)) / (scaled(axis.max) - scaled(axis.min)), 0.0, 1.0);
}

std::string words(double x, double y, const char* anchor, const std::string& line, const char* fill = "#222") {
    return text_of("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" fill=\"%s\">%s</text>\n", x, y, anchor, fill, line.c_str());
}

std::string drawn(const Plot& plot, double left, double top) {
    const auto x_at = [&](double x) { return left + kWidth * place(plot.x, x); };
    const auto y_at = [&](double y) { return top + kHeight * (1 - place(plot.y, y)); };
    const auto ticks = [](const Axis& axis) {
        std::vector<double> values;
        for (double v = axis.min; v <= axis.max * (1 + 1e-9); v = axis.log ? v * 10 : v + axis.step) values.push_back(v);
        return values;
    };
    std::string svg = words(left + kWidth / 2, top - 8, "middle", plot.title);
    for (const double x : ticks(plot.x)) {
        svg += text_of("<path d=\"M%.1f %.1fv%.1f\" stroke=\"#ddd\"/>\n", x_at(x), top, kHeight);
        svg += words(x_at(x), top + kHeight + 15, "middle", text_of("%g", x));
    }
    for (const double y : ticks(plot.y)) {
        svg += text_of("<path d=\"M%.1f %.1fh%.1f\" stroke=\"#ddd\"/>\n", left, y_at(y), kWidth);
        svg += words(left - 5, y_at(y) + 4, "end", text_of("%g", y));
    }
    svg += words(left + kWidth / 2, top + kHeight + 31, "middle", plot.x.label);
    svg += text_of("<text transform=\"translate(%.1f %.1f) rotate(-90)\" text-anchor=\"middle\">%s</text>\n", left - 38, top + kHeight / 2,
                   plot.y.label.c_str());
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const Series& series = plot.series[i];
        const char* const color = kColors[series.color < 0 ? i : static_cast<std::size_t>(series.color)];
        std::string line;
        for (const auto& [x, y] : series.points)
            if (series.dots)
                svg += text_of("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.5\" fill=\"%s\"/>\n", x_at(x), y_at(y), color);
            else
                line += text_of("%s%.1f,%.1f", line.empty() ? "" : " ", x_at(x), y_at(y));
        if (!line.empty()) svg += "<polyline points=\"" + line + text_of("\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.6\"/>\n", color);
        const double names = plot.names_right ? left + kWidth - 8 : left + 8;
        if (!series.name.empty())
            svg += words(names, top + 16 + 15 * static_cast<double>(i), plot.names_right ? "end" : "start", series.name, color);
    }
    return svg;
}

/// Writes a row of plots. `about` is for screen readers.
bool write_plots(const std::string& path, const std::string& about, const std::vector<Plot>& plots) {
    const double cell = kLeft + kWidth + kRight, width = cell * static_cast<double>(plots.size()), height = kTop + kHeight + kBottom;
    std::ofstream file(path, std::ios::binary);
    file << text_of("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"%g\" font-family=\"sans-serif\" font-size=\"12\">\n",
                    width, height)
         << "<title>" << about << "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    for (std::size_t i = 0; i < plots.size(); ++i) file << drawn(plots[i], cell * static_cast<double>(i) + kLeft, kTop);
    file << "</svg>\n";
    return file.flush().good();
}

// ---- what is plotted --------------------------------------------------------------------------------------------------------
/// The lobe's formula. x is the cosine between the normal and the light.
double value(const Lobe& lobe, double x) {
    const auto w = static_cast<double>(lobe.wrap);
    return std::pow(std::max(0.0, x + w) / (1 + w), static_cast<double>(lobe.power));
}

/// Linear light along the middle row of a picture of a white ball of radius 1, from x = -1 to 1.
std::vector<double> row_of_ball(const Lobe& lobe, const std::vector<Vec3f>& to_lights, ShadowMode shadows, int pixels) {
    Scene scene;
    Material white;
    white.metallic = 0;
    white.lobe = lobe;
    scene.materials = {white};
    scene.meshes = {make_sphere(1, 256, 128)};
    scene.meshes[0].material = 0;
    scene.instances = {{0, translation({0, 0, 0})}};
    const float strength = 1 / static_cast<float>(to_lights.size());
    for (const Vec3f to_light : to_lights) {
        Light light;
        light.direction_ws = to_light * -1.0f;
        light.color_linear = {strength, strength, strength};
        scene.lights.push_back(light);
    }
    Camera camera;
    camera.orthographic = true;
    camera.half_height = 1;
    camera.far_z = 40;
    // Half a pixel to the side: pixel i is at x = 2 i / pixels - 1.
    const float half_pixel = 1 / static_cast<float>(pixels);
    camera.world_from_camera = translation({-half_pixel, half_pixel, 20});
    Settings settings{.samples = 1, .shadows = shadows, .shadow_size = 2048};
    settings.background_linear = {0, 0, 0, 0};
    settings.shading.specular = SpecularModel::none;
    settings.region = {0, pixels / 2, pixels, 1};
    std::vector<float> linear(static_cast<std::size_t>(pixels) * 4);
    const Target target{.width = pixels, .height = pixels, .linear = linear.data(), .region_alone = true};
    if (const auto report = render(scene, camera, settings, target); !report) {
        std::fprintf(stderr, "%s\n", report.error().message.c_str());
        std::exit(static_cast<int>(report.error().code));
    }
    std::vector<double> row;
    for (std::size_t i = 0; i < linear.size(); i += 4) row.push_back(static_cast<double>(linear[i]));
    return row;
}

Series over_angle(std::string name, const Lobe& lobe) {
    Series series{std::move(name), {}};
    for (int degrees = -180; degrees <= 180; degrees += 2) series.points.emplace_back(degrees, value(lobe, std::cos(degrees * pi / 180)));
    return series;
}

/// Dots of the lobe on a ball that is lit from the right: at x the angle to the light is acos x.
Series dots_over_angle(const Lobe& lobe, int color) {
    constexpr int kPixels = 400;
    const auto row = row_of_ball(lobe, {{1, 0, 0}}, ShadowMode::off, kPixels);
    Series series{{}, {}, true, color};
    for (int degrees = 15; degrees <= 165; degrees += 15) {
        const int pixel = static_cast<int>(std::lround((std::cos(degrees * pi / 180) + 1) * kPixels / 2));
        series.points.emplace_back(std::acos(2.0 * pixel / kPixels - 1) * 180 / pi, row[static_cast<std::size_t>(pixel)]);
    }
    return series;
}

std::vector<Plot> lobes() {
    const Axis angle{"angle between normal and light, degrees", -180, 180, 90}, light{"reflected", 0, 1};
    Plot models{"Models", angle, light, {}}, family{"Sloan's lobe", angle, light, {}};
    models.series = {over_angle("Lambert", Lobe::lambert()), over_angle("Green, w = 1", Lobe::green(1)),
                     over_angle("Valve", Lobe::valve())};
    for (int i = 0; i < 3; ++i)
        models.series.push_back(dots_over_angle(i == 0 ? Lobe::lambert() : i == 1 ? Lobe::green(1) : Lobe::valve(), i));
    for (const double a : {0.0, 0.25, 0.5, 0.75, 1.0})
        family.series.push_back(over_angle(text_of("a = %g", a), Lobe::sloan(static_cast<float>(a))));
    return {models, family};
}

/// Light of one light from the right across a ball, with each kind of shadow.
std::vector<Plot> shadows() {
    constexpr int kPixels = 120;
    constexpr std::pair<const char*, ShadowMode> kModes[] = {
        {"no shadows", ShadowMode::off}, {"hard shadows", ShadowMode::hard}, {"soft-split", ShadowMode::soft_split}};
    std::vector<Plot> plots;
    for (const auto& [name, mode] : kModes) {
        Plot plot{name, {"x across the ball", -1, 1, 0.5}, {"linear light", 0, 1}, {}};
        for (const double a : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            const auto row = row_of_ball(Lobe::sloan(static_cast<float>(a)), {{1, 0, 0}}, mode, kPixels);
            Series series{text_of("a = %g", a), {}};
            for (std::size_t i = 1; i < row.size(); ++i) series.points.emplace_back(2.0 * static_cast<double>(i) / kPixels - 1, row[i]);
            plot.series.push_back(std::move(series));
        }
        plots.push_back(std::move(plot));
    }
    return plots;
}

// The edge where the first of several lights ends, on a ball 10 degrees wide in the visual field. All lights are equally strong and sum
// to 1. The contrast is how far the first light is from its mean a step to either side, relative to all light and the flare.
constexpr double kStep = 0.05;   ///< a quarter of a degree, in radii: half a period at 2 cycles a degree, where the eye is most sensitive
constexpr double kFlare = 0.01;  ///< light of the room on the screen, of white: IEC 61966-2-1

/// The first light comes from the right, the others from everywhere on the viewer's side.
std::vector<Vec3f> directions(int lights) {
    const double golden_angle = pi * (3 - std::sqrt(5.0));
    std::vector<Vec3f> to_lights{{1, 0, 0}};
    for (int i = 0; i + 1 < lights; ++i) {
        const double z = 1 - (i + 0.5) / (lights - 1), side = std::sqrt(1 - z * z), turn = pi + golden_angle * i;
        to_lights.push_back({static_cast<float>(side * std::cos(turn)), static_cast<float>(side * std::sin(turn)), static_cast<float>(z)});
    }
    return to_lights;
}

/// The largest contrast within a step of the edge x = -w; first(x) and all(x) are the light of the first and of all lights.
template <class First, class All>
double contrast(const Lobe& lobe, const First& first, const All& all) {
    double largest = 0;
    for (int i = -10; i <= 10; ++i) {
        const double x = -static_cast<double>(lobe.wrap) + kStep * i / 10;
        if (x - kStep < -1 - 1e-9) continue;
        const double mean = (first(x - kStep) + first(x + kStep)) / 2;
        largest = std::max(largest, std::fabs(mean - first(x)) / (all(x) + kFlare));
    }
    return largest;
}

double computed_contrast(const Lobe& lobe, int lights) {
    const auto all = [&](double x) {
        double sum = 0;
        for (const Vec3f to : directions(lights))
            sum += value(lobe, x * static_cast<double>(to.x) + std::sqrt(std::max(0.0, 1 - x * x)) * static_cast<double>(to.z));
        return sum / lights;
    };
    return contrast(
        lobe, [&](double x) { return value(lobe, x) / lights; }, all);
}

double drawn_contrast(const Lobe& lobe, int lights) {
    constexpr int kPixels = 400;
    const auto all = row_of_ball(lobe, directions(lights), ShadowMode::off, kPixels);
    const auto first = row_of_ball(lobe, directions(1), ShadowMode::off, kPixels);
    const auto at = [](double x) { return static_cast<std::size_t>(std::lround((x + 1) * kPixels / 2)); };
    return contrast(
        lobe, [&](double x) { return first[at(x)] / lights; }, [&](double x) { return all[at(x)]; });
}

std::vector<Plot> edge() {
    Plot plot{"Contrast of the first light's edge", {"lights", 0, 16, 4}, {"contrast, %", 0.01, 1000, 1, true}, {}, true};
    const std::pair<const char*, Lobe> rows[] = {
        {"Lambert", Lobe::lambert()}, {"Sloan, a = 0.5", Lobe::sloan(0.5f)}, {"Valve", Lobe::valve()}};
    for (const auto& [name, lobe] : rows) {
        Series series{name, {}};
        for (int n = 1; n <= 16; ++n) series.points.emplace_back(n, 100 * computed_contrast(lobe, n));
        plot.series.push_back(std::move(series));
    }
    plot.series.push_back({"1 %, visible", {{0, 1}, {16, 1}}, false, 4});
    for (int color = 0; color < 2; ++color) {  // Valve's edge is the outline, where no pixel is full
        Series dots{{}, {}, true, color};
        for (const int n : {1, 2, 4, 8, 16}) dots.points.emplace_back(n, 100 * drawn_contrast(rows[color].second, n));
        plot.series.push_back(std::move(dots));
    }
    return {plot};
}

}  // namespace

int main(int argc, char** argv) {
    const std::string folder = argc > 1 ? argv[1] : ".";
    const bool written = write_plots(folder + "/figure_lobes.svg", "The lobes over the angle between normal and light", lobes()) &&
                         write_plots(folder + "/figure_shadows.svg", "Light across a ball with each kind of shadow", shadows()) &&
                         write_plots(folder + "/figure_edge.svg", "Contrast of the terminator's edge over the number of lights", edge());
    if (!written) std::fprintf(stderr, "cannot write into %s\n", folder.c_str());
    return written ? 0 : 1;
}
