// Transparent layers in depth order, against float64 references that sort the layers of each sample.
#include "halflit/renderer.hpp"
#include "tests/raster/kernel_fixture.hpp"
#include "tests/raster/visibility_reference.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;
using halflit::test::camera_at;
using halflit::test::camera_flat;

namespace {

std::vector<float> draw(const Scene& scene, const Camera& camera, int width, int height, int samples) {
    Settings settings;
    settings.samples = samples;
    std::vector<float> linear(static_cast<std::size_t>(4 * width * height));
    std::vector<std::uint8_t> codes(linear.size());
    const auto report = render(scene, camera, settings, {width, height, codes.data(), linear.data()});
    REQUIRE(report);
    return linear;
}

/// A transparent parallelogram about `centre`, of its own material.
void add_pane(Scene& scene, Vec3f centre, Vec3f u, Vec3f v, Vec4f color) {
    Material material;
    material.unlit = true;
    material.double_sided = true;
    material.alpha_mode = AlphaMode::blend;
    material.base_color = color;
    Mesh mesh;
    mesh.positions = {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material);
    scene.meshes.push_back(mesh);
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, {}});
}

Vec3f random_vector(Random& random, double size, double depth) {
    const float x = random.real32(-size, size), y = random.real32(-size, size);
    return {x, y, random.real32(-depth, depth)};
}

Scene crossing_panes(Random& random, int count, double size) {
    Scene scene;
    for (int i = 0; i < count; ++i) {
        const Vec3f centre = random_vector(random, 0.8, 0.8), u = random_vector(random, size, 0.3), v = random_vector(random, size, 0.3);
        const float r = random.real32(0, 1), g = random.real32(0, 1), b = random.real32(0, 1);
        add_pane(scene, centre, u, v, {r, g, b, random.real32(0.1, 0.9)});
    }
    return scene;
}

/// Linear light times alpha, and alpha.
using Blended = std::array<double, 4>;

void blend(Blended& under, const Vec4f& over) {
    const double a = static_cast<double>(over.w), keep = 1 - a;
    const double color[3] = {static_cast<double>(over.x), static_cast<double>(over.y), static_cast<double>(over.z)};
    for (std::size_t i = 0; i < 3; ++i) under[i] = a * color[i] + keep * under[i];
    under[3] = a + keep * under[3];
}

double srgb_code(double v) {
    v = std::clamp(v, 0.0, 1.0);
    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

/// A pane, two triangles, at a sample.
struct Layer {
    double z, tolerance;
    Vec4f color;
};

/// Layers of a sample by the reference; false where an edge or two depths are too near to tell.
bool layers_at(const std::vector<ReferenceTriangle>& triangles, const Scene& scene, double x, double y, std::vector<Layer>& layers) {
    layers.clear();
    for (std::size_t pane = 0; 2 * pane < triangles.size(); ++pane) {
        double inside = -1e9;
        Layer layer{};
        for (std::size_t half = 0; half < 2; ++half) {
            const ReferenceTriangle& t = triangles[2 * pane + half];
            if (!t.drawn) continue;
            const auto p = t.shape.at(x, y);
            // The edge between the two halves is none of the pane's.
            const double in = half == 0 ? std::min(p.edge_px[2], p.edge_px[0]) : std::min(p.edge_px[0], p.edge_px[1]);
            const double across = half == 0 ? p.edge_px[1] : p.edge_px[2];
            if (across < 0) continue;
            inside = std::min({in, p.near_px, p.far_px});
            layer = {p.depth, t.depth_rounding + (std::abs(t.shape.depth_dx()) + std::abs(t.shape.depth_dy())) * 2 * kEdgeTolerancePx,
                     scene.materials[pane].base_color};
        }
        if (std::abs(inside) < 2 * kEdgeTolerancePx) return false;
        if (inside > 0) layers.push_back(layer);
    }
    std::sort(layers.begin(), layers.end(), [](const Layer& a, const Layer& b) { return a.z < b.z; });
    for (std::size_t i = 1; i < layers.size(); ++i)
        if (layers[i].z - layers[i - 1].z < layers[i].tolerance + layers[i - 1].tolerance) return false;
    return true;
}

}  // namespace

TEST_CASE("blend: a hundred panes that cross each other, against a sort of each sample's layers", "[raster][blend]") {
    constexpr int kSide = 160;
    Random random(77);
    int compared = 0, deep = 0;
    double worst = 0;
    for (const int samples : {1, 4, 8, 16}) {
        const Scene scene = crossing_panes(random, 100, 0.9);
        const Camera camera = camera_at({0.3f, 0.4f, 3.0f}, {0, 0, 0}, 0.6f, 0.01f);
        const std::vector<float> picture = draw(scene, camera, kSide, kSide, samples);
        const auto triangles = reference_triangles(scene, camera, kSide, kSide);
        const SamplePattern pattern = standard_samples(samples);
        std::vector<Layer> layers;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                Blended sum{};
                bool known = true;
                for (int s = 0; s < samples && known; ++s) {
                    known = layers_at(triangles, scene, x + 0.5 + pattern.x[s] / 256.0, y + 0.5 + pattern.y[s] / 256.0, layers);
                    Blended light{};
                    for (const Layer& layer : layers) blend(light, layer.color);
                    for (std::size_t i = 0; i < 4; ++i) sum[i] += light[i] / samples;
                }
                if (!known) continue;
                ++compared;
                deep += layers.size() > 8;
                const float* pixel = &picture[static_cast<std::size_t>(4 * (y * kSide + x))];
                for (std::size_t i = 0; i < 3; ++i)
                    if (sum[3] > 0)
                        worst = std::max(worst, std::abs(srgb_code(static_cast<double>(pixel[i])) - srgb_code(sum[i] / sum[3])));
                worst = std::max(worst, 255 * std::abs(static_cast<double>(pixel[3]) - sum[3]));
            }
    }
    CHECK(worst < 0.01);  // 2e-4 codes by rounding
    CHECK(compared > kSide * kSide);
    CHECK(deep > 1000);
}

