// Whole pictures against closed forms: alpha test, blending, samples, background, NaN and infinity.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "raster/view/view.hpp"
#include "tests/raster/debug_view.hpp"
#include "tests/raster/kernel_fixture.hpp"
#include "tests/support/cameras.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;
using halflit::test::camera_flat;

namespace {

constexpr int kSide = 64;  // pixels; world x, y in [-1, 1] map to them by (x + 1) * 32
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

struct Picture {
    std::vector<std::uint8_t> rgba8;
    std::vector<float> linear;
    RenderReport report;
    [[nodiscard]] const float* at(int x, int y) const { return &linear[static_cast<std::size_t>(4 * (y * kSide + x))]; }
    [[nodiscard]] const std::uint8_t* code(int x, int y) const { return &rgba8[static_cast<std::size_t>(4 * (y * kSide + x))]; }
};

Picture draw(const Scene& scene, const Settings& settings = {}, const Camera& camera = camera_flat()) {
    Picture p;
    p.rgba8.resize(4 * kSide * kSide);
    p.linear.resize(4 * kSide * kSide);
    auto report = render(scene, camera, settings, {kSide, kSide, p.rgba8.data(), p.linear.data()});
    INFO((report ? std::string() : report.error().message));
    REQUIRE(report);
    p.report = *report;
    return p;
}

Mesh quad(float x0, float y0, float x1, float y1, float z) {
    Mesh m;
    m.positions = {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
    m.normals.assign(4, {0, 0, 1});
    m.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    m.indices = {0, 1, 2, 0, 2, 3};
    return m;
}

/// Builds a scene of one instance of each mesh, in the order of adding; materials are unlit unless changed.
struct Builder {
    Scene scene;
    Material& add(Mesh mesh, Vec4f color, AlphaMode mode = AlphaMode::opaque) {
        Material m;
        m.unlit = true;
        m.base_color = color;
        m.alpha_mode = mode;
        scene.materials.push_back(m);
        mesh.material = static_cast<int>(scene.materials.size()) - 1;
        scene.meshes.push_back(std::move(mesh));
        scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, {}});
        return scene.materials.back();
    }
};

bool close(const float* pixel, std::array<double, 4> want, double tolerance = 3e-7) {
    bool ok = true;
    for (std::size_t i = 0; i < 4; ++i) ok &= std::abs(static_cast<double>(pixel[i]) - want[i]) <= tolerance;
    return ok;
}

bool all_finite(const Picture& p) {
    return std::all_of(p.linear.begin(), p.linear.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

TEST_CASE("mask: a hole shows what is behind it, drawn before or after", "[raster][frame]") {
    for (const bool mask_first : {false, true}) {
        for (const int samples : {1, 4, 8, 16}) {
            Builder b;
            const auto add_behind = [&] { b.add(quad(-1, -1, 1, 1, -1), {1, 0, 0, 1}); };
            if (!mask_first) add_behind();
            // Alpha rises from 0 on the left to 1 on the right: 0.5 between columns 31 and 32.
            Mesh front = quad(-1, -1, 1, 1, 1);
            front.colors = {{1, 1, 1, 0}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 0}};
            b.add(front, {0, 1, 0, 1}, AlphaMode::mask).alpha_cutoff = 0.5f;
            if (mask_first) add_behind();
            Settings settings;
            settings.samples = samples;
            const Picture p = draw(b.scene, settings);
            int wrong = 0;
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x) wrong += !(x < 32 ? close(p.at(x, y), {1, 0, 0, 1}) : close(p.at(x, y), {0, 1, 0, 1}));
            INFO("mask first " << mask_first << ", samples " << samples);
            CHECK(wrong == 0);
            CHECK(p.report.pixels_visible == kSide * kSide);
        }
        // The depth in the hole is that of the surface behind it.
        Builder b;
        Mesh front = quad(-1, -1, 1, 1, 5);
        front.colors = {{1, 1, 1, 0}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 0}};
        b.add(front, {0, 1, 0, 1}, AlphaMode::mask);
        b.add(quad(-1, -1, 1, 1, -5), {1, 0, 0, 1});
        const auto view = visibility(b.scene, camera_flat(), {}, kSide, kSide);
        REQUIRE(view);
        // The camera stands at z = 10 with its far plane 20 away: depth is 1 - (10 - z) / 20.
        CHECK(view->depth[10 * kSide + 10] == Approx(0.25).epsilon(1e-6));
        CHECK(view->depth[10 * kSide + 50] == Approx(0.75).epsilon(1e-6));
        CHECK(view->triangle[10 * kSide + 10] > 2);
        CHECK(view->triangle[10 * kSide + 50] <= 2);
    }
}

