// Planes of depth, normals and numbers: against closed forms, an independent ray cast, and the visibility view.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "halflit/target.hpp"
#include "tests/raster/debug_view.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstring>
#include <limits>

using namespace halflit;
using halflit::raster::test::NamedScene;
using halflit::test::available_isas;
using halflit::test::camera_at;
using halflit::test::Random;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

/// All outputs of a picture. Planes that are not asked for stay as they were.
struct Planes {
    int width, height;
    std::vector<std::uint8_t> codes;
    std::vector<float> depth, normal, barycentric, uv;
    std::vector<std::uint32_t> instance, triangle;
    RenderReport report;

    Planes(int w, int h)
        : width(w),
          height(h),
          codes(4 * pixels(), 0xCD),
          depth(pixels(), -7),
          normal(3 * pixels(), -7),
          barycentric(2 * pixels(), -7),
          uv(2 * pixels(), -7),
          instance(pixels(), 99),
          triangle(pixels(), 99) {}
    [[nodiscard]] std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    [[nodiscard]] Target target(bool colour = false) {
        return {.width = width,
                .height = height,
                .pixels = colour ? codes.data() : nullptr,
                .depth = depth.data(),
                .normal = normal.data(),
                .instance = instance.data(),
                .triangle = triangle.data(),
                .barycentric = barycentric.data(),
                .uv = uv.data()};
    }
    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    [[nodiscard]] Vec3d normal_at(std::size_t i) const { return {normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]}; }
    bool operator==(const Planes& o) const {
        return std::memcmp(depth.data(), o.depth.data(), 4 * pixels()) == 0 &&
               std::memcmp(normal.data(), o.normal.data(), 12 * pixels()) == 0 && instance == o.instance && triangle == o.triangle &&
               std::memcmp(barycentric.data(), o.barycentric.data(), 8 * pixels()) == 0 &&
               std::memcmp(uv.data(), o.uv.data(), 8 * pixels()) == 0;
    }
};

Planes planes_of(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height,
                 const Execution& execution = {}) {
    Planes p(width, height);
    auto report = render(scene, camera, settings, p.target(), execution);
    INFO((report ? std::string() : report.error().message));
    REQUIRE(report);
    p.report = *report;
    return p;
}

/// Adds a mesh with a material of its own.
Material& add(Scene& scene, Mesh mesh, const Mat4& place = {}) {
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.emplace_back();
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, place});
    return scene.materials.back();
}

/// A square of half size `half` in the plane z = 0 that faces +z.
Mesh square(float half) {
    Mesh m;
    m.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
    m.normals.assign(4, {0, 0, 1});
    m.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    m.indices = {0, 1, 2, 0, 2, 3};
    return m;
}

Vec3d wide(Vec3f v) { return {v.x, v.y, v.z}; }
Vec3d wide(Vec4f v) { return {v.x, v.y, v.z}; }
Vec3d unit(Vec3d v) { return v * (1.0 / length(v)); }

/// View ray through the middle of a pixel, of length 1 along the view axis. The camera's aspect is the picture's.
Vec3d ray_of(const Camera& camera, int x, int y, int width, int height) {
    const double t = std::tan(0.5 * double{camera.fov_y_rad}), sx = (2 * (x + 0.5) / width - 1) * t * width / height,
                 sy = (1 - 2 * (y + 0.5) / height) * t;
    return wide(camera.world_from_camera.c[0]) * sx + wide(camera.world_from_camera.c[1]) * sy - wide(camera.world_from_camera.c[2]);
}

struct Corners {
    Vec3d p[3];
    std::uint32_t instance, triangle;  ///< from 0
    bool double_sided, mirrored;
};

std::vector<Corners> triangles_of(const Scene& scene) {
    std::vector<Corners> out;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Mat4& m = scene.instances[i].world_from_object;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[i].mesh)];
        const Material material = mesh.material < 0 ? Material{} : scene.materials[static_cast<std::size_t>(mesh.material)];
        if (material.alpha_mode == AlphaMode::blend) continue;
        for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
            Corners c{{},
                      static_cast<std::uint32_t>(i),
                      static_cast<std::uint32_t>(t),
                      material.double_sided,
                      dot(cross(wide(m.c[0]), wide(m.c[1])), wide(m.c[2])) < 0};
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3d p = wide(mesh.positions[mesh.indices[3 * t + k]]);
                c.p[k] = wide(m.c[0]) * p.x + wide(m.c[1]) * p.y + wide(m.c[2]) * p.z + wide(m.c[3]);
            }
            out.push_back(c);
        }
    }
    return out;
}

struct Hit {
    double distance = 1e300;  ///< along the view axis
    double inside = 0;        ///< least barycentric coordinate
};

