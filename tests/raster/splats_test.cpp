// Splats against a renderer in double that was written from the papers alone, without cuts; bits; and splats among surfaces.
#include "halflit/explain.hpp"
#include "halflit/renderer.hpp"
#include "halflit/section.hpp"
#include "halflit/shapes.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

using namespace halflit;
using halflit::test::Random;

namespace {

constexpr int kWidth = 64, kHeight = 48;

Scene random_splats(std::uint64_t seed, SplatReference reference, int count = 150) {
    Random random(seed);
    Scene scene;
    Mesh mesh;
    mesh.topology = Topology::points;
    Splats s;
    s.reference = reference;
    s.degree = static_cast<int>(seed % 4);
    for (int i = 0; i < count; ++i) {
        mesh.positions.push_back({random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)});
        mesh.indices.push_back(static_cast<std::uint32_t>(i));
        const auto size = [&] { return static_cast<float>(std::exp(random.real(-4, -1))); };
        s.scales.push_back({size(), size(), seed % 3 == 0 ? 1e-4f : size()});
        s.rotations.push_back({random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)});
        s.opacities.push_back(random.real32(0.01, 1));
        for (int k = 0; k < 3 * (s.degree + 1) * (s.degree + 1); ++k) s.harmonics.push_back(random.real32(-0.6, 0.6));
    }
    mesh.splats = std::make_shared<const Splats>(std::move(s));
    scene.meshes = {mesh};
    scene.instances = {{0, {}}};
    return scene;
}