TEST_CASE("blend: two layers over an opaque one, in their order, by the over operator", "[raster][frame]") {
    const Vec4f first{0.9f, 0.1f, 0.3f, 0.25f}, second{0.2f, 0.8f, 0.4f, 0.6f};
    const double base[3] = {0.5, 0.25, 0.125};
    for (const int samples : {1, 4}) {
        Builder b;
        // An opaque square fills the left half. Of the blended layers, one is hidden behind it and two are in front; they are submitted
        // from back to front.
        b.add(quad(-1, -1, 1, 1, -4), {1, 1, 1, 0.9f}, AlphaMode::blend);
        b.add(quad(-1, -1, 0, 1, -2), {0.5f, 0.25f, 0.125f, 1});
        b.add(quad(-1, -1, 1, 1, 0), first, AlphaMode::blend);
        b.add(quad(-1, -1, 1, 1, 2), second, AlphaMode::blend);
        Settings settings;
        settings.samples = samples;
        const Picture p = draw(b.scene, settings);
        const float f[3] = {first.x, first.y, first.z}, s[3] = {second.x, second.y, second.z};
        std::array<double, 4> left{0, 0, 0, 1}, right{0, 0, 0, 0};
        right[3] = 1 - (1 - 0.9) * (1 - 0.25) * (1 - 0.6);
        for (std::size_t i = 0; i < 3; ++i) {
            left[i] = 0.6 * static_cast<double>(s[i]) + 0.4 * (0.25 * static_cast<double>(f[i]) + 0.75 * base[i]);
            // Without an opaque surface: the sum of the layers' contributions, divided by the resulting alpha.
            right[i] = (0.6 * static_cast<double>(s[i]) + 0.4 * (0.25 * static_cast<double>(f[i]) + 0.75 * 0.9)) / right[3];
        }
        CHECK(close(p.at(10, 30), left, 5e-7));
        CHECK(close(p.at(50, 30), right, 5e-7));
        CHECK(p.code(50, 30)[3] == std::lround(255 * right[3]));
    }
}

TEST_CASE("blend: what is hidden by an opaque triangle submitted later stays hidden", "[raster][frame]") {
    Builder b;
    b.add(quad(-1, -1, 1, 1, 0), {0, 0, 1, 0.5f}, AlphaMode::blend);
    b.add(quad(-1, -1, 1, 1, 1), {1, 0, 0, 1});
    CHECK(close(draw(b.scene).at(20, 20), {1, 0, 0, 1}));
}

namespace {

/// Area of the unit square around (x, y) where a x + b y + c >= 0, by clipping the square's outline.
double half_plane_area(double a, double b, double c, double x, double y) {
    const double corner[4][2] = {{x - 0.5, y - 0.5}, {x + 0.5, y - 0.5}, {x + 0.5, y + 0.5}, {x - 0.5, y + 0.5}};
    std::vector<std::array<double, 2>> kept;
    for (int i = 0; i < 4; ++i) {
        const double *p = corner[i], *q = corner[(i + 1) % 4];
        const double dp = a * p[0] + b * p[1] + c, dq = a * q[0] + b * q[1] + c;
        if (dp >= 0) kept.push_back({p[0], p[1]});
        if ((dp >= 0) != (dq >= 0)) kept.push_back({p[0] + (q[0] - p[0]) * dp / (dp - dq), p[1] + (q[1] - p[1]) * dp / (dp - dq)});
    }
    double area = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const auto &p = kept[i], &q = kept[(i + 1) % kept.size()];
        area += 0.5 * (p[0] * q[1] - q[0] * p[1]);
    }
    return area;
}

}  // namespace