/// Where a ray meets the plane of a triangle.
Hit hit_of(const Corners& c, Vec3d eye, Vec3d ray) {
    const Vec3d e1 = c.p[1] - c.p[0], e2 = c.p[2] - c.p[0], n = cross(e1, e2), to = eye - c.p[0];
    const double facing = dot(ray, n);
    if (facing == 0 || (!c.double_sided && (facing > 0) != c.mirrored)) return {1e300, -1};
    const double t = -dot(to, n) / facing;
    const Vec3d p = to + ray * t;
    const double u = dot(cross(p, e2), n) / dot(n, n), v = dot(cross(e1, p), n) / dot(n, n);
    return {t, std::min({u, v, 1 - u - v})};
}

/// A street: a floor that runs under and behind the camera, a row of boxes, mirrored and squeezed, spheres, and a sheet seen from behind.
struct Street {
    Scene scene;
    Camera camera = camera_at({0.3f, 1.1f, 2}, {0, 0.6f, -4}, 1.1f, 0.3f);
    Street() {
        add(scene, make_plane(40, 3));  // its triangles cross the near plane
        add(scene, make_box({0.4f, 0.5f, 0.3f}), translation({-1.2f, 0.5f, -1}) * rotation({0, 1, 0}, 0.6f));
        add(scene, make_sphere(0.6f, 24, 12), translation({1, 0.6f, -1.5f}));
        scene.instances.push_back({1, translation({0.2f, 0.7f, -3}) * scaling({-1.5f, 0.8f, 0.4f})});
        scene.instances.push_back({2, translation({-2, 1.3f, -4}) * rotation({1, 1, 0}, 1) * scaling({0.3f, 1.6f, 0.9f})});
        add(scene, square(0.7f), translation({1.9f, 1.1f, -3.5f}) * rotation({0, 1, 0}, 3.0f)).double_sided = true;
        scene.instances.push_back({1, translation({0.1f, 0.9f, 1.9f}) * scaling({0.2f, 0.2f, 0.2f})});  // the camera looks out of it
        Light sun;
        sun.direction_ws = {0.3f, -0.9f, -0.2f};
        scene.lights.push_back(sun);
        scene.ambient = {{0.2f, 0.2f, 0.3f}, {0.1f, 0.1f, 0.1f}};
    }
};

}  // namespace

TEST_CASE("planes: the point that is shaded lies within a pixel of its middle, in slivers too", "[raster][planes]") {
    // A sheet that is cut into a fan of slivers, turned a little, with its texture coordinates from the place.
    constexpr int kSlivers = 150, kSide = 64;
    Mesh fan;
    const double c = std::cos(0.02), s = std::sin(0.02);
    const auto add = [&](double x, double y) {
        fan.positions.push_back({static_cast<float>(c * x - s * y), static_cast<float>(s * x + c * y), 0});
        fan.uv0.push_back({fan.positions.back().x, fan.positions.back().y});
    };
    add(-1, 0);
    for (int i = 0; i <= kSlivers; ++i) add(1, 0.7 * i / kSlivers - 0.35);
    for (std::uint32_t i = 1; i <= kSlivers; ++i) fan.indices.insert(fan.indices.end(), {0, i, i + 1});
    fan.normals.assign(fan.positions.size(), {0, 0, 1});
    fan.material = 0;
    Scene scene;
    scene.materials.resize(1);
    scene.meshes.push_back(fan);
    scene.instances.push_back({0, {}});
    Camera camera = camera_at({0, 0, 5}, {0, 0, 0});
    camera.orthographic = true;
    camera.half_height = 1.1f;
    for (const int samples : {1, 4, 8, 16}) {
        Settings settings;
        settings.samples = samples;
        std::vector<float> position(3 * kSide * kSide), uv(2 * kSide * kSide), depth(kSide * kSide);
        REQUIRE(render(scene, camera, settings,
                       {.width = kSide, .height = kSide, .depth = depth.data(), .position = position.data(), .uv = uv.data()}));
        double farthest = 0, farthest_uv = 0;
        int seen = 0;
        for (std::size_t i = 0; i < depth.size(); ++i) {
            if (depth[i] == kInf) continue;
            const double pixel = 2.2 / kSide, x = (static_cast<double>(i % kSide) + 0.5) * pixel - 1.1,
                         y = 1.1 - (static_cast<double>(i / kSide) + 0.5) * pixel;
            farthest = std::max(farthest, std::hypot(double{position[3 * i]} - x, double{position[3 * i + 1]} - y) / pixel);
            farthest_uv = std::max(farthest_uv, std::hypot(double{uv[2 * i]} - x, double{uv[2 * i + 1]} - y) / pixel);
            seen += 1;
        }
        CAPTURE(samples);
        CHECK(seen > 500);
        CHECK(farthest < (samples == 1 ? 0.01 : 0.72));
        CHECK(farthest_uv < (samples == 1 ? 0.01 : 0.72));
    }
}

