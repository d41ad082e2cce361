// Eye-dome lighting and sizes of points that close their surface.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "raster/view/point_sizes.hpp"
#include "raster/view/projection.hpp"

#include "tests/support/cameras.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/random.hpp"

#include <cmath>

using namespace halflit;
using halflit::test::Random;

namespace {

Scene cloud(std::vector<Vec3f> places) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].unlit = true;
    Mesh mesh;
    mesh.topology = Topology::points;
    mesh.positions = std::move(places);
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.indices.push_back(i);
    mesh.material = 0;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, {}});
    return scene;
}

/// Points of a plane through the origin on a grid of `step`, turned about the x axis.
Scene tilted(double degrees, float step, float unit = 1.0f) {
    const auto c = static_cast<float>(std::cos(degrees * 3.14159265358979 / 180)),
               s = static_cast<float>(std::sin(degrees * 3.14159265358979 / 180));
    std::vector<Vec3f> places;
    for (float u = -1; u <= 1; u += step)
        for (float v = -1; v <= 1; v += step) places.push_back({u * unit, v * c * unit, v * s * unit});
    return cloud(std::move(places));
}

struct Picture {
    int width, height;
    std::vector<std::uint8_t> codes;
    std::vector<float> linear, depth;
    [[nodiscard]] std::size_t middle() const { return static_cast<std::size_t>(height / 2 * width + width / 2); }
    /// Mean of the linear light around the middle.
    [[nodiscard]] double mean() const {
        double sum = 0;
        for (int y = height / 2 - 8; y < height / 2 + 8; ++y)
            for (int x = width / 2 - 8; x < width / 2 + 8; ++x)
                sum += double{linear[std::size_t{4} * static_cast<std::size_t>(y * width + x)]};
        return sum / 256;
    }
};

Picture drawn(const Scene& scene, const Camera& camera, const Settings& settings, int width = 128, int height = 128) {
    const auto pixels = static_cast<std::size_t>(width * height);
    Picture out{width, height, std::vector<std::uint8_t>(4 * pixels), std::vector<float>(4 * pixels), std::vector<float>(pixels)};
    Target target{width, height};
    target.pixels = out.codes.data(), target.linear = out.linear.data(), target.depth = out.depth.data();
    REQUIRE(render(scene, camera, settings, target));
    return out;
}

Settings domed(EyeDomeLighting edl = EyeDomeLighting::automatic) {
    Settings settings;
    settings.edl = edl;
    settings.point_size = 0;
    return settings;
}

Camera from_front(double distance, double fov_y_rad) {
    Camera camera = test::camera_at({0, 0, static_cast<float>(distance)}, {0, 0, 0});
    camera.fov_y_rad = static_cast<float>(fov_y_rad);
    return camera;
}

/// Mean over eight directions of the positive part of a plane's slope.
double mean_rise(double degrees) {
    const double slope = std::tan(degrees * 3.14159265358979 / 180);
    return slope * (1 + 2 * std::sqrt(0.5)) / 8;
}

}  // namespace

TEST_CASE("eye dome: a plane is darker by the rise of its neighbours, whatever the size, the unit, the distance and the projection",
          "[raster][eye_dome]") {
    for (const double degrees : {0.0, 30.0, 45.0, 60.0}) {
        const double share = 1 / (1 + mean_rise(degrees)), expected = share * share;
        INFO(degrees << " degrees, expected " << expected);
        // Circles are level, so a steep plane is a stair; the mean of its steps is darker than the plane by some.
        const double margin = 0.02 + 0.1 * (1 - expected);
        CHECK(drawn(tilted(degrees, 0.004f), from_front(8, 0.2), domed()).mean() == Approx(expected).margin(margin));
        CHECK(drawn(tilted(degrees, 0.004f), from_front(8, 0.2), domed(), 256, 200).mean() == Approx(expected).margin(margin));
        CHECK(drawn(tilted(degrees, 0.004f, 1000), from_front(8000, 0.2), domed()).mean() == Approx(expected).margin(margin));
        CHECK(drawn(tilted(degrees, 0.004f), from_front(16, 0.1), domed()).mean() == Approx(expected).margin(margin));
        Camera parallel = from_front(8, 0.2);
        parallel.orthographic = true, parallel.half_height = 0.8f;
        CHECK(drawn(tilted(degrees, 0.004f), parallel, domed()).mean() == Approx(expected).margin(margin));
    }
}