TEST_CASE("samples: a pixel's alpha is the share of its samples inside the edge, near the area inside", "[raster][frame]") {
    struct Row {
        int samples;
        double axis_bound, any_bound;
    };
    // Vertical and horizontal edges: the samples are in different columns and rows, evenly spaced, so the error is at most half a step.
    // Other edges: measured over 80 directions 0.501, 0.306, 0.226, 0.103, the last three where an edge passes two samples at once.
    for (const Row row : {Row{1, 0.5, 0.51}, Row{4, 0.125, 0.32}, Row{8, 0.0625, 0.24}, Row{16, 1.0 / 32, 0.115}}) {
        const SamplePattern pattern = standard_samples(row.samples);
        double worst_axis = 0, worst_any = 0;
        int wrong = 0, partial = 0, on_edge = 0;
        double sum_of_errors = 0;
        for (int i = 0; i < 80; ++i) {
            const double angle = i * 0.0785398163397448, nx = std::cos(angle), ny = std::sin(angle);
            const double offset = 0.31 * std::sin(3.7 * i);  // distance of the edge from the middle, in world units
            // Triangle that covers nx x + ny y >= offset: two corners far along the edge, one far inside.
            Mesh m;
            const auto point = [&](double along, double in) {
                return Vec3f{static_cast<float>(nx * (offset + in) - ny * along), static_cast<float>(ny * (offset + in) + nx * along), 0};
            };
            m.positions = {point(-8, 0), point(8, 0), point(0, 30)};
            m.indices = {0, 1, 2};
            Builder b;
            b.add(m, {1, 1, 1, 1}).double_sided = true;
            Settings settings;
            settings.samples = row.samples;
            const Picture p = draw(b.scene, settings);
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x) {
                    // In pixels, y down: world x = px / 32 - 1, y = 1 - py / 32.
                    const double a = nx / 32, bb = -ny / 32, c = -nx + ny - offset;
                    const double alpha = static_cast<double>(p.at(x, y)[3]);
                    const double area = half_plane_area(32 * a, 32 * bb, 32 * c, x + 0.5, y + 0.5);
                    int inside = 0, doubtful = 0;
                    for (int s = 0; s < pattern.count; ++s) {
                        const double d = 32 * (a * (x + 0.5 + pattern.x[s] / 256.0) + bb * (y + 0.5 + pattern.y[s] / 256.0) + c);
                        inside += d > 0;
                        doubtful += std::abs(d) < 1.0 / 128;
                    }
                    if (doubtful == 0) wrong += alpha != static_cast<double>(inside) / pattern.count;
                    const double error = alpha - area;
                    if (area > 0 && area < 1) {
                        sum_of_errors += error;
                        ++on_edge;
                        (i % 20 == 0 ? worst_axis : worst_any) = std::max(i % 20 == 0 ? worst_axis : worst_any, std::abs(error));
                    }
                    if (alpha > 0 && alpha < 1) {
                        ++partial;
                        wrong += !close(p.at(x, y), {1, 1, 1, alpha}, 2e-7);  // missing samples do not darken the colour
                    }
                }
        }
        INFO("samples " << row.samples);
        CHECK(wrong == 0);
        CHECK(on_edge > 3000);
        CHECK(std::abs(sum_of_errors / on_edge) < 0.01);  // no direction is favoured
        CHECK(worst_axis <= row.axis_bound + 1.0 / 128);
        CHECK(worst_any <= row.any_bound);
        CHECK((row.samples == 1 || partial > 1000));
    }
}