TEST_CASE("planes: depth is the distance of a plane that faces the camera", "[raster][planes]") {
    for (const float distance : {0.11f, 0.5f, 1.0f, 7.25f, 300.0f, 4e4f, 1e7f})
        for (const float far_ratio : {0.0f, 1.5f, 1000.0f})
            for (const int samples : {1, 4, 8, 16}) {
                Scene scene;
                add(scene, square(2 * distance));
                Camera camera;
                camera.world_from_camera = translation({0, 0, distance});
                camera.near_z = 0.1f;
                camera.far_z = far_ratio * distance;
                Settings settings;
                settings.samples = samples;
                const Planes p = planes_of(scene, camera, settings, 40, 30);
                double worst = 0;
                for (const float d : p.depth) worst = std::max(worst, std::fabs(double{d} / double{distance} - 1));
                INFO("distance " << distance << ", far " << camera.far_z << ", samples " << samples);
                CHECK(worst < 5e-7);  // clip z and w, their quotient, and the plane of depths over the window: five roundings
                CHECK(p.instance == std::vector<std::uint32_t>(p.pixels(), 1));
            }
}

TEST_CASE("planes: depth of an orthographic camera is the distance too, and negative behind the eye", "[raster][planes]") {
    for (const float near_z : {-5.0f, 0.0f, 0.5f})
        for (const float far_z : {20.0f, 0.0f}) {  // 0 is a far limit where the near one is negative
            for (const float distance : {-4.0f, 0.75f, 3.0f, 19.0f}) {
                if (distance < near_z || (far_z > near_z && distance > far_z)) continue;
                Scene scene;
                add(scene, square(2));
                Camera camera = halflit::test::camera_flat();
                camera.world_from_camera = translation({0, 0, distance});
                camera.near_z = near_z;
                camera.far_z = far_z;
                const Planes p = planes_of(scene, camera, {}, 20, 20);
                const double range = far_z > near_z ? far_z - near_z : 1000;
                double worst = 0;
                for (const float d : p.depth) worst = std::max(worst, std::fabs(double{d} - double{distance}));
                INFO("distance " << distance << ", near " << near_z << ", far " << far_z);
                CHECK(worst < range * 1.5e-7);  // a float depth between 0 and 1 is a share of the range
            }
        }
}

TEST_CASE("planes: depth by parallel rays does not depend on how far the camera's planes are", "[raster][planes]") {
    for (const double at : {2.5, 1e4})
        for (const float far_z : {0.0f, 1e5f, 1e6f, 1e12f, 1e30f})
            for (const float near_z : {0.1f, -1e6f}) {
                Scene scene;
                add(scene, square(2));
                add(scene, square(1), translation({0, 0, 0.002f}));  // before the other one
                Camera camera = halflit::test::camera_flat();
                camera.world_from_camera = translation({0, 0, static_cast<float>(at)});
                camera.near_z = near_z, camera.far_z = far_z;
                if (near_z < 0.0f && far_z == 0.0f) continue;  // which cuts all
                const Planes p = planes_of(scene, camera, {}, 20, 20);
                INFO("at " << at << ", near " << near_z << ", far " << far_z);
                double worst = 0;
                for (std::size_t i = 0; i < p.pixels(); ++i)
                    worst = std::max(worst, std::fabs(p.depth[i] - (at - (p.instance[i] == 2 ? 0.002 : 0))));
                // float32 of the depth itself, and shares of some 20 units between the planes.
                CHECK(worst < at * 6e-8 + 20 * 1.5e-7);
                CHECK(std::count(p.instance.begin(), p.instance.end(), 2u) == 400);
            }
}

TEST_CASE("planes: the caller's planes cut as before where depths have a range of their own", "[raster][planes]") {
    Scene scene;
    for (int i = 0; i < 4; ++i) add(scene, square(0.3f), translation({static_cast<float>(i) * 0.5f - 0.75f, 0, static_cast<float>(-i)}));
    const auto seen = [&](float near_z, float far_z) {
        Camera camera = halflit::test::camera_flat();
        camera.world_from_camera = translation({0, 0, 1});
        camera.near_z = near_z, camera.far_z = far_z;
        const Planes p = planes_of(scene, camera, {}, 40, 40);
        std::uint32_t instances = 0;
        for (const std::uint32_t one : p.instance) instances |= one > 0 ? 1u << (one - 1) : 0u;
        return instances;
    };
    CHECK(seen(0, 1e7f) == 15);  // their distances are 1, 2, 3 and 4
    CHECK(seen(1.5f, 1e7f) == 14);
    CHECK(seen(-1e7f, 3.5f) == 7);
    CHECK(seen(-1e7f, 0.5f) == 0);
    CHECK(seen(4.5f, 1e7f) == 0);
}