TEST_CASE("eye dome: its strength is a factor, and 0 or off is none", "[raster][eye_dome]") {
    const Scene scene = tilted(45, 0.004f);
    const Camera camera = from_front(8, 0.2);
    Settings settings = domed(EyeDomeLighting::off);
    const Picture plain = drawn(scene, camera, settings);
    settings.edl = EyeDomeLighting::on, settings.edl_strength = 0;
    CHECK(drawn(scene, camera, settings).linear == plain.linear);
    double last = plain.mean();
    for (const float strength : {0.25f, 1.0f, 4.0f, 16.0f}) {
        settings.edl_strength = strength;
        const double now = drawn(scene, camera, settings).mean();
        CHECK(now < 0.95 * last);
        last = now;
    }
}

TEST_CASE("eye dome: clouds without normals alone are shaded, unless all surfaces are asked for", "[raster][eye_dome]") {
    Scene lit = tilted(50, 0.01f);
    lit.meshes[0].normals.assign(lit.meshes[0].positions.size(), {0, 0, 1});
    Scene box;
    box.meshes.push_back(make_box({1, 1, 1}));
    box.instances.push_back({0, {}});
    box.ambient = {{0.6f, 0.6f, 0.6f}, {0.4f, 0.4f, 0.4f}};
    const Camera camera = test::camera_at({3, 2, 4}, {0, 0, 0});
    for (const Scene* scene : {&lit, &box}) {
        const Picture plain = drawn(*scene, camera, domed(EyeDomeLighting::off));
        CHECK(drawn(*scene, camera, domed()).codes == plain.codes);
        CHECK(drawn(*scene, camera, domed(EyeDomeLighting::on)).codes != plain.codes);
    }
    // A cloud behind a box: the box keeps its pixels, and darkens what is behind it.
    Scene both = tilted(0, 0.01f);
    both.meshes.push_back(make_box({0.6f, 0.6f, 0.2f}));
    both.instances.push_back({1, translation({0, 0, 0.6f})});
    Settings settings = domed(EyeDomeLighting::off);
    const Camera front = from_front(6, 0.5);
    const Picture plain = drawn(both, front, settings);
    settings.edl = EyeDomeLighting::automatic;
    const Picture shaded = drawn(both, front, settings);
    int kept = 0, darker = 0;
    for (std::size_t i = 0; i < plain.depth.size(); ++i) {
        const bool is_box = plain.depth[i] < 5.6f;
        if (is_box) CHECK(shaded.codes[4 * i] == plain.codes[4 * i]);
        kept += is_box ? 1 : 0;
        darker += !is_box && shaded.codes[4 * i] < plain.codes[4 * i] ? 1 : 0;
    }
    CHECK(kept > 100);
    CHECK(darker > 20);
}

TEST_CASE("eye dome: depth, alpha and background stay", "[raster][eye_dome]") {
    Random random(3);
    std::vector<Vec3f> places;
    for (int i = 0; i < 3000; ++i) places.push_back({random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)});
    const Scene scene = cloud(std::move(places));
    const Camera camera = test::camera_at({3, 2, 4}, {0, 0, 0});
    for (const int samples : {1, 4, 16}) {
        Settings settings = domed(EyeDomeLighting::off);
        settings.samples = samples;
        if (samples == 4) settings.background_linear = {0.2f, 0.3f, 0.4f, 1};
        const Picture plain = drawn(scene, camera, settings);
        settings.edl = EyeDomeLighting::automatic;
        const Picture shaded = drawn(scene, camera, settings);
        CHECK(shaded.depth == plain.depth);
        int darker = 0, wrong = 0;
        for (std::size_t i = 0; i < plain.depth.size(); ++i) {
            wrong += shaded.codes[4 * i + 3] != plain.codes[4 * i + 3] || shaded.linear[4 * i + 3] != plain.linear[4 * i + 3] ? 1 : 0;
            for (std::size_t c = 4 * i; c < 4 * i + 3; ++c)
                wrong += shaded.codes[c] > plain.codes[c] || shaded.linear[c] > plain.linear[c] ? 1 : 0;
            darker += shaded.codes[4 * i] < plain.codes[4 * i] ? 1 : 0;
        }
        CHECK(wrong == 0);
        CHECK(darker > 500);
        CHECK(std::equal(plain.codes.begin(), plain.codes.begin() + 4, shaded.codes.begin()));  // a corner shows nothing
    }
}