TEST_CASE("blend: the order of submission of layers at different depths does not show", "[raster][blend]") {
    Random random(3);
    Scene scene = crossing_panes(random, 40, 1.0);
    const Camera camera = camera_at({0.3f, 0.4f, 3.0f}, {0, 0, 0}, 0.9f, 0.01f);
    const std::vector<float> first = draw(scene, camera, 150, 100, 4);
    for (int round = 0; round < 3; ++round) {
        for (std::size_t i = scene.instances.size() - 1; i > 0; --i)
            std::swap(scene.instances[i], scene.instances[static_cast<std::size_t>(random.index(static_cast<int>(i) + 1))]);
        CHECK(draw(scene, camera, 150, 100, 4) == first);
    }
}

TEST_CASE("blend: of layers at one depth the one submitted last is in front", "[raster][blend]") {
    for (const bool swap : {false, true}) {
        Scene scene;
        add_pane(scene, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, swap ? Vec4f{0, 1, 0, 0.5f} : Vec4f{1, 0, 0, 0.5f});
        add_pane(scene, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, swap ? Vec4f{1, 0, 0, 0.5f} : Vec4f{0, 1, 0, 0.5f});
        const std::vector<float> picture = draw(scene, camera_flat(), 8, 8, 4);
        CHECK(picture[swap ? 0 : 1] == Approx(2.0 / 3));
        CHECK(picture[swap ? 1 : 0] == Approx(1.0 / 3));
    }
}

TEST_CASE("blend: a thousand layers over a whole tile, in any order", "[raster][blend]") {
    Random random(5);
    std::vector<int> order(1000);
    for (int i = 0; i < 1000; ++i) order[static_cast<std::size_t>(i)] = i;
    for (std::size_t i = order.size() - 1; i > 0; --i)
        std::swap(order[i], order[static_cast<std::size_t>(random.index(static_cast<int>(i) + 1))]);
    const auto color = [](int i) {
        const float t = static_cast<float>(i) / 1000;
        return Vec4f{t, 1 - t, 0.5f, 0.002f + 0.004f * t};
    };
    Scene scene;
    for (const int i : order) add_pane(scene, {0, 0, -5.0f + static_cast<float>(i) * 0.01f}, {2, 0, 0}, {0, 2, 0}, color(i));
    Blended want{};
    for (int i = 0; i < 1000; ++i) blend(want, color(i));
    const std::vector<float> picture = draw(scene, camera_flat(), 64, 64, 8);
    double worst = 0;
    for (std::size_t p = 0; p < picture.size(); p += 4) {
        for (std::size_t i = 0; i < 3; ++i) worst = std::max(worst, std::abs(static_cast<double>(picture[p + i]) - want[i] / want[3]));
        worst = std::max(worst, std::abs(static_cast<double>(picture[p + 3]) - want[3]));
    }
    CHECK(worst < 2e-5);  // a thousand roundings
}

TEST_CASE("blend: more layers at a pixel than its memory holds", "[raster][blend]") {
    // One mesh of small panes with vertex colours, each over the whole of a picture of 2 x 2 pixels, shuffled in depth.
    constexpr int kLayers = 150'000;
    Random random(6);
    std::vector<int> order(kLayers);
    for (int i = 0; i < kLayers; ++i) order[static_cast<std::size_t>(i)] = i;
    for (std::size_t i = order.size() - 1; i > 0; --i)
        std::swap(order[i], order[static_cast<std::size_t>(random.index(static_cast<int>(i) + 1))]);
    const auto color = [](int i) {
        const float t = static_cast<float>(i) / kLayers;
        return Vec4f{t, 1 - t, i % 2 == 0 ? 1.0f : 0.0f, 1e-5f + 2e-5f * t};
    };
    const auto depth = [](int i) { return -8.0f + static_cast<float>(i) * 1e-4f; };
    Scene scene;
    add_pane(scene, {}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1, 1});
    Mesh& mesh = scene.meshes[0];
    mesh = {};
    for (const int i : order) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec3f corner : {Vec3f{-4, -4, depth(i)}, Vec3f{12, -4, depth(i)}, Vec3f{-4, 12, depth(i)}}) {
            mesh.positions.push_back(corner);
            mesh.normals.push_back({0, 0, 1});
            mesh.colors.push_back(color(i));
        }
        for (std::uint32_t k = 0; k < 3; ++k) mesh.indices.push_back(first + k);
    }
    mesh.material = 0;
    Blended want{};
    for (int i = 0; i < kLayers; ++i) blend(want, color(i));
    for (const int samples : {1, 4}) {
        const std::vector<float> picture = draw(scene, camera_flat(), 2, 2, samples);
        double worst = 0;
        for (std::size_t p = 0; p < picture.size(); p += 4)
            for (std::size_t i = 0; i < 3; ++i) worst = std::max(worst, std::abs(static_cast<double>(picture[p + i]) - want[i] / want[3]));
        CHECK(worst < 1e-3);  // 150,000 roundings of alphas near 1e-5
    }
}