TEST_CASE("planes: what the near plane cuts is named, and nothing else", "[raster][planes]") {
    Scene scene;
    add(scene, square(1), translation({0, 0, -5}));
    Mesh small = make_box({0.05f, 0.05f, 0.05f});
    small.name = "bolt";
    add(scene, std::move(small));
    const auto warnings = [&](Camera camera) {
        std::string all;
        for (const std::string& warning : planes_of(scene, camera, {}, 40, 40).report.warnings) all += warning + "\n";
        return all;
    };
    const auto cuts = [&](const Camera& camera) {
        return warnings(camera).find("near plane cuts 'bolt', instance 1") != std::string::npos;
    };
    Camera camera = camera_at({0, 0, 0.2f}, {0, 0, 0});
    CHECK(!cuts(camera));  // its front is at .15
    camera.near_z = 0.17f;
    CHECK(cuts(camera));
    camera.near_z = 1;  // all of it lies before the plane
    CHECK(cuts(camera));
    camera.near_z = 0;  // chosen
    CHECK(warnings(camera) == "");
    // Beside the picture, behind the camera, and turned away.
    CHECK(!cuts(camera_at({0, 0, 0.2f}, {5, 0, 0.2f}, 0.9f, 1)));
    CHECK(!cuts(camera_at({0, 0, -0.2f}, {0, 0, -1}, 0.9f, 1)));
    CHECK(!cuts(camera_at({0, 0, 0}, {0, 0, -1}, 0.9f, 1)));
    scene.materials[static_cast<std::size_t>(scene.meshes[1].material)].double_sided = true;
    CHECK(cuts(camera_at({0, 0, 0}, {0, 0, -1}, 0.9f, 1)));
    // Parallel rays: where the plane crosses it, wherever the eye is.
    Camera flat = halflit::test::camera_flat();
    CHECK(!cuts(flat));
    flat.near_z = 10;
    CHECK(cuts(flat));
    flat.near_z = 11;
    CHECK(cuts(flat));
    flat.world_from_camera = translation({0, 0, -1});
    flat.near_z = 0;
    CHECK(!cuts(flat));  // it lies behind the eye as a whole
}

TEST_CASE("planes: a near plane of 0 follows the scene", "[raster][planes]") {
    for (const double size : {1e-3, 1.0, 1e4}) {
        Scene scene;
        add(scene, square(static_cast<float>(size)));
        Camera camera = camera_at({0, 0, static_cast<float>(1.5 * size)}, {0, 0, 0}, 0.9f, 0.0f);
        const Planes p = planes_of(scene, camera, {}, 20, 20);
        CHECK(p.instance == std::vector<std::uint32_t>(p.pixels(), 1));
        CHECK(completed(camera, scene_bounds(scene)).near_z == Approx(0.75 * size).epsilon(1e-6));
        camera.near_z = 0.25f;
        CHECK(completed(camera, scene_bounds(scene)).near_z == 0.25f);
    }
    CHECK(completed(Camera{}, Bounds{}).near_z == 0.1f);
    // Beside a box that is much larger than the distance to it.
    Bounds ground;
    ground.add({-1e6f, -1, -1e6f}), ground.add({1e6f, 1, 1e6f});
    CHECK(completed(camera_at({4, 2, 5}, {0, -0.3f, 0}, 0.9f, 0.0f), ground).near_z == 0.25f);
    CHECK(completed(camera_at({4, 0, 5}, {0, -0.3f, 0}, 0.9f, 0.0f), ground).near_z == Approx(1e-4 * double{ground.radius()}));
}

TEST_CASE("planes: depth of a tilted plane is where its view ray meets it", "[raster][planes]") {
    Random random(11);
    for (int trial = 0; trial < 40; ++trial) {
        Scene scene;
        const Vec3f axis{random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)};
        const Mat4 place = translation({1, 2, 3}) * rotation(axis, random.real32(-0.9, 0.9));
        add(scene, square(50), place).double_sided = true;
        Camera camera = camera_at({1, 2, 7}, {1, 2, 3}, 0.8f);
        camera.far_z = trial % 2 == 0 ? 0.0f : 60.0f;
        constexpr int kW = 48, kH = 36;
        const Planes p = planes_of(scene, camera, {}, kW, kH);
        const Vec3d n = wide(place.c[2]);
        double worst = 0;
        int compared = 0;
        for (int y = 0; y < kH; ++y)
            for (int x = 0; x < kW; ++x) {
                const Vec3d ray = ray_of(camera, x, y, kW, kH);
                const double t = dot(wide(place.c[3]) - wide(camera.world_from_camera.c[3]), n) / dot(ray, n);
                const double d = p.depth[p.at(x, y)];
                if (!(t > 0.2 && t < 50)) continue;
                if (!(d < 1e30)) continue;  // beyond the square's edge
                worst = std::max(worst, std::fabs(d / t - 1) / std::max(1.0, t / 4));
                ++compared;
            }
        CHECK(compared > 500);
        // Corners are snapped to 1/256 pixel, up to 300 pixels away from the middle: the plane tilts by that much.
        CHECK(worst < 2e-3);
    }
}

