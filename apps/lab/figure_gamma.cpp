// Half-Lambert computed with sRGB codes as if they were light, as games did before linear shading, beside half-Lambert in linear light.
#include "apps/lab/figure_entries.hpp"
#include "apps/lab/figure_studio.hpp"
#include "halflit/auto_setup.hpp"
#include "halflit/gltf.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace halflit::cli {
namespace {

constexpr double kClay = 0.5;  ///< albedo of the sphere and of the plot, linear

double encoded(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(std::min(linear, 1.0), 1 / 2.4) - 0.055; }
float encoded(float linear) { return static_cast<float>(encoded(static_cast<double>(linear))); }

/// The scene with each colour replaced by its sRGB value, so that sums of light are sums of codes.
Result<Scene> with_encoded_colors(Scene scene) {
    for (Material& material : scene.materials) {
        Vec4f& color = material.base_color;
        color = {encoded(color.x), encoded(color.y), encoded(color.z), color.w};
    }
    for (Mesh& mesh : scene.meshes)
        for (Vec4f& color : mesh.colors) color = {encoded(color.x), encoded(color.y), encoded(color.z), color.w};
    std::vector<bool> done(scene.textures.size());
    for (const Material& material : scene.materials) {
        if (!material.textures[TextureSlot::base_color].used()) continue;
        const auto index = static_cast<std::size_t>(material.textures[TextureSlot::base_color].texture);
        if (done[index]) continue;
        done[index] = true;
        Texture& texture = scene.textures[index];
        const std::size_t values = std::size_t{4} * static_cast<std::size_t>(texture.width()) * static_cast<std::size_t>(texture.height());
        std::vector<std::uint16_t> codes(texture.data().begin(), texture.data().begin() + static_cast<std::ptrdiff_t>(values));
        for (std::size_t i = 0; i < values; ++i)
            if (i % 4 != 3) codes[i] = static_cast<std::uint16_t>(std::lround(65535 * encoded(codes[i] / 65535.0)));
        auto made = Texture::from_rgba16(codes, texture.width(), texture.height());
        if (!made) return tl::unexpected(made.error());
        texture = std::move(*made);
    }
    return scene;
}

/// The picture with its linear values shown as codes.
Result<Image> take_as_codes(Shot shot) {
    auto scene = with_encoded_colors(std::move(shot.scene));
    if (!scene) return tl::unexpected(scene.error());
    shot.scene = std::move(*scene);
    auto picture = take(shot);
    if (!picture) return tl::unexpected(picture.error());
    for (std::size_t i = 0; i < picture->rgba8.size(); ++i)
        picture->rgba8[i] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(picture->rgba_linear[i], 0.0f, 1.0f)));
    return picture;
}

/// Suzanne, a textured head, if the folder that HALFLIT_ASSETS names has it; else the built-in scene.
Result<Shot> model_shot(std::string& name) {
    Shot shot = empty_shot();
    name = "the built-in scene";
    if (const char* folder = std::getenv("HALFLIT_ASSETS"); folder != nullptr) {
        if (auto loaded = load_gltf(std::string(folder) + "/models/Suzanne/Suzanne.gltf")) {
            shot.scene = std::move(loaded->scene);
            name = "the sample model Suzanne";
        }
    }
    if (shot.scene.meshes.empty()) shot.scene = demo_scene();
    shot.width = 480, shot.height = 400;
    shot.camera = auto_setup(shot.scene, shot.width, shot.height).camera;
    for (Material& material : shot.scene.materials) material.metallic = 0, material.emissive = {0, 0, 0};
    return shot;
}

/// One row: in codes, linear, and the square in linear light.
Result<PictureGrid> row_of(const Shot& subject, double width) {
    PictureGrid grid{.columns = {"half-Lambert, in codes", "half-Lambert, linear", "its square, linear"}, .rows = {""}, .width = width};
    for (const Lobe& lobe : {Lobe::half_lambert(), Lobe::half_lambert(), Lobe::valve()}) {
        Shot shot = subject;
        shot.scene.lights = {light_from({-0.9f, 0.45f, 0.35f})};
        shot.settings.background_linear = {0, 0, 0, 1};
        for (Material& material : shot.scene.materials) material.lobe = lobe;
        auto picture = grid.pictures.empty() ? take_as_codes(std::move(shot)) : take(shot);
        if (!picture) return tl::unexpected(picture.error());
        grid.pictures.push_back(std::move(*picture));
    }
    return grid;
}

}  // namespace

Result<Figure> make_gamma_figure() {
    constexpr float kGrey = static_cast<float>(kClay);
    Shot sphere = shot_of(Subject::sphere, Lobe::half_lambert(), {kGrey, kGrey, kGrey});
    std::string name;
    const auto model = model_shot(name);
    if (!model) return tl::unexpected(model.error());
    auto spheres = row_of(sphere, 300), models = row_of(*model, 300);
    if (!spheres) return tl::unexpected(spheres.error());
    if (!models) return tl::unexpected(models.error());

    Plot plot{.title = "8-bit codes of the sphere",
              .x = {.label = "cos θ", .min = -1, .max = 1},
              .y = {.label = "code", .min = 0, .max = 200},
              .series = {},
              .marks = {},
              .legend = LegendPlace::top_left,
              .width = 620,
              .height = 330};
    plot.series = {{.name = "half-Lambert, in codes", .points = {}, .color = "#cc2222"},
                   {.name = "half-Lambert, linear", .points = {}, .color = "#2255cc"},
                   {.name = "its square, linear", .points = {}, .color = "#e08214", .dash = "5 3"}};
    double brighter = 0, apart = 0;
    for (int i = -100; i <= 100; ++i) {
        const double x = i / 100.0, half = (1 + x) / 2;
        const double codes[] = {255 * encoded(kClay) * half, 255 * encoded(kClay * half), 255 * encoded(kClay * half * half)};
        for (std::size_t k = 0; k < 3; ++k) plot.series[k].points.push_back({x, codes[k]});
        brighter = std::max(brighter, codes[1] - codes[0]);
        apart = std::max(apart, std::fabs(codes[2] - codes[0]));
    }
    return Figure{
        .caption = fmt::format(
            "One directional light of strength 1 from the left, on a grey sphere of albedo {:g} and on {}; no ambient light, no shadows, "
            "no "
            "highlights. Left: albedo and light are multiplied as sRGB codes, and the product is shown as it is, as games did before they "
            "computed in linear light. Middle: the same lobe (1 + cos θ)/2 in linear light, encoded at the end. On the sphere it is up to "
            "{:.0f} codes brighter, and the form looks flat. Right: the lobe's square in linear light. It is within {:.0f} codes of the "
            "left "
            "picture, because the sRGB curve is nearly a square: a material tuned by eye with half-Lambert in codes keeps its look with "
            "Valve's square in linear light.",
            kClay, name, brighter, apart),
        .parts = {std::move(*spheres), std::move(*models), PlotRow{plot}}};
}

}  // namespace halflit::cli