TEST_CASE("point sizes: points at random leave hardly a pixel of their surface open, where they are dense and where they are not",
          "[raster][points]") {
    Random random(5);
    // A sphere has two layers; one half of it has four times the points of the other.
    std::vector<Vec3f> places;
    while (places.size() < 40000) {
        const Vec3f p{random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)};
        const float squared = p.x * p.x + p.y * p.y + p.z * p.z;
        if (squared > 1 || squared < 0.01f || (p.x > 0 && random.real32(0, 1) > 0.25f)) continue;
        const float scale = 1 / std::sqrt(squared);
        places.push_back({p.x * scale, p.y * scale, p.z * scale});
    }
    const Scene scene = cloud(std::move(places));
    const Camera camera = from_front(6, 0.4);
    Settings settings = domed(EyeDomeLighting::off);
    constexpr int kSide = 400;
    const Picture picture = drawn(scene, camera, settings, kSide, kSide);
    int open = 0, inside = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double radius = std::hypot(x + 0.5 - kSide / 2, y + 0.5 - kSide / 2) / (kSide / 2) * std::tan(0.2) * 6;
            if (radius > 0.95) continue;
            ++inside;
            // Farther than the centre: the other side is seen.
            open += !(picture.depth[static_cast<std::size_t>(y * kSide + x)] < 6.0f) ? 1 : 0;
        }
    CHECK(inside > 50000);
    CHECK(open < 0.01 * inside);
    const raster::PointSizes sizes = raster::closing_point_sizes(scene, raster::clip_from_world(camera, 1), kSide, kSide);
    double dense = 0, sparse = 0;
    for (int x = 70; x < 170; x += 5) dense += sizes.at(256 * x, 256 * 200), sparse += sizes.at(256 * (400 - x), 256 * 200);
    CHECK(sparse / dense == Approx(2).epsilon(0.2));
}

TEST_CASE("point sizes: by the distance of points in the picture, within 2 pixels and a 25th of its side", "[raster][points]") {
    const auto size = [](int side, int width) {
        std::vector<Vec3f> places;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                places.push_back({(static_cast<float>(x) + 0.5f) / static_cast<float>(side) - 0.5f,
                                  (static_cast<float>(y) + 0.5f) / static_cast<float>(side) - 0.5f, 0});
        Camera camera = from_front(5, 0.4);
        camera.orthographic = true, camera.half_height = 0.5f;
        const raster::PointSizes sizes =
            raster::closing_point_sizes(cloud(std::move(places)), raster::clip_from_world(camera, 1), width, width);
        return sizes.at(128 * width, 128 * width) / 256.0;
    };
    // Points 4 pixels apart; a body has two layers of them. Cells have whole numbers of points, so a grid's are uneven.
    CHECK(size(200, 800) == Approx(4 * 2.7 * std::sqrt(2.0)).epsilon(0.08));
    CHECK(size(400, 1600) == Approx(4 * 2.7 * std::sqrt(2.0)).epsilon(0.08));
    CHECK(size(900, 800) == Approx(800.0 / 900 * 2.7 * std::sqrt(2.0)).epsilon(0.08));
    CHECK(size(1600, 800) == Approx(2.0).epsilon(0.05));
    CHECK(size(2, 800) == Approx(32));
    CHECK(raster::closing_point_sizes(Scene{}, Mat4{}, 80, 80).empty());
}