TEST_CASE("planes: where nothing is, depth is infinite, and the rest is 0", "[raster][planes]") {
    Scene scene;
    add(scene, square(0.5f));
    Scene empty;
    for (const int samples : {1, 4, 8, 16})
        for (const int tile : {16, 64}) {
            Settings settings;
            settings.samples = samples;
            const Camera camera = camera_at({0, 0, 3}, {0, 0, 0});
            for (const Scene* s : {&scene, &empty}) {
                const Planes p = planes_of(*s, camera, settings, 90, 70, {.tile_size = tile});
                int seen = 0, wrong = 0;
                for (std::size_t i = 0; i < p.pixels(); ++i) {
                    const bool hit = p.instance[i] != 0;
                    seen += hit;
                    const bool nothing = p.depth[i] == kInf && p.triangle[i] == 0 && p.normal[3 * i] == 0 && p.normal[3 * i + 1] == 0 &&
                                         p.normal[3 * i + 2] == 0 && p.barycentric[2 * i] == 0 && p.barycentric[2 * i + 1] == 0 &&
                                         p.uv[2 * i] == 0 && p.uv[2 * i + 1] == 0;
                    const bool something = p.instance[i] == 1 && (p.triangle[i] == 1 || p.triangle[i] == 2) &&
                                           std::fabs(double{p.depth[i]} - 3) < 1e-5 && p.normal_at(i) == Vec3d{0, 0, 1};
                    wrong += hit ? !something : !nothing;
                }
                CHECK(wrong == 0);
                CHECK((s == &scene ? seen > 100 && seen < 3000 : seen == 0));
            }
        }
}

TEST_CASE("planes: numbers and depths are those of a ray cast", "[raster][planes]") {
    const Street street;
    const std::vector<Corners> triangles = triangles_of(street.scene);
    constexpr int kW = 150, kH = 100;
    const Planes p = planes_of(street.scene, street.camera, {}, kW, kH);
    const Vec3d eye = wide(street.camera.world_from_camera.c[3]);
    int wrong = 0, other = 0, seen = 0;
    std::vector<bool> met(street.scene.instances.size());
    for (int y = 0; y < kH; ++y)
        for (int x = 0; x < kW; ++x) {
            const Vec3d ray = ray_of(street.camera, x, y, kW, kH);
            const Corners* nearest = nullptr;
            Hit best, claimed;
            const std::size_t i = p.at(x, y);
            for (const Corners& c : triangles) {
                const Hit h = hit_of(c, eye, ray);
                if (c.instance + 1 == p.instance[i] && c.triangle + 1 == p.triangle[i]) claimed = h;
                if (h.inside >= 0 && h.distance >= double{street.camera.near_z} && h.distance < best.distance) best = h, nearest = &c;
            }
            if (nearest == nullptr) {
                wrong += p.instance[i] != 0;
                continue;
            }
            ++seen;
            if (p.instance[i] == nearest->instance + 1 && p.triangle[i] == nearest->triangle + 1) {
                met[nearest->instance] = true;
                // Far out, the floor is so oblique that 1/256 pixel is a long way.
                wrong += !(std::fabs(double{p.depth[i]} / best.distance - 1) < 0.004 * std::max(1.0, best.distance));
            } else {
                ++other;  // only at an edge: within a sliver of the triangle that the plane names
                wrong += p.instance[i] != 0 && !(claimed.inside > -0.05);
            }
        }
    CHECK(wrong == 0);
    CHECK(seen > 8000);
    CHECK(other < seen / 50);
    CHECK(std::count(met.begin(), met.end(), true) >= 6);
}

TEST_CASE("planes: numbers are those of the visibility view, clipped triangles included", "[raster][planes]") {
    const Street street;
    std::vector<NamedScene> scenes = raster::test::all_scenes();
    scenes.push_back({"street", street.scene, street.camera});
    for (const NamedScene& s : scenes)
        for (const int samples : {1, 4, 8, 16}) {
            constexpr int kW = 120, kH = 90;
            Settings settings;
            settings.samples = samples;
            settings.shadow_size = 64;
            const Planes p = planes_of(s.scene, s.camera, settings, kW, kH);
            const auto view = raster::visibility(s.scene, s.camera, settings, kW, kH);
            REQUIRE(view);
            std::vector<std::uint32_t> first{0};  // submission number of each instance's first triangle
            for (const Instance& i : s.scene.instances)
                first.push_back(first.back() +
                                static_cast<std::uint32_t>(s.scene.meshes[static_cast<std::size_t>(i.mesh)].indices.size() / 3));
            int wrong = 0, seen = 0;
            for (std::size_t i = 0; i < p.pixels(); ++i) {
                const bool hit = view->triangle[i] != 0;
                seen += hit;
                wrong += hit != (p.instance[i] != 0) || hit != (p.triangle[i] != 0) || hit != (p.depth[i] < kInf);
                if (hit && p.instance[i] != 0)
                    wrong += first[p.instance[i] - 1] + p.triangle[i] != view->triangle[i] ||
                             p.triangle[i] > first[p.instance[i]] - first[p.instance[i] - 1];
            }
            INFO(s.name << ", samples " << samples);
            CHECK(wrong == 0);
            CHECK(seen > 500);
        }
}

