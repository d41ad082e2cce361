// Fragments of one pixel that show one smooth surface are shaded as one.
#include "halflit/renderer.hpp"
#include "tests/support/cameras.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;
using halflit::test::camera_flat;

namespace {

constexpr int kSide = 64;  // pixels; world x, y in [-1, 1] map to them by (x + 1) * 32

struct Picture {
    std::vector<float> linear = std::vector<float>(4 * kSide * kSide), normal = std::vector<float>(3 * kSide * kSide),
                       position = std::vector<float>(3 * kSide * kSide);
    std::vector<std::uint32_t> triangle = std::vector<std::uint32_t>(kSide * kSide);
    RenderReport report;
};

Picture draw(const Scene& scene, int samples = 4, ShadingRate rate = ShadingRate::pixel) {
    Picture p;
    Settings settings;
    settings.samples = samples;
    settings.shading.rate = rate;
    const Target target{.width = kSide,
                        .height = kSide,
                        .linear = p.linear.data(),
                        .normal = p.normal.data(),
                        .triangle = p.triangle.data(),
                        .position = p.position.data()};
    const auto report = render(scene, camera_flat(), settings, target);
    INFO((report ? std::string() : report.error().message));
    REQUIRE(report);
    p.report = *report;
    return p;
}

/// A height field of n x n quads over [-.8, .8]^2 with slope in x, lit from an angle. bend: radians that its normals turn from one column
/// to the next.
Scene field(int n, float bend) {
    Mesh mesh;
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(n), v = static_cast<float>(y) / static_cast<float>(n);
            const float angle = bend * static_cast<float>(x % 2);
            mesh.positions.push_back({-0.8f + 1.6f * u, -0.8f + 1.6f * v, 0.1f * u});
            mesh.normals.push_back({std::sin(angle), 0, std::cos(angle)});
        }
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const auto a = static_cast<std::uint32_t>(y * (n + 1) + x), b = a + static_cast<std::uint32_t>(n) + 1;
            for (const std::uint32_t i : {a, a + 1, b + 1, a, b + 1, b}) mesh.indices.push_back(i);
        }
    Scene scene;
    scene.materials.emplace_back();
    mesh.material = 0;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, {}});
    Light light;
    light.direction_ws = {-0.5f, 0, -0.8f};
    scene.lights.push_back(light);
    return scene;
}

/// The same triangles with vertices of their own.
Scene apart(Scene scene) {
    Mesh& mesh = scene.meshes[0];
    const Mesh old = mesh;
    mesh.positions.clear(), mesh.normals.clear();
    for (std::size_t i = 0; i < old.indices.size(); ++i) {
        mesh.positions.push_back(old.positions[old.indices[i]]);
        mesh.normals.push_back(old.normals[old.indices[i]]);
        mesh.indices[i] = static_cast<std::uint32_t>(i);
    }
    return scene;
}

float largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
    float largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

}  // namespace

TEST_CASE("join: a pixel of one smooth surface is shaded once", "[raster][join]") {
    for (const int samples : {4, 8, 16}) {
        const Scene flat = field(13, 0);  // quads of four pixels
        const Picture one = draw(flat, samples), many = draw(apart(flat), samples);
        CHECK(one.report.pixels_visible == many.report.pixels_visible);
        CHECK(many.report.fragments_shaded > one.report.pixels_visible * 5 / 4);
        CHECK(one.report.fragments_shaded == one.report.pixels_visible);
        // Light of a plane is the same wherever it is asked for.
        CHECK(largest_difference(one.linear, many.linear) < 1e-6f);
    }
    // Triangles of less than a pixel meet in corners, too.
    const Picture dense = draw(field(60, 0.1f));
    CHECK(dense.report.fragments_shaded < dense.report.pixels_visible * 51 / 50);
    CHECK(largest_difference(dense.linear, draw(apart(field(60, 0.1f))).linear) < 0.02f);
}

TEST_CASE("join: small triangles whose normals differ are shaded apart, large ones are not", "[raster][join]") {
    const Scene small = field(13, 0.6f);
    CHECK(largest_difference(draw(small).linear, draw(apart(small)).linear) == 0.0f);
    const Picture large = draw(field(4, 0.6f));
    CHECK(large.report.fragments_shaded == large.report.pixels_visible);
}

TEST_CASE("join: other surfaces, other sides and flat shading stay apart", "[raster][join]") {
    const Scene scene = field(13, 0);
    const std::uint64_t many = draw(apart(scene)).report.fragments_shaded;
    CHECK(draw(scene, 4, ShadingRate::flat).report.fragments_shaded == many);
    // Another instance on the other half of the picture has the same vertices, at another place.
    Scene two = scene;
    two.instances[0].world_from_object.c[0].x = 0.5f, two.instances[0].world_from_object.c[3].x = -0.4f;
    two.instances.push_back(two.instances[0]);
    two.instances[1].world_from_object.c[3].x = 0.4f;
    const Picture seam = draw(two);
    CHECK(seam.report.fragments_shaded >= seam.report.pixels_visible);
    CHECK(seam.report.fragments_shaded <= seam.report.pixels_visible + kSide);
    // A fold: the back of one triangle beside the front of another.
    Scene fold = scene;
    fold.materials[0].double_sided = true;
    Mesh& mesh = fold.meshes[0];
    for (std::size_t i = 0; i < mesh.indices.size(); i += 6) std::swap(mesh.indices[i], mesh.indices[i + 1]);
    CHECK(draw(fold).report.fragments_shaded > many * 9 / 10);  // triangles of one side may meet in corners
}

TEST_CASE("join: planes are those of each pixel's first sample", "[raster][join]") {
    const Scene scene = field(13, 0.1f);
    const Picture one = draw(scene), many = draw(apart(scene));
    CHECK(one.triangle == many.triangle);
    CHECK(one.normal == many.normal);
    CHECK(one.position == many.position);
}