TEST_CASE("samples: sixteen have a row and a column each, and are near the area beside edges of any slope", "[raster][frame]") {
    const SamplePattern pattern = make_view(Camera{}, 8, 8, {}, 64, 16).samples;
    REQUIRE(pattern.count == 16);
    unsigned rows = 0, columns = 0;
    for (int s = 0; s < 16; ++s) {
        // Centres of a grid of 16 x 16 cells.
        CHECK((pattern.x[s] + 120) % 16 == 0);
        CHECK((pattern.y[s] + 120) % 16 == 0);
        columns |= 1u << (pattern.x[s] + 120) / 16;
        rows |= 1u << (pattern.y[s] + 120) / 16;
    }
    CHECK(rows == 0xffff);
    CHECK(columns == 0xffff);
    // Random slopes and places. The largest error cannot be below 1/16: between the edges just before and just behind two samples, whose
    // areas are the same, there are two samples. Found by a search: 0.114, and 0.0258 in the mean, over edges that cut the pixel.
    halflit::test::Random random(16);
    double worst = 0, sum = 0;
    constexpr int kEdges = 200'000;
    for (int i = 0; i < kEdges; ++i) {
        const double angle = random.real(0, 6.283185307179586), nx = std::cos(angle), ny = std::sin(angle);
        const double reach = 0.5 * (std::abs(nx) + std::abs(ny)), offset = random.real(-reach, reach);
        int inside = 0;
        for (int s = 0; s < 16; ++s) inside += nx * pattern.x[s] / 256.0 + ny * pattern.y[s] / 256.0 > offset;
        const double error = std::abs(inside / 16.0 - half_plane_area(nx, ny, -offset, 0, 0));
        worst = std::max(worst, error);
        sum += error;
    }
    CHECK(worst < 0.115);
    CHECK(sum / kEdges < 0.0265);
}

TEST_CASE("background: transparent, or a colour, wherever nothing is drawn", "[raster][frame]") {
    Builder b;
    b.add(quad(-0.5f, -0.5f, 0.5f, 0.5f, 0), {1, 1, 1, 1});
    for (const int samples : {1, 4, 8, 16}) {
        Settings settings;
        settings.samples = samples;
        Picture p = draw(b.scene, settings);
        CHECK(close(p.at(2, 2), {0, 0, 0, 0}, 0));
        CHECK(p.code(2, 2)[3] == 0);
        CHECK(close(p.at(32, 32), {1, 1, 1, 1}, 0));
        CHECK(p.code(32, 32)[0] == 255);
        settings.background_linear = {0.5f, 0.25f, 0, 1};
        p = draw(b.scene, settings);
        CHECK(close(p.at(2, 2), {0.5, 0.25, 0, 1}));
        CHECK(p.code(2, 2)[0] == 188);  // 255 (1.055 0.5^(1/2.4) - 0.055) = 187.5
        CHECK(p.code(2, 2)[1] == 137);  // 136.9
        CHECK(p.code(2, 2)[3] == 255);
        // Exposure scales light, not the background, nor colours without light.
        settings.exposure = 0.5f;
        p = draw(b.scene, settings);
        CHECK(close(p.at(2, 2), {0.5, 0.25, 0, 1}));
        CHECK(close(p.at(32, 32), {1, 1, 1, 1}));
    }
}

TEST_CASE("background: a background that is not a number is black", "[raster][frame]") {
    for (const int samples : {1, 4}) {
        Builder b;
        b.add(quad(-0.5f, -0.5f, 0.5f, 0.5f, 0), {1, 1, 1, 0.5f}, samples == 1 ? AlphaMode::opaque : AlphaMode::blend);
        Settings settings;
        settings.samples = samples;
        settings.background_linear = {kNan, 0.25f, kNan, 1};
        const Picture p = draw(b.scene, settings);
        CHECK(close(p.at(2, 2), {0, 0.25, 0, 1}));
        CHECK(all_finite(p));
    }
}