TEST_CASE("planes: normals of a sphere point away from its centre", "[raster][planes]") {
    Scene scene;
    add(scene, make_sphere(1, 128, 64), translation({0.5f, 0, 0}));
    const Camera camera = camera_at({0.5f, 0.4f, 4}, {0.5f, 0, 0}, 0.6f);
    constexpr int kW = 90, kH = 90;
    const Planes p = planes_of(scene, camera, {}, kW, kH);
    double worst = 0, longest = 0, away = -1;
    int seen = 0;
    for (int y = 0; y < kH; ++y)
        for (int x = 0; x < kW; ++x) {
            const std::size_t i = p.at(x, y);
            if (p.instance[i] == 0) continue;
            ++seen;
            const Vec3d ray = ray_of(camera, x, y, kW, kH), n = p.normal_at(i);
            const Vec3d hit = wide(camera.world_from_camera.c[3]) + ray * double{p.depth[i]};
            worst = std::max(worst, length(n - unit(hit - Vec3d{0.5, 0, 0})));
            longest = std::max(longest, std::fabs(length(n) - 1));
            away = std::max(away, dot(n, unit(ray)));
        }
    CHECK(seen > 3000);
    CHECK(longest < 2e-7);
    CHECK(worst < 0.02);  // at the silhouette a ray through the facet leaves the sphere by 1e-3, and the normal turns by that over cos
    CHECK(away < 0.05);   // interpolated normals of silhouette facets may turn a little away
}

TEST_CASE("planes: normals follow uneven scales and mirrors as the surface does", "[raster][planes]") {
    for (const Vec3f scale : {Vec3f{1, 1, 1}, Vec3f{3, 0.5f, 2}, Vec3f{-1, 1, 1}, Vec3f{2, -0.3f, 1}}) {
        Scene scene;
        const Mat4 place = rotation({1, 2, 3}, 0.7f) * scaling(scale);
        // A plane through three corners, whose normal is computed from them before and after the transform.
        Mesh m;
        m.positions = {{-1, -1, 0.4f}, {1.5f, -0.8f, 0}, {0.1f, 1.2f, -0.3f}};
        const Vec3f n = normalize_or(cross(m.positions[1] - m.positions[0], m.positions[2] - m.positions[0]), {});
        m.normals.assign(3, n * 3.7f);
        m.indices = {0, 1, 2};
        add(scene, m, place).double_sided = true;
        Vec3d c[3];
        for (std::size_t k = 0; k < 3; ++k) c[k] = wide(place * Vec4f{m.positions[k].x, m.positions[k].y, m.positions[k].z, 1});
        const Vec3d face = unit(cross(c[1] - c[0], c[2] - c[0]));
        for (const double side : {1.0, -1.0}) {
            const Vec3d middle = (c[0] + c[1] + c[2]) * (1.0 / 3), from = middle + face * (5 * side);
            const auto narrow = [](Vec3d v) { return Vec3f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; };
            const Camera camera = camera_at(narrow(from), narrow(middle), 0.6f);
            const Planes p = planes_of(scene, camera, {}, 33, 33);
            REQUIRE(p.instance[p.at(16, 16)] == 1);
            CHECK(length(p.normal_at(p.at(16, 16)) - face * side) < 1e-6);  // towards the viewer, from either side
        }
    }
}

TEST_CASE("planes: they are the same for every way of shading", "[raster][planes]") {
    std::vector<NamedScene> scenes{
        raster::test::materials_scene(), raster::test::layers_scene(), {"street", Street().scene, Street().camera}};
    for (const NamedScene& s : scenes) {
        constexpr int kW = 110, kH = 80;
        Settings settings;
        settings.shadow_size = 64;
        for (const int samples : {1, 4}) {
            settings.samples = samples;
            settings.shading = {};
            settings.shadows = ShadowMode::soft_split;
            const Planes first = planes_of(s.scene, s.camera, settings, kW, kH);
            double longest = 0;
            for (std::size_t i = 0; i < first.pixels(); ++i) {
                if (first.instance[i] == 0) continue;
                const Mesh& mesh = s.scene.meshes[static_cast<std::size_t>(s.scene.instances[first.instance[i] - 1].mesh)];
                longest = std::max(longest, std::fabs(length(first.normal_at(i)) - (mesh.normals.empty() ? 0 : 1)));
            }
            CHECK(longest < 3e-7);
            const auto check = [&](const char* what, const Scene& scene) {
                INFO(s.name << ", samples " << samples << ", " << what);
                CHECK(planes_of(scene, s.camera, settings, kW, kH) == first);
            };
            settings.shading.rate = ShadingRate::gouraud;
            check("gouraud", s.scene);
            settings.shading.rate = ShadingRate::flat;
            check("flat", s.scene);
            settings.shading.rate = ShadingRate::pixel;
            settings.shading.accuracy = Accuracy::reference;
            check("reference", s.scene);
            settings.shading.accuracy = Accuracy::exact;
            settings.shading.specular = SpecularModel::none;
            settings.shadows = ShadowMode::off;
            check("matte", s.scene);
            Scene other = s.scene;
            for (Material& m : other.materials) m.unlit = true;
            check("unlit", other);
            other = s.scene;
            other.lights.clear();
            other.ambient = {};
            check("dark", other);
        }
    }
}