/// [Kerbl23], KHR_gaussian_splatting and Mip-Splatting, pixel by pixel: codes / 255 of the picture over black.
std::vector<double> truth_of(const Scene& scene, const Camera& camera) {
    const Mesh& mesh = scene.meshes[0];
    const Splats& s = *mesh.splats;
    const Mat4& m = camera.world_from_camera;
    const double focal = 0.5 * kHeight / std::tan(0.5 * static_cast<double>(camera.fov_y_rad));
    struct One {
        double distance, x, y, a, b, c, opacity, color[3];
    };
    std::vector<One> all;
    for (std::size_t i = 0; i < s.opacities.size(); ++i) {
        const Vec3f p = mesh.positions[i];
        const double way[3] = {double{p.x} - m.c[3].x, double{p.y} - m.c[3].y, double{p.z} - m.c[3].z};
        const Vec4f axes[3] = {m.c[0], m.c[1], m.c[2]};
        double view[3][3], t[3];  // right, down, ahead
        for (int r = 0; r < 3; ++r) {
            const double sign = r == 0 ? 1 : -1;
            view[r][0] = sign * double{axes[r].x}, view[r][1] = sign * double{axes[r].y}, view[r][2] = sign * double{axes[r].z};
            t[r] = view[r][0] * way[0] + view[r][1] * way[1] + view[r][2] * way[2];
        }
        if (!(t[2] >= 0.2)) continue;
        const double edge_x = 1.3 * 0.5 * kWidth / focal, edge_y = 1.3 * 0.5 * kHeight / focal;
        const double hx = std::clamp(t[0] / t[2], -edge_x, edge_x), hy = std::clamp(t[1] / t[2], -edge_y, edge_y);
        const double jacobian[2][3] = {{focal / t[2], 0, -focal * hx / t[2]}, {0, focal / t[2], -focal * hy / t[2]}};
        const Vec4f q = s.rotations[i];
        double w = q.w, x = q.x, y = q.y, z = q.z;
        const double length = std::sqrt(w * w + x * x + y * y + z * z);
        w /= length, x /= length, y /= length, z /= length;
        const double turn[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                                   {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                                   {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
        const double size[3] = {s.scales[i].x, s.scales[i].y, s.scales[i].z};
        double rows[2][3] = {};
        for (int r = 0; r < 2; ++r)
            for (int axis = 0; axis < 3; ++axis)
                for (int k = 0; k < 3; ++k)
                    for (int l = 0; l < 3; ++l) rows[r][axis] += jacobian[r][k] * view[k][l] * turn[l][axis] * size[axis];
        double c00 = 0, c01 = 0, c11 = 0, before = 0;
        for (int k = 0; k < 3; ++k) {
            c00 += rows[0][k] * rows[0][k], c01 += rows[0][k] * rows[1][k], c11 += rows[1][k] * rows[1][k];
            const int l = (k + 1) % 3;
            const double minor = rows[0][k] * rows[1][l] - rows[0][l] * rows[1][k];
            before += minor * minor;
        }
        const double grown = s.reference == SplatReference::khr ? 0.0 : s.reference == SplatReference::mip ? 0.1 : 0.3;
        const double det = before + grown * (c00 + c11) + grown * grown;
        if (!(det > 0)) continue;
        One one{};
        one.opacity = static_cast<double>(s.opacities[i]);
        if (s.reference == SplatReference::mip) one.opacity *= std::sqrt(before / det);
        if (s.reference == SplatReference::inria_aa) one.opacity *= std::sqrt(std::max(2.5e-5, before / det));
        one.a = (c11 + grown) / det, one.b = -c01 / det, one.c = (c00 + grown) / det;
        one.x = 0.5 * kWidth + focal * t[0] / t[2], one.y = 0.5 * kHeight + focal * t[1] / t[2];
        const double far = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
        one.distance = s.reference == SplatReference::khr ? far : t[2];
        x = way[0] / far, y = way[1] / far, z = way[2] / far;
        const double basis[16] = {0.28209479177387814,
                                  -0.4886025119029199 * y,
                                  0.4886025119029199 * z,
                                  -0.4886025119029199 * x,
                                  1.0925484305920792 * x * y,
                                  -1.0925484305920792 * y * z,
                                  0.31539156525252005 * (2 * z * z - x * x - y * y),
                                  -1.0925484305920792 * x * z,
                                  0.5462742152960396 * (x * x - y * y),
                                  -0.5900435899266435 * y * (3 * x * x - y * y),
                                  2.890611442640554 * x * y * z,
                                  -0.4570457994644658 * y * (4 * z * z - x * x - y * y),
                                  0.3731763325901154 * z * (2 * z * z - 3 * x * x - 3 * y * y),
                                  -0.4570457994644658 * x * (4 * z * z - x * x - y * y),
                                  1.445305721320277 * z * (x * x - y * y),
                                  -0.5900435899266435 * x * (x * x - 3 * y * y)};
        const auto count = static_cast<std::size_t>((s.degree + 1) * (s.degree + 1));
        for (std::size_t c = 0; c < 3; ++c) {
            double sum = 0.5;
            for (std::size_t k = 0; k < count; ++k) sum += basis[k] * static_cast<double>(s.harmonics[3 * (count * i + k) + c]);
            one.color[c] = std::max(sum, 0.0);
        }
        all.push_back(one);
    }
    std::stable_sort(all.begin(), all.end(), [](const One& a, const One& b) { return a.distance < b.distance; });
    std::vector<double> out;
    for (int row = 0; row < kHeight; ++row)
        for (int column = 0; column < kWidth; ++column) {
            double passed = 1, sum[3] = {};
            for (const One& one : all) {
                const double dx = column + 0.5 - one.x, dy = row + 0.5 - one.y;
                const double alpha = std::min(0.99, one.opacity * std::exp(-0.5 * (one.a * dx * dx + one.c * dy * dy) - one.b * dx * dy));
                for (int c = 0; c < 3; ++c) sum[c] += passed * alpha * one.color[c];
                passed *= 1 - alpha;
            }
            for (const double c : sum) out.push_back(std::min(c, 1.0));
        }
    return out;
}

Settings plain() {
    Settings settings;
    settings.background_linear = {0, 0, 0, 1};
    settings.shadow_size = 64;
    return settings;
}

std::vector<std::uint8_t> codes_of(const Scene& scene, const Camera& camera, const Settings& settings, const Execution& execution = {}) {
    std::vector<std::uint8_t> codes(4 * kWidth * kHeight);
    const auto report = render(scene, camera, settings, {.width = kWidth, .height = kHeight, .pixels = codes.data()}, execution);
    if (!report) FAIL(report.error().message);
    return codes;
}

double display(float linear) {
    const double v = std::clamp(static_cast<double>(linear), 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

}  // namespace

TEST_CASE("splats: pictures are those of a renderer in double without cuts", "[raster][splats]") {
    double worst = 0;
    std::size_t seen = 0;
    for (std::uint64_t seed = 0; seed < 16; ++seed) {
        const Scene scene = random_splats(seed, static_cast<SplatReference>(seed % 4));
        const Camera camera = halflit::test::camera_at({3.0f * std::sin(static_cast<float>(seed)), 0.8f, 3.0f}, {0, 0, 0});
        const std::vector<double> truth = truth_of(scene, camera);
        std::vector<float> linear(4 * kWidth * kHeight);
        REQUIRE(render(scene, camera, plain(), {.width = kWidth, .height = kHeight, .linear = linear.data()}));
        for (std::size_t i = 0; i < kWidth * kHeight; ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                worst = std::max(worst, 255 * std::fabs(display(linear[4 * i + c]) - truth[3 * i + c]));
                seen += truth[3 * i + c] > 0.1 ? 1 : 0;
            }
    }
    INFO("worst " << worst << " codes");
    CHECK(worst < 0.05);
    CHECK(seen > 10000);
}

TEST_CASE("splats: instruction sets, threads, tiles and regions do not show", "[raster][splats]") {
    Scene scene = random_splats(5, SplatReference::inria);
    scene.meshes.push_back(make_sphere(0.5f, 24, 16));
    scene.instances.push_back({1, {}});
    scene.lights.resize(1);
    const Camera camera = halflit::test::camera_at({2, 1, 3}, {0, 0, 0});
    Settings settings = plain();
    settings.samples = GENERATE(1, 4);
    const auto expected = codes_of(scene, camera, settings, {.threads = 1, .isa = Isa::scalar});
    for (const Isa isa : halflit::test::available_isas())
        for (const int tile : {16, 64})
            for (const int threads : {1, 3})
                CHECK(codes_of(scene, camera, settings, {.threads = threads, .tile_size = tile, .isa = isa}) == expected);
    settings.region = {13, 9, 30, 21};
    const auto part = codes_of(scene, camera, settings);
    for (int y = 9; y < 30; ++y)
        for (int x = 13; x < 43; ++x) {
            const auto at = static_cast<std::ptrdiff_t>(4 * (y * kWidth + x));
            if (!std::equal(part.begin() + at, part.begin() + at + 4, expected.begin() + at)) FAIL(x << ", " << y);
        }
}

TEST_CASE("splats: surfaces hide those behind them, and are seen through those before them", "[raster][splats]") {
    Scene scene;
    Mesh mesh;
    mesh.topology = Topology::points;
    mesh.positions = {{0, 0, GENERATE(-1.0f, 1.0f)}};
    mesh.indices = {0};
    Splats s;
    s.scales = {{5, 5, 0.1f}}, s.rotations = {{0, 0, 0, 1}}, s.opacities = {0.5f},
    s.harmonics = {1.7724539f, -1.7724539f, -1.7724539f};  // red
    mesh.splats = std::make_shared<const Splats>(s);
    const bool before = mesh.positions[0].z > 0;
    Material white;
    white.unlit = true;
    scene.materials = {white};
    Mesh wall = make_plane(8, 1);
    wall.material = 0;
    scene.meshes = {mesh, wall};
    scene.instances = {{0, {}}, {1, {{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {0, 0, 0, 1}}}}};
    scene.instances[1].world_from_object = {{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
    scene.materials[0].double_sided = true;
    const auto codes = codes_of(scene, halflit::test::camera_at({0, 0, 4}, {0, 0, 0}), plain());
    const std::uint8_t* const middle = codes.data() + 4 * (kHeight / 2 * kWidth + kWidth / 2);
    CHECK(int{middle[0]} == 255);
    CHECK(int{middle[1]} == (before ? 128 : 255));
    CHECK(int{middle[3]} == 255);
}

TEST_CASE("splats: planes and the story of a pixel tell what hides half, and what shows most", "[raster][splats]") {
    // A faint one before two that hide, and a wall behind all.
    Scene scene;
    Splats s;
    std::vector<Vec3f> places{{0, 0, 1}, {0, 0, 0.5f}, {0, 0, -0.5f}};
    for (const float opacity : {0.2f, 0.9f, 0.9f}) {
        s.rotations.push_back({0, 0, 0, 1}), s.scales.push_back({2, 2, 2}), s.opacities.push_back(opacity);
        s.harmonics.insert(s.harmonics.end(), 3, 0.0f);
    }
    scene.meshes = {make_plane(8, 1), make_splat_mesh(places, s)};
    scene.instances = {{0, {{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {0, 0, -2, 1}}}}, {1, {}}};
    scene.materials = {{}};
    scene.materials[0].double_sided = true;
    scene.meshes[0].material = 0;
    const Camera camera = halflit::test::camera_at({0, 0, 4}, {0, 0, 0});
    std::vector<float> depth(kWidth * kHeight), coverage(kWidth * kHeight);
    std::vector<std::uint32_t> instance(kWidth * kHeight), number(kWidth * kHeight);
    Target target{.width = kWidth, .height = kHeight};
    target.depth = depth.data(), target.instance = instance.data(), target.triangle = number.data(), target.coverage = coverage.data();
    REQUIRE(render(scene, camera, plain(), target));
    const std::size_t middle = kHeight / 2 * kWidth + kWidth / 2;
    CHECK(depth[middle] == Approx(3.5f));
    CHECK(instance[middle] == 2);
    CHECK(number[middle] == 2);
    CHECK(coverage[middle] == 1.0f);

    Renderer renderer;
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    const auto story = explain_pixel(renderer, *prepared, {}, camera, plain(), {kWidth, kHeight}, kWidth / 2, kHeight / 2);
    REQUIRE(story);
    CHECK(story->shows == PixelShows::splats);
    REQUIRE(story->splats.size() == 3);
    const double alphas[] = {0.2, 0.9, 0.9}, weights[] = {0.2, 0.72, 0.072};
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(story->splats[i].splat == i);
        CHECK(story->splats[i].alpha == Approx(alphas[i]).margin(1e-3));
        CHECK(story->splats[i].weight == Approx(weights[i]).margin(1e-3));
    }
    CHECK(story->splats_passed == Approx(0.008).margin(1e-3));
    CHECK(story->behind.size() == 1);
}

TEST_CASE("splats: a section keeps those whose middles are on its side", "[raster][splats]") {
    Scene scene = random_splats(5, SplatReference::inria, 100);
    std::size_t above = 0;
    for (const Vec3f p : scene.meshes[0].positions) above += p.x <= 0.25f ? 1 : 0;
    const CutPlane plane{{1, 0, 0}, 0.25};
    REQUIRE(cut_scene(scene, {&plane, 1}));
    const Mesh& left = scene.meshes[static_cast<std::size_t>(scene.instances[0].mesh)];
    REQUIRE(left.splats != nullptr);
    CHECK(left.splats->opacities.size() == above);
}

/// Splats of many kinds by the seed: needles and discs, faint and strong, colours far above 1, linear light, and a wall behind or among
/// them.
Scene varied_splats(std::uint64_t seed) {
    Scene scene = random_splats(seed, static_cast<SplatReference>(seed % 4), 20 << (seed % 6));
    Random random(seed + 1000);
    Splats s = *scene.meshes[0].splats;
    s.linear_light = seed % 5 == 1;
    const float color = seed % 7 == 2 ? 20.0f : 1.0f;
    for (float& c : s.harmonics) c *= color;
    for (std::size_t i = 0; i < s.scales.size(); ++i) {
        if (seed % 3 == 1) s.scales[i].y *= 8.0f, s.scales[i].z *= 0.05f;
        if (seed % 4 == 3) s.opacities[i] *= 0.05f;
    }
    scene.meshes[0].splats = std::make_shared<const Splats>(std::move(s));
    if (seed % 3 == 2) {
        scene.materials = {{}};
        scene.materials[0].double_sided = scene.materials[0].unlit = true;
        scene.meshes.push_back(make_plane(1, 1));
        scene.meshes[1].material = 0;
        scene.instances.push_back({1, {{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {random.real32(-1, 1), 0, 0, 1}}}});
    }
    return scene;
}

/// Codes before rounding.
std::vector<double> fine_codes(const Scene& scene, const Camera& camera, const Settings& settings, double* bound = nullptr) {
    const Region part = settings.region.width > 0 ? settings.region : Region{0, 0, kWidth, kHeight};
    std::vector<float> light(4 * static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height));
    Target target{.width = kWidth, .height = kHeight, .linear = light.data()};
    target.region_alone = true;
    const auto report = render(scene, camera, settings, target);
    if (!report) FAIL(report.error().message);
    if (bound != nullptr) *bound = report->error.codes;
    std::vector<double> out;
    for (std::size_t k = 0; k < light.size(); ++k)
        if (k % 4 != 3) out.push_back(255.0 * display(light[k]));
    return out;
}

Camera varied_camera(std::uint64_t seed) {
    Random random(seed);
    return halflit::test::camera_at({random.real32(-3, 3), random.real32(-3, 3), random.real32(1, 4)}, {0, 0, 0});
}

TEST_CASE("splats: a budget holds, and is told", "[raster][splats][budget]") {
    std::vector<double> ratios;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const Scene scene = varied_splats(seed);
        Settings settings = plain();
        const Camera camera = varied_camera(seed);
        const std::vector<double> exact = fine_codes(scene, camera, settings);
        const double budget = std::exp2(Random(seed).real(-2, 3));
        settings.shading.max_error_codes = budget;
        double bound = 0.0, worst = 0.0;
        const std::vector<double> fast = fine_codes(scene, camera, settings, &bound);
        CHECK(bound <= budget);
        for (std::size_t k = 0; k < exact.size(); ++k) worst = std::max(worst, std::abs(exact[k] - fast[k]));
        INFO(seed << ": " << worst << " of " << bound);
        CHECK(worst <= bound + 1e-3);  // the storage of linear light
        ratios.push_back(bound / std::max(worst, 1e-3));
    }
    std::nth_element(ratios.begin(), ratios.begin() + 30, ratios.end());
    WARN("bound / measured, median: " << ratios[30]);
}

TEST_CASE("splats: piles of faint ones are right by their own digits", "[raster][splats][budget]") {
    // 20,000 of an alpha of 1e-6: sums of float32 with all that is behind would lose a third of a code.
    Splats s;
    std::vector<Vec3f> places(20000);
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i].z = static_cast<float>(i) * 1e-6f;
        s.rotations.push_back({0, 0, 0, 1}), s.scales.push_back({3, 3, 0.01f}), s.opacities.push_back(1e-6f);
        s.harmonics.insert(s.harmonics.end(), 3, 1.7724539f);
    }
    Scene scene;
    scene.meshes = {make_splat_mesh(places, s)};
    scene.instances = {{0, {}}};
    const Camera camera = halflit::test::camera_at({0, 0, 4}, {0, 0, 0});
    const std::vector<double> truth = truth_of(scene, camera);
    for (const double budget : {0.0, 1.0}) {
        Settings settings = plain();
        settings.shading.max_error_codes = budget;
        double bound = 0.0, worst = 0.0;
        const std::vector<double> codes = fine_codes(scene, camera, settings, &bound);
        for (std::size_t k = 0; k < codes.size(); ++k) worst = std::max(worst, std::abs(codes[k] - 255.0 * truth[k]));
        INFO(worst << " of " << bound);
        CHECK(bound <= budget);
        CHECK(worst <= bound + 0.02);
    }
}

TEST_CASE("splats: a region is that part of the picture, bit for bit", "[raster][splats]") {
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        const Scene scene = varied_splats(seed);
        Settings settings = plain();
        settings.shading.max_error_codes = seed % 2 == 0 ? 2.0 : 0.0;
        const Camera camera = varied_camera(seed);
        const std::vector<double> whole = fine_codes(scene, camera, settings);
        Random random(seed);
        const int x = static_cast<int>(random.real(0, 50)), y = static_cast<int>(random.real(0, 40));
        settings.region =
            Region{x, y, 1 + static_cast<int>(random.real(0, kWidth - x - 1)), 1 + static_cast<int>(random.real(0, kHeight - y - 1))};
        const std::vector<double> part = fine_codes(scene, camera, settings);
        std::size_t differs = 0;
        for (int row = 0; row < settings.region.height; ++row)
            for (int column = 0; column < 3 * settings.region.width; ++column)
                differs += part[static_cast<std::size_t>(row * 3 * settings.region.width + column)] !=
                                   whole[static_cast<std::size_t>(3 * ((y + row) * kWidth + x) + column)]
                               ? 1
                               : 0;
        INFO("seed " << seed);
        CHECK(differs == 0);
    }
}