TEST_CASE("frame: an empty scene is background, with a warning", "[raster][frame]") {
    Settings settings;
    settings.background_linear = {0.2f, 0.4f, 0.6f, 1};
    const auto nothing = [](const RenderReport& r) { return r.warnings.size() == 1 && r.warnings[0].starts_with("nothing to draw"); };
    const Picture empty = draw({}, settings);
    CHECK(nothing(empty.report));
    CHECK(empty.report.pixels_visible == 0);
    int wrong = 0;
    for (int i = 0; i < kSide * kSide; ++i) wrong += !close(empty.at(i % kSide, i / kSide), {0.2f, 0.4f, 0.6f, 1}, 0);
    CHECK(wrong == 0);

    // All triangles without area, or all in one point.
    Builder b;
    b.add(quad(0.1f, 0.1f, 0.1f, 0.1f, 0), {1, 1, 1, 1});
    b.add(quad(-1, 0, 1, 0, 0), {1, 1, 1, 1});
    b.add(quad(-1, -1, 1, 1, 0), {1, 1, 1, 1});
    b.scene.instances[2].world_from_object = scaling({0, 0, 0});
    const Picture flat = draw(b.scene, settings);
    CHECK(flat.linear == empty.linear);
    CHECK(flat.report.triangles_submitted == 6);
    CHECK(nothing(flat.report));

    // A triangle that is drawn, but lies between the samples.
    Builder small;
    small.add(quad(0.001f, 0.001f, 0.002f, 0.002f, 0), {1, 1, 1, 1});
    settings.samples = 1;
    CHECK(nothing(draw(small.scene, settings).report));
    // A pane is seen, by whichever accuracy.
    Builder pane;
    pane.add(quad(-1, -1, 1, 1, 0), {1, 1, 1, 0.5f}, AlphaMode::blend);
    for (const Accuracy accuracy : {Accuracy::exact, Accuracy::reference}) {
        settings.shading.accuracy = accuracy;
        CHECK(draw(pane.scene, settings).report.warnings.empty());
    }
    Builder clear;
    clear.add(quad(-1, -1, 1, 1, 0), {1, 1, 1, 0}, AlphaMode::blend);
    CHECK(nothing(draw(clear.scene, settings).report));
}

TEST_CASE("frame: triangles with a corner that is not finite are dropped and counted", "[raster][frame]") {
    Builder good, bad;
    Mesh mesh = make_plane(1.0f, 8);
    for (Vec3f& p : mesh.positions) p = {p.x, -p.z, 0};
    good.add(mesh, {1, 1, 1, 1});
    const Picture expected = draw(good.scene);
    CHECK(expected.report.triangles_not_finite == 0);

    // Three more triangles, each with one bad corner, and a bad corner that no triangle uses.
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const float v : {kNan, kInf, -kInf, kNan}) mesh.positions.push_back({0, v, 0});
    mesh.normals.resize(mesh.positions.size(), {0, 0, 1});
    mesh.uv0.resize(mesh.positions.size());
    for (std::uint32_t i = 0; i < 3; ++i) mesh.indices.insert(mesh.indices.end(), {0, 5, first + i});
    bad.add(mesh, {1, 1, 1, 1});
    const Picture p = draw(bad.scene);
    CHECK(p.report.triangles_not_finite == 3);
    CHECK(p.report.warnings.size() == 1);
    CHECK(p.linear == expected.linear);

    bad.scene.instances[0].world_from_object.c[3] = {kNan, 0, 0, 1};
    CHECK(draw(bad.scene).report.triangles_not_finite == 131);
}

