// Pictures against many samples a pixel: floors under anisotropic filters, highlights on minified normal maps, edges of masks.
#include "halflit/renderer.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/isas.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

using namespace halflit;
using halflit::test::camera_at;
using halflit::test::camera_flat;

namespace {

std::vector<float> draw(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height,
                        const Execution& execution = {}) {
    std::vector<float> linear(static_cast<std::size_t>(4 * width * height));
    Target target{width, height, nullptr};
    target.linear = linear.data();
    REQUIRE(render(scene, camera, settings, target, execution));
    return linear;
}

/// The mean of side x side points a pixel, textures without smaller levels.
std::vector<float> many_samples(Scene scene, const Camera& camera, const Settings& settings, int width, int height, int side) {
    for (Material& material : scene.materials)
        for (TextureUse* use : {&material.textures[TextureSlot::base_color], &material.textures[TextureSlot::normal]})
            use->sampler.mip = MipFilter::none;
    Settings one = settings;
    one.samples = 1;
    one.shading.anisotropy = 1;
    const std::vector<float> large = draw(scene, camera, one, width * side, height * side);
    std::vector<float> mean(static_cast<std::size_t>(4 * width * height));
    for (int y = 0; y < height * side; ++y)
        for (int x = 0; x < width * side; ++x)
            for (int c = 0; c < 4; ++c)
                mean[static_cast<std::size_t>(4 * (y / side * width + x / side) + c)] +=
                    large[static_cast<std::size_t>(4 * (y * width * side + x) + c)] / static_cast<float>(side * side);
    return mean;
}

double code(float linear) {
    const double v = std::clamp(static_cast<double>(linear), 0.0, 1.0);
    return 255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}
double rms_codes(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (i % 4 != 3) sum += (code(a[i]) - code(b[i])) * (code(a[i]) - code(b[i]));
    return std::sqrt(sum / (0.75 * static_cast<double>(a.size())));
}
double rms_alpha(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 3; i < a.size(); i += 4) sum += static_cast<double>(a[i] - b[i]) * static_cast<double>(a[i] - b[i]);
    return std::sqrt(sum / (0.25 * static_cast<double>(a.size())));
}

/// A rectangle in the plane y = 0 or, if upright, z = 0, with `repeats` copies of a texture.
Mesh rectangle(float half, float repeats, bool upright) {
    Mesh m;
    for (int i = 0; i < 4; ++i) {
        const float x = i == 1 || i == 2 ? half : -half, y = i >= 2 ? half : -half;
        m.positions.push_back(upright ? Vec3f{x, y, 0} : Vec3f{x, 0, -y});
        m.normals.push_back(upright ? Vec3f{0, 0, 1} : Vec3f{0, 1, 0});
        m.tangents.push_back({1, 0, 0, 1});
        m.uv0.push_back({0.5f * (x / half + 1) * repeats, 0.5f * (1 - y / half) * repeats});
    }
    m.indices = {0, 1, 2, 0, 2, 3};
    m.material = 0;
    return m;
}
Scene scene_of(Mesh mesh, const Material& material, std::vector<Texture> textures) {
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.materials.push_back(material);
    scene.textures = std::move(textures);
    scene.instances.push_back({0, {}});
    return scene;
}

Scene checker_floor() {
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) rgba.insert(rgba.end(), 4, static_cast<std::uint8_t>((x / 16 + y / 16) % 2 == 0 ? 230 : 20));
    Material material;
    material.unlit = true;
    material.textures[TextureSlot::base_color].texture = 0;
    return scene_of(rectangle(100, 100, false), material, {Texture::from_rgba8(rgba, 128, 128, ColorSpace::srgb).value()});
}
const Camera kGrazing = camera_at({0, 1, 0}, {0, 0.88f, -1}, 0.7f, 0.01f);

Scene leaf(int side) {
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double dx = (x + 0.5) / side - 0.5, dy = (y + 0.5) / side - 0.5;
            const double inside = 0.5 + (0.35 + 0.08 * std::sin(5 * std::atan2(dy, dx)) - std::sqrt(dx * dx + dy * dy)) * side * 0.25;
            rgba.insert(rgba.end(), 3, 200);
            rgba.push_back(static_cast<std::uint8_t>(255 * std::clamp(inside, 0.0, 1.0)));
        }
    Material material;
    material.unlit = true;
    material.alpha_mode = AlphaMode::mask;
    material.textures[TextureSlot::base_color].texture = 0;
    return scene_of(rectangle(0.9f, 1, true), material, {Texture::from_rgba8(rgba, side, side, ColorSpace::srgb, MipRule::alpha).value()});
}

}  // namespace