TEST_CASE("splats: numbers of any size are drawn or left out", "[raster][splats]") {
    Scene scene = random_splats(4, SplatReference::khr, 200);
    Random random(4);
    constexpr float kOdd[] = {
        std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(), 1e38f, -1e38f, 1e-40f, 0.0f, 1e20f};
    Splats s = *scene.meshes[0].splats;
    for (std::size_t i = 0; i < 100; ++i) {
        const float odd = kOdd[i % std::size(kOdd)];
        if (i % 5 == 0) scene.meshes[0].positions[i].x = odd;
        if (i % 5 == 1) s.scales[i].y = odd;
        if (i % 5 == 2) s.rotations[i] = {odd, odd, odd, odd};
        if (i % 5 == 3) s.opacities[i] = odd;
        if (i % 5 == 4) s.harmonics[3 * i] = odd;
    }
    scene.meshes[0].splats = std::make_shared<const Splats>(std::move(s));
    for (const double code : fine_codes(scene, varied_camera(4), plain())) CHECK((code >= 0.0 && code <= 255.001));
}

TEST_CASE("splats: those that no view is fitted to are drawn too", "[raster][splats]") {
    Scene scene = random_splats(1, SplatReference::inria);
    scene.meshes[0].indices.clear();
    std::vector<std::uint8_t> codes(4 * kWidth * kHeight);
    const auto report = render(scene, halflit::test::camera_at({0, 0, 4}, {0, 0, 0}), plain(),
                               {.width = kWidth, .height = kHeight, .pixels = codes.data()});
    REQUIRE(report);
    CHECK(report->pixels_visible > 500);
    CHECK(std::count_if(codes.begin(), codes.end(), [](std::uint8_t code) { return code > 30 && code < 255; }) > 1000);
}