TEST_CASE("frame: NaN results are written as 0 and counted", "[raster][frame]") {
    for (const int samples : {1, 4}) {
        Builder b;
        Mesh mesh = quad(-0.5f, -0.5f, 0.5f, 0.5f, 0);
        mesh.normals.assign(4, {kNan, kNan, kNan});
        b.add(mesh, {1, 1, 1, 1}).unlit = false;
        b.scene.ambient = {{1, 1, 1}, {0.5f, 0.5f, 0.5f}};
        b.scene.lights.push_back({});
        Settings settings;
        settings.samples = samples;
        settings.background_linear = {1, 1, 1, 1};
        const Picture p = draw(b.scene, settings);
        CHECK(all_finite(p));
        CHECK(close(p.at(32, 32), {0, 0, 0, 1}, 0));
        // The count is of fragments: with samples, a pixel on the diagonal shows two triangles.
        CHECK(p.report.nan_pixels == (samples == 1 ? 32 * 32 : 32 * 32 + 32));
        CHECK(p.report.warnings.size() == 1);
    }
    // Infinite light gives the brightest code, not NaN. Infinities of both signs among the samples of a pixel have no sum.
    Builder b;
    b.add(quad(-0.5f, -0.5f, 0.5f, 0.5f, 0), {kInf, 1, 1, 1});
    b.add(quad(-0.25f, -0.25f, 0.2f, 0.2f, 1), {-kInf, 0, 0, 1});
    for (const int samples : {1, 16}) {
        Settings settings;
        settings.samples = samples;
        const Picture p = draw(b.scene, settings);
        CHECK(std::none_of(p.linear.begin(), p.linear.end(), [](float x) { return std::isnan(x); }));
        CHECK(p.code(18, 18)[0] == 255);
        CHECK(p.code(30, 30)[0] == 0);
    }
}

TEST_CASE("frame: each visible pixel is shaded once, whatever lies behind it", "[raster][frame]") {
    Builder b;
    for (int i = 0; i < 10; ++i) b.add(quad(-1, -1, 1, 1, -5.0f + static_cast<float>(i)), {0.1f * static_cast<float>(i), 0, 0, 1});
    const Picture p = draw(b.scene);
    CHECK(p.report.triangles_submitted == 20);
    CHECK(p.report.pixels_visible == kSide * kSide);
    CHECK(p.report.fragments_shaded == kSide * kSide);
    CHECK(close(p.at(5, 5), {0.9, 0, 0, 1}));
}

TEST_CASE("frame: a mirrored instance keeps its outside and its light", "[raster][frame]") {
    Builder b;
    Mesh mesh = quad(0.2f, -0.5f, 0.8f, 0.5f, 0);
    mesh.normals.assign(4, {0.6f, 0, 0.8f});
    b.add(mesh, {1, 1, 1, 1}).unlit = false;
    b.scene.materials[0].metallic = 0;
    Light light;
    light.direction_ws = {0, 0, -1};
    b.scene.lights.push_back(light);
    Settings settings;
    settings.shading.specular = SpecularModel::none;
    const Picture right = draw(b.scene, settings);
    b.scene.instances[0].world_from_object = scaling({-1, 1, 1});
    const Picture left = draw(b.scene, settings);
    CHECK(close(right.at(48, 32), {0.8, 0.8, 0.8, 1}, 1e-6));  // N.L
    int differing = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            for (int c = 0; c < 4; ++c) differing += std::abs(right.at(x, y)[c] - left.at(kSide - 1 - x, y)[c]) > 1e-6f;
    CHECK(differing == 0);
    // Seen from behind it is culled, mirrored or not, unless both sides are asked for.
    b.scene.instances[0].world_from_object = scaling({1, 1, -1});
    b.scene.meshes[0].normals.assign(4, {0, 0, 1});
    CHECK(draw(b.scene, settings).report.pixels_visible == 0);
    b.scene.materials[0].double_sided = true;
    const Picture back = draw(b.scene, settings);
    CHECK(back.report.pixels_visible > 500);
    CHECK(close(back.at(48, 32), {1, 1, 1, 1}, 1e-6));  // lit as the side that is seen
}