TEST_CASE("anisotropy: a floor of checks has 10 dB more of 256 samples a pixel than by squares", "[raster][texture]") {
    const Scene scene = checker_floor();
    Settings settings;
    settings.samples = 4;
    const std::vector<float> want = many_samples(scene, kGrazing, settings, 160, 90, 16);
    double last = 1e9;
    std::vector<double> errors;
    for (const int anisotropy : {1, 2, 4, 8, 16}) {
        settings.shading.anisotropy = anisotropy;
        errors.push_back(rms_codes(draw(scene, kGrazing, settings, 160, 90), want));
        INFO("anisotropy " << anisotropy << ": off by " << errors.back() << " codes");
        CHECK(errors.back() < last);
        last = errors.back();
    }
    CHECK(20 * std::log10(errors.front() / errors.back()) > 10);
}

TEST_CASE("normal maps: minified bumps keep their gloss about half as far off as smoothed ones", "[raster][texture]") {
    std::vector<std::uint8_t> map;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            double dx = 0, dy = 0;
            for (int k = 1; k <= 12; ++k) {
                const int a = k * 7 % 23 + 3, b = k * 11 % 29 - 14;
                const double slope = 0.1 * std::cos(6.283185307179586 * (a * x + b * y) / 128 + k * k) / std::sqrt(a * a + b * b);
                dx += a * slope, dy += b * slope;
            }
            const double length = std::sqrt(1 + dx * dx + dy * dy);
            for (const double c : {-dx, -dy, 1.0}) map.push_back(static_cast<std::uint8_t>(127.5 * (c / length + 1) + 0.5));
            map.push_back(255);
        }
    Material material;
    material.roughness = 0.35f;
    material.textures[TextureSlot::normal].texture = 0;
    const auto scene_by = [&](MipRule rule) {
        Scene scene = scene_of(rectangle(1, 4, true), material, {Texture::from_rgba8(map, 128, 128, ColorSpace::linear, rule).value()});
        scene.lights.resize(1);
        scene.lights[0].type = LightType::point;
        scene.lights[0].position_ws = {0.3f, 0.4f, 1.2f};
        scene.lights[0].color_linear = {0.4f, 0.4f, 0.4f};
        return scene;
    };
    const Camera camera = camera_at({0, 0, 2}, {0, 0, 0}, 0.9f);
    Settings settings;
    settings.shadows = ShadowMode::off;
    const std::vector<float> want = many_samples(scene_by(MipRule::equal), camera, settings, 64, 64, 12);
    const double smoothed = rms_codes(draw(scene_by(MipRule::equal), camera, settings, 64, 64), want);
    const double rough = rms_codes(draw(scene_by(MipRule::normal), camera, settings, 64, 64), want);
    INFO("off by " << smoothed << " codes smoothed, " << rough << " with the lost length");
    CHECK(rough < 0.65 * smoothed);

    // Where the map is magnified, what the levels lost does not count: codes are those of the plain map, but for the way in which the
    // highlight's power is computed.
    const Camera close = camera_at({0.1f, 0.1f, 0.1f}, {0.1f, 0.1f, 0}, 0.9f, 0.01f);
    const double apart =
        rms_codes(draw(scene_by(MipRule::equal), close, settings, 256, 256), draw(scene_by(MipRule::normal), close, settings, 256, 256));
    CHECK(apart < 0.05);
}

TEST_CASE("masks: with several samples their edge is as near the area as a triangle's, with one it is as it was", "[raster][texture]") {
    for (const int side : {24, 256}) {
        const Scene scene = leaf(side);
        const Camera camera = camera_flat();
        Settings settings;
        const std::vector<float> want = many_samples(scene, camera, settings, 96, 96, 16);
        double last = 0;
        for (const int samples : {1, 4, 8, 16}) {
            settings.samples = samples;
            const double error = rms_alpha(draw(scene, camera, settings, 96, 96), want);
            INFO(side << " texels, " << samples << " samples: off by " << error);
            if (samples == 4) CHECK(error < 0.5 * last);
            if (samples > 4) CHECK(error < last);
            last = error;
        }
    }
}

TEST_CASE("masks, anisotropy: the same bits for every instruction set, tile size and thread count", "[raster][determinism][texture]") {
    for (const bool mask : {true, false})
        for (const int samples : {1, 4, 16}) {
            const Scene scene = mask ? leaf(48) : checker_floor();
            const Camera camera = mask ? camera_at({0.5f, 0.2f, 1.5f}, {0, 0, 0}) : kGrazing;
            Settings settings;
            settings.samples = samples;
            settings.shading.anisotropy = 7;
            const std::vector<float> first = draw(scene, camera, settings, 90, 70, {.threads = 1, .isa = Isa::scalar});
            for (const Isa isa : halflit::test::available_isas())
                for (const int tile : {16, 64}) {
                    const std::vector<float> other = draw(scene, camera, settings, 90, 70, {.threads = 2, .tile_size = tile, .isa = isa});
                    CHECK(std::memcmp(first.data(), other.data(), first.size() * sizeof(float)) == 0);
                }
        }
}