TEST_CASE("planes: a mesh without normals has none", "[raster][planes]") {
    Scene scene;
    Mesh m = square(1);
    m.normals.clear();
    add(scene, m);
    const Planes p = planes_of(scene, camera_at({0, 0, 3}, {0, 0, 0}), {}, 20, 20);
    CHECK(p.instance[p.at(10, 10)] == 1);
    CHECK(p.normal == std::vector<float>(3 * p.pixels(), 0.0f));
}

TEST_CASE("planes: masked surfaces count where they are, and blended ones nowhere", "[raster][planes]") {
    Scene scene;
    add(scene, square(3), translation({0, 0, -1}));
    Material& fence = add(scene, square(1));
    fence.alpha_mode = AlphaMode::mask;
    fence.unlit = true;
    // Four columns: the first and the third are there.
    const std::vector<std::uint8_t> rgba{255, 255, 255, 255, 0, 0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 0};
    scene.textures.push_back(Texture::from_rgba8(rgba, 4, 1, ColorSpace::linear).value());
    fence.textures[TextureSlot::base_color].texture = 0;
    fence.textures[TextureSlot::base_color].sampler = {TextureWrap::clamp, TextureWrap::clamp, TextureFilter::nearest,
                                                       TextureFilter::nearest, MipFilter::none};
    Material& glass = add(scene, square(2), translation({0, 0, 1}));
    glass.alpha_mode = AlphaMode::blend;
    glass.base_color.w = 0.5f;
    for (const int samples : {1, 4}) {
        Settings settings;
        settings.samples = samples;
        Camera camera = halflit::test::camera_flat();
        const Planes p = planes_of(scene, camera, settings, 64, 64);
        int wrong = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const std::size_t i = p.at(x, y);
                const bool there = x / 16 % 2 == 0;
                wrong += p.instance[i] != (there ? 2u : 1u) || !(std::fabs(double{p.depth[i]} - (there ? 10 : 11)) < 1e-4);
            }
        CHECK(wrong == 0);
    }
}

TEST_CASE("planes: they do not change the colours, nor colours them", "[raster][planes]") {
    for (const NamedScene& s : raster::test::all_scenes())
        for (const int samples : {1, 4})
            for (const ShadingRate rate : {ShadingRate::pixel, ShadingRate::gouraud, ShadingRate::flat}) {
                Settings settings;
                settings.samples = samples;
                settings.shadow_size = 64;
                settings.shading.rate = rate;
                settings.background_linear = {0.1f, 0.2f, 0.3f, 0.5f};
                Planes both(80, 60), bare(80, 60);
                const auto with = render(s.scene, s.camera, settings, both.target(true));
                const auto without = render(s.scene, s.camera, settings, {.width = 80, .height = 60, .pixels = bare.codes.data()});
                REQUIRE(with);
                REQUIRE(without);
                INFO(s.name << ", samples " << samples << ", rate " << static_cast<int>(rate));
                CHECK(both.codes == bare.codes);
                CHECK(with->work == without->work);
                CHECK(with->nan_pixels == without->nan_pixels);
                CHECK(with->fragments_shaded == without->fragments_shaded);
                CHECK(both == planes_of(s.scene, s.camera, settings, 80, 60));
            }
}

TEST_CASE("planes: a Renderer gives each plane whichever it drew before", "[raster][planes]") {
    const Street street;
    const PreparedScene prepared = PreparedScene::make(street.scene).value();
    for (const ShadingRate rate : {ShadingRate::pixel, ShadingRate::gouraud}) {
        Settings settings;
        settings.shading.rate = rate;
        const Planes wanted = planes_of(street.scene, street.camera, settings, 100, 70);
        Planes colour(100, 70);
        REQUIRE(render(street.scene, street.camera, settings, {.width = 100, .height = 70, .pixels = colour.codes.data()}));
        Random random(17);
        Renderer renderer;
        for (int frame = 0; frame < 24; ++frame) {
            Planes p(100, 70);
            Target target = p.target(random.chance(0.5));
            const auto drop = [&](auto& plane, auto& memory, const auto& expected) {
                if (!random.chance(0.5)) return;
                plane = nullptr;
                memory = expected;
            };
            drop(target.depth, p.depth, wanted.depth);
            drop(target.normal, p.normal, wanted.normal);
            drop(target.instance, p.instance, wanted.instance);
            const bool is_numbered = frame != 0 && random.chance(0.5);  // the first frame is not, so that the second changes what is kept
            if (!is_numbered) {
                target.triangle = nullptr, target.barycentric = nullptr, target.uv = nullptr;
                p.triangle = wanted.triangle, p.barycentric = wanted.barycentric, p.uv = wanted.uv;
            }
            drop(target.triangle, p.triangle, wanted.triangle);
            drop(target.barycentric, p.barycentric, wanted.barycentric);
            drop(target.uv, p.uv, wanted.uv);
            if (frame == 9) renderer.forget_frames();
            REQUIRE(renderer.render(prepared, street.camera, settings, target));
            CHECK(p == wanted);
            if (target.pixels != nullptr) CHECK(p.codes == colour.codes);
        }
    }
}