TEST_CASE("splats: over nothing, alpha is what they hide, and colours are straight", "[raster][splats]") {
    Scene scene = random_splats(2, SplatReference::khr, 1);
    Splats one = *scene.meshes[0].splats;
    scene.meshes[0].positions[0] = {0, 0, 0};
    one.scales[0] = {3, 3, 3}, one.opacities[0] = 0.5f, one.degree = 0, one.harmonics = {0, 1.7724539f, -1.7724539f};
    scene.meshes[0].splats = std::make_shared<const Splats>(one);
    Settings settings = plain();
    settings.background_linear = {0, 0, 0, 0};
    const auto codes = codes_of(scene, halflit::test::camera_at({0, 0, 4}, {0, 0, 0}), settings);
    const std::uint8_t* const middle = codes.data() + 4 * (kHeight / 2 * kWidth + kWidth / 2);
    // Half a pixel beside its middle its alpha is .4999, and red is .5 in straight colours.
    CHECK(std::vector<int>(middle, middle + 4) == std::vector<int>{128, 255, 0, 127});
}

TEST_CASE("splats: parallel rays show what a camera far away shows", "[raster][splats]") {
    const Scene scene = random_splats(3, SplatReference::inria);
    Camera parallel = halflit::test::camera_at({0, 0, 2000}, {0, 0, 0}), far = parallel;
    parallel.orthographic = true, parallel.half_height = 1.2f, parallel.near_z = 1.0f, parallel.far_z = 4000.0f;
    far.fov_y_rad = 2.0f * std::atan(1.2f / 2000.0f), far.near_z = 1.0f;
    const auto a = codes_of(scene, parallel, plain()), b = codes_of(scene, far, plain());
    int worst = 0, lit = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        worst = std::max(worst, std::abs(int{a[i]} - int{b[i]})), lit += i % 4 != 3 && a[i] > 30 ? 1 : 0;
    CHECK(worst <= 3);
    CHECK(lit > 1000);
}