TEST_CASE("planes: normals follow materials that become double-sided", "[raster][planes]") {
    Scene scene;
    add(scene, square(1)).double_sided = true;
    add(scene, square(1));
    scene.meshes[0].material = 0;
    scene.instances.pop_back();
    auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    Renderer renderer;
    const Camera behind = camera_at({0, 0, -3}, {0, 0, 0});
    for (const bool both : {true, false, true}) {
        scene.materials[0].double_sided = both;
        REQUIRE(prepared->update({.materials = true}));
        Planes p(20, 20);
        REQUIRE(renderer.render(*prepared, behind, {}, p.target()));
        CHECK(p.instance[p.at(10, 10)] == (both ? 1u : 0u));
        CHECK(p.normal_at(p.at(10, 10)) == Vec3d{0, 0, both ? -1.0 : 0.0});
    }
}

TEST_CASE("planes: a region is the same part of the whole, in either layout, with padded rows", "[raster][planes]") {
    const Street street;
    constexpr int kW = 100, kH = 70;
    for (const int samples : {1, 16}) {
        Settings settings;
        settings.samples = samples;
        const Planes whole = planes_of(street.scene, street.camera, settings, kW, kH);
        for (const Region r : {Region{0, 0, 1, 1}, Region{13, 20, 70, 41}, Region{99, 69, 1, 1}, Region{0, 40, 100, 3}})
            for (const bool alone : {false, true})
                for (const std::size_t padding : {std::size_t{0}, std::size_t{12}}) {
                    INFO("region " << r.x << "," << r.y << "," << r.width << "," << r.height << ", alone " << alone << ", padding "
                                   << padding);
                    settings.region = r;
                    const auto columns = static_cast<std::size_t>(alone ? r.width : kW),
                               rows = static_cast<std::size_t>(alone ? r.height : kH);
                    int wrong = 0;
                    const auto check = [&](auto Target::*plane, std::size_t Target::*stride, const auto& expected, std::size_t channels) {
                        using T = std::remove_cvref_t<decltype(expected[0])>;
                        const std::size_t row = channels * columns + padding / 4;
                        std::vector<T> memory(row * rows + 16, T(77));
                        Target target{.width = kW, .height = kH, .region_alone = alone};
                        target.*plane = memory.data();
                        target.*stride = padding == 0 ? 0 : row * sizeof(T);
                        REQUIRE(render(street.scene, street.camera, settings, target));
                        std::vector<T> want(memory.size(), T(77));
                        for (int y = r.y; y < r.y + r.height; ++y)
                            for (std::size_t k = 0; k < channels * static_cast<std::size_t>(r.width); ++k)
                                want[static_cast<std::size_t>(alone ? y - r.y : y) * row +
                                     channels * static_cast<std::size_t>(alone ? 0 : r.x) + k] = expected[channels * whole.at(r.x, y) + k];
                        wrong += std::memcmp(memory.data(), want.data(), memory.size() * sizeof(T)) != 0;
                    };
                    check(&Target::depth, &Target::depth_row_bytes, whole.depth, 1);
                    check(&Target::normal, &Target::normal_row_bytes, whole.normal, 3);
                    check(&Target::instance, &Target::instance_row_bytes, whole.instance, 1);
                    check(&Target::triangle, &Target::triangle_row_bytes, whole.triangle, 1);
                    check(&Target::barycentric, &Target::barycentric_row_bytes, whole.barycentric, 2);
                    check(&Target::uv, &Target::uv_row_bytes, whole.uv, 2);
                    CHECK(wrong == 0);
                }
        settings.region = {};
    }
}

TEST_CASE("planes: every instruction set, tile size and number of threads gives the same bits", "[raster][planes]") {
    for (const NamedScene& s : raster::test::all_scenes()) {
        Settings settings;
        settings.shadow_size = 64;
        const Planes first = planes_of(s.scene, s.camera, settings, 120, 80, {.threads = 1, .tile_size = 64, .isa = Isa::scalar});
        int tile = 16, threads = 1;
        for (const Isa isa : available_isas())
            for (int i = 0; i < 2; ++i) {
                INFO(s.name << ", " << isa_name(isa) << ", tile " << tile << ", threads " << threads);
                CHECK(planes_of(s.scene, s.camera, settings, 120, 80, {.threads = threads, .tile_size = tile, .isa = isa}) == first);
                tile = tile == 64 ? 16 : 2 * tile;
                threads = threads % 3 + 1;
            }
    }
}