TEST_CASE("splats: views are fitted to the ends of the axes of those that hide something", "[raster][splats]") {
    const float odd = std::numeric_limits<float>::quiet_NaN();
    Splats s;
    s.rotations = {{0, 0, 3, 3}, {0, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 0}};  // a quarter around z, and none
    s.scales = {{1, 2, 3}, {1, 1, odd}, {1, 1, 1}, {1, 1, 1}};
    s.opacities = {1, 1, 0.05f, 0.5f};
    s.harmonics = {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4};
    Mesh mesh = make_splat_mesh({{10, 20, 30}, {0, 0, 0}, {0, 0, 0}, {10, 20, 90}}, s);
    REQUIRE(mesh.splats->opacities == std::vector<float>{1, 0.05f, 0.5f});
    CHECK(mesh.splats->harmonics == std::vector<float>{1, 1, 1, 3, 3, 3, 4, 4, 4});
    CHECK(mesh.splats->rotations[1] == Vec4f{0, 0, 0, 1});
    CHECK(mesh.splats->rotations[0] == Vec4f{0, 0, 3, 3});
    Bounds box;
    for (const std::uint32_t i : mesh.indices) box.add(mesh.positions[i]);
    for (const auto& [found, expected] : {std::pair{box.min, Vec3f{6, 18, 24}}, {box.max, Vec3f{14, 22, 92}}}) {
        CHECK(std::fabs(found.x - expected.x) < 1e-4f);
        CHECK(std::fabs(found.y - expected.y) < 1e-4f);
        CHECK(std::fabs(found.z - expected.z) < 1e-4f);
    }
    // Among many, the outermost hundredth on each side is left out, and there are no ends.
    std::vector<Vec3f> row;
    for (int i = 0; i < 10000; ++i) row.push_back({static_cast<float>(i), 0, 0});
    s = {};
    s.rotations.resize(row.size()), s.scales.resize(row.size()), s.opacities.resize(row.size(), 1.0f), s.harmonics.resize(3 * row.size());
    mesh = make_splat_mesh(row, s);
    CHECK(mesh.positions.size() == row.size());
    CHECK(mesh.indices.front() == 100);
    CHECK(mesh.indices.back() == 9899);
}

TEST_CASE("splats: arrays of other lengths, and degrees that do not exist, are refused", "[raster][splats]") {
    const Scene good = random_splats(1, SplatReference::mip, 5);
    const auto refused = [&](auto&& spoil) {
        Scene scene = good;
        Splats bad = *scene.meshes[0].splats;
        spoil(bad);
        scene.meshes[0].splats = std::make_shared<const Splats>(std::move(bad));
        return !PreparedScene::make(scene).has_value();
    };
    CHECK(refused([](Splats& s) { s.scales.pop_back(); }));
    CHECK(refused([](Splats& s) { s.rotations.pop_back(); }));
    CHECK(refused([](Splats& s) { s.harmonics.pop_back(); }));
    CHECK(refused([](Splats& s) { s.opacities.push_back(1); }));
    CHECK(refused([](Splats& s) { s.degree = 5; }));
    CHECK(refused([](Splats& s) { s.degree = -1; }));
    CHECK_FALSE(refused([](Splats&) {}));
}
