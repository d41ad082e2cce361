// Barycentric weights, texture coordinates, and the planes that follow from others: against rays and projections in float64.
#include "halflit/fragment_planes.hpp"

#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/random.hpp"

#include <array>
#include <cmath>
#include <limits>

using namespace halflit;
using halflit::test::camera_at;
using halflit::test::camera_flat;
using halflit::test::Random;

namespace {

constexpr int kW = 120, kH = 90;

struct Points {
    std::vector<float> depth, normal, barycentric, uv;
    std::vector<std::uint32_t> instance, triangle;

    Points(const Scene& scene, const Camera& camera, const Settings& settings = {}, int width = kW, int height = kH) {
        const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        depth.resize(pixels), normal.resize(3 * pixels), barycentric.resize(2 * pixels), uv.resize(2 * pixels);
        instance.resize(pixels), triangle.resize(pixels);
        const auto drawn = render(scene, camera, settings,
                                  {.width = width,
                                   .height = height,
                                   .depth = depth.data(),
                                   .normal = normal.data(),
                                   .instance = instance.data(),
                                   .triangle = triangle.data(),
                                   .barycentric = barycentric.data(),
                                   .uv = uv.data()});
        INFO((drawn ? std::string() : drawn.error().message));
        REQUIRE(drawn);
    }
    [[nodiscard]] SeenPoints seen() const { return {instance, triangle, barycentric}; }
};

Vec3d wide(Vec4f v) { return {v.x, v.y, v.z}; }

/// A mesh with texture coordinates that no formula of its positions gives.
Mesh with_random_uv(Mesh mesh, std::uint64_t seed) {
    Random random(seed);
    mesh.uv0.resize(mesh.positions.size());
    for (Vec2f& uv : mesh.uv0) uv = {random.real32(-3, 3), random.real32(-3, 3)};
    return mesh;
}

void add(Scene& scene, Mesh mesh, const Mat4& place = {}, bool double_sided = false) {
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.emplace_back().double_sided = double_sided;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, place});
}

/// A floor that the near plane and the guard band cut, a mirrored sphere, a turned box, and a sheet seen from behind.
Scene street() {
    Scene scene;
    add(scene, with_random_uv(make_plane(400, 3), 1));
    add(scene, with_random_uv(make_sphere(0.8f, 12, 8), 2), translation({1, 0.8f, -2}) * scaling({-1, 1, 0.7f}));
    add(scene, with_random_uv(make_box({0.4f, 0.5f, 0.3f}), 3), translation({-1.2f, 0.5f, -1}) * rotation({0, 1, 0}, 0.6f));
    add(scene, with_random_uv(make_plane(0.7f, 1), 4), translation({-0.4f, 1.7f, -3}) * rotation({1, 0, 0}, -1.3f), true);
    return scene;
}

/// Corners of a triangle in the world, by the numbers of the planes.
std::array<Vec3d, 3> corners_of(const Scene& scene, std::uint32_t instance, std::uint32_t triangle) {
    const Instance& of = scene.instances[instance - 1];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(of.mesh)];
    std::array<Vec3d, 3> out;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f p = mesh.positions[mesh.indices[3 * (triangle - 1) + k]];
        const Mat4& m = of.world_from_object;
        out[k] = wide(m.c[0]) * double{p.x} + wide(m.c[1]) * double{p.y} + wide(m.c[2]) * double{p.z} + wide(m.c[3]);
    }
    return out;
}

/// View ray through the middle of a pixel, of length 1 along the view axis. The camera's aspect is the picture's.
Vec3d ray_of(const Camera& camera, int x, int y) {
    const double t = std::tan(0.5 * double{camera.fov_y_rad}), sx = (2 * (x + 0.5) / kW - 1) * t * kW / kH,
                 sy = (1 - 2 * (y + 0.5) / kH) * t;
    return wide(camera.world_from_camera.c[0]) * sx + wide(camera.world_from_camera.c[1]) * sy - wide(camera.world_from_camera.c[2]);
}

/// Pixels from the upper left corner, by the camera's angles.
std::array<double, 2> projected(const Camera& camera, Vec3d p) {
    const Vec3d to = p - wide(camera.world_from_camera.c[3]);
    const double t = std::tan(0.5 * double{camera.fov_y_rad}), z = -dot(wide(camera.world_from_camera.c[2]), to);
    return {0.5 * kW * (1 + dot(wide(camera.world_from_camera.c[0]), to) / (z * t * kW / kH)),
            0.5 * kH * (1 - dot(wide(camera.world_from_camera.c[1]), to) / (z * t))};
}

}  // namespace

TEST_CASE("fragment planes: weights and texture coordinates are those of the ray through the pixel's centre", "[raster][planes]") {
    const Scene scene = street();
    const Camera camera = camera_at({0.3f, 1.1f, 2}, {0, 0.6f, -4}, 1.1f, 0.3f);
    const Points p(scene, camera);
    const Vec3d eye = wide(camera.world_from_camera.c[3]);
    int compared = 0, wrong = 0, wrong_uv = 0;
    std::array<int, 4> met{};
    for (int y = 0; y < kH; ++y)
        for (int x = 0; x < kW; ++x) {
            const auto i = static_cast<std::size_t>(y * kW + x);
            if (p.instance[i] == 0) continue;
            const auto c = corners_of(scene, p.instance[i], p.triangle[i]);
            const Vec3d e1 = c[1] - c[0], e2 = c[2] - c[0], n = cross(e1, e2), ray = ray_of(camera, x, y);
            const double t = dot(c[0] - eye, n) / dot(ray, n);
            const Vec3d at = eye + ray * t - c[0];
            const double u = dot(cross(at, e2), n) / dot(n, n), v = dot(cross(e1, at), n) / dot(n, n);
            const double b1 = p.barycentric[2 * i], b2 = p.barycentric[2 * i + 1];
            // Corners are whole 1/256 pixels: they move the point by that over the triangle's altitudes, more where the view is oblique.
            const double altitude = length(n) / std::max({length(e1), length(e2), length(e2 - e1)});
            const double pixel = t * 2 * std::tan(0.55) / kH, slant = length(ray) * length(n) / std::abs(dot(ray, n));
            const double tolerance = 1e-5 + 2 * pixel / 256 * slant / altitude;
            wrong += !(std::abs(b1 - u) < tolerance && std::abs(b2 - v) < tolerance);
            wrong += !(b1 >= 0 && b2 >= 0 && b1 + b2 <= 1 + 1e-7);
            const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[p.instance[i] - 1].mesh)];
            const double weight[3] = {1 - b1 - b2, b1, b2};
            double wu = 0, wv = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec2f uv = mesh.uv0[mesh.indices[3 * (p.triangle[i] - 1) + k]];
                wu += weight[k] * double{uv.x}, wv += weight[k] * double{uv.y};
            }
            wrong_uv += !(std::abs(wu - double{p.uv[2 * i]}) < 2e-6 && std::abs(wv - double{p.uv[2 * i + 1]}) < 2e-6);
            ++met[p.instance[i] - 1];
            ++compared;
        }
    CHECK(wrong == 0);
    CHECK(wrong_uv == 0);
    CHECK(compared > 5000);
    for (const int pixels : met) CHECK(pixels > 50);
}

TEST_CASE("fragment planes: of a pixel whose centre the triangle misses, weights stay between 0 and 1", "[raster][planes]") {
    Settings settings;
    settings.samples = 16;
    Scene scene;
    add(scene, with_random_uv(make_sphere(0.9f, 40, 30), 5));
    const Points p(scene, camera_flat(), settings);
    int edges = 0, wrong = 0;
    for (std::size_t i = 0; i < p.instance.size(); ++i) {
        const float b1 = p.barycentric[2 * i], b2 = p.barycentric[2 * i + 1];
        wrong += !(b1 >= 0 && b1 <= 1 && b2 >= 0 && b2 <= 1 && double{b1} + double{b2} <= 1 + 1.2e-7);
        edges += p.instance[i] != 0 && (b1 == 0 || b2 == 0 || double{b1} + double{b2} >= 1);
    }
    CHECK(wrong == 0);
    CHECK(edges > 20);
}

TEST_CASE("fragment planes: a line has the weight of its second end, and a point has none", "[raster][planes]") {
    Scene scene;
    Mesh line;
    line.topology = Topology::lines;
    line.positions = {{-0.75f, 0.3f, 0}, {0.75f, 0.3f, 0}};
    line.normals.assign(2, {0, 0, 1});
    line.uv0 = {{2, 0}, {4, 1}};
    line.indices = {1, 0};
    add(scene, line);
    Mesh dots = line;
    dots.topology = Topology::points;
    dots.positions = {{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}};
    add(scene, dots);
    Settings settings;
    settings.line_width = 4, settings.point_size = 6;
    const Points p(scene, camera_flat(), settings);
    int lines = 0, points = 0, wrong = 0;
    for (int y = 0; y < kH; ++y)
        for (int x = 0; x < kW; ++x) {
            const auto i = static_cast<std::size_t>(y * kW + x);
            if (p.instance[i] == 0) continue;
            const double along = (0.75 - (2 * (x + 0.5) / kW - 1) * kW / kH) / 1.5;  // of the first vertex, which is the second end
            const bool is_line = p.instance[i] == 1;
            lines += is_line, points += !is_line;
            const double b = is_line ? along : 0.0, u = is_line ? 4 - 2 * along : p.triangle[i] == 1 ? 4.0 : 2.0;
            wrong += !(std::abs(double{p.barycentric[2 * i]} - b) < 1e-3 && p.barycentric[2 * i + 1] == 0);
            wrong += !(std::abs(double{p.uv[2 * i]} - u) < 2e-3);
        }
    CHECK(wrong == 0);
    CHECK(lines > 200);
    CHECK(points > 40);
}

TEST_CASE("fragment planes: a mesh without texture coordinates has 0", "[raster][planes]") {
    Scene scene;
    Mesh mesh = make_sphere(0.8f, 12, 8);
    mesh.uv0.clear();
    add(scene, std::move(mesh));
    const Points p(scene, camera_flat());
    CHECK(p.instance[kW * kH / 2 + kW / 2] == 1);
    CHECK(p.uv == std::vector<float>(p.uv.size(), 0.0f));
    CHECK(p.barycentric != std::vector<float>(p.uv.size(), 0.0f));
}

TEST_CASE("fragment planes: the distance along the ray is that of the point from the eye", "[raster][planes]") {
    // A sphere around the eye: its distance is the radius, whatever the direction.
    Scene scene;
    add(scene, make_sphere(5, 400, 300), {}, true);
    Camera camera = camera_at({0, 0, 0}, {1, 0.2f, -1}, 1.4f);
    for (const bool off_axis : {false, true}) {
        if (off_axis) camera.sides = ViewSides{-0.3f, 1.2f, -0.9f, 0.4f};
        Points p(scene, camera);
        REQUIRE(make_ray_distances(camera, {kW, kH}, {}, p.depth));
        double least = 1e9, most = 0;
        for (const float d : p.depth) least = std::min(least, double{d}), most = std::max(most, double{d});
        CHECK(least > 4.999);  // chords of 1/300 of half the circle
        CHECK(most < 5.0001);
        // A region alone is the same part of it.
        const Region part{30, 20, 40, 10};
        Settings settings;
        settings.region = part;
        std::vector<float> depth(400);
        REQUIRE(render(scene, camera, settings, {.width = kW, .height = kH, .region_alone = true, .depth = depth.data()}));
        REQUIRE(make_ray_distances(camera, {kW, kH}, part, depth));
        for (std::size_t y = 0; y < 10; ++y)
            for (std::size_t x = 0; x < 40; ++x) REQUIRE(depth[40 * y + x] == p.depth[kW * (20 + y) + 30 + x]);
    }
    std::vector<float> flat(kW * kH, 3.0f);
    flat[7] = std::numeric_limits<float>::infinity();
    const std::vector<float> before = flat;
    REQUIRE(make_ray_distances(camera_flat(), {kW, kH}, {}, flat));
    CHECK(flat == before);
    REQUIRE(make_ray_distances(camera, {kW, kH}, {}, flat));
    CHECK(flat[7] == std::numeric_limits<float>::infinity());
    CHECK(!make_ray_distances(camera, {kW, kH}, {}, std::span(flat).first(5)));
    CHECK(!make_ray_distances(camera, {kW, kH}, {100, 0, 30, 1}, std::span(flat).first(30)));
    CHECK(!make_ray_distances(camera, {0, 0}, {}, {}));
}

TEST_CASE("fragment planes: normals of the view are those of the world, turned into the camera's space", "[raster][planes]") {
    Scene scene;
    add(scene, make_sphere(1, 64, 32));
    const Camera camera = camera_at({2, 3, 4}, {0, 0, 0}, 0.5f);
    Points p(scene, camera);
    const std::vector<float> world = p.normal;
    REQUIRE(make_view_normals(camera, p.normal));
    int away = 0, seen = 0, wrong = 0;
    for (std::size_t i = 0; i < p.instance.size(); ++i) {
        const Vec3d n{p.normal[3 * i], p.normal[3 * i + 1], p.normal[3 * i + 2]};
        const Vec3d back = wide(camera.world_from_camera.c[0]) * n.x + wide(camera.world_from_camera.c[1]) * n.y +
                           wide(camera.world_from_camera.c[2]) * n.z;
        wrong += !(length(back - Vec3d{world[3 * i], world[3 * i + 1], world[3 * i + 2]}) < 5e-7);
        seen += p.instance[i] != 0;
        away += p.instance[i] != 0 && n.z < -0.1;
    }
    CHECK(wrong == 0);
    CHECK(away == 0);
    CHECK(seen > 1000);
    CHECK(!make_view_normals(camera, std::span(p.normal).first(4)));
}

TEST_CASE("fragment planes: numbers of meshes and materials are the instance's, whose own material comes first", "[raster][planes]") {
    Scene scene;
    for (int i = 0; i < 3; ++i) add(scene, make_box({1, 1, 1}));
    scene.meshes[2].material = -1;
    scene.instances = {{2, {}}, {0, {}}, {0, {}, 1}, {2, {}, 2}};
    std::vector<std::uint32_t> meshes{0, 1, 2, 3, 4, 5, 0xffffffffu}, materials = meshes;
    make_mesh_numbers(scene, meshes);
    make_material_numbers(scene, materials);
    CHECK(meshes == std::vector<std::uint32_t>{0, 3, 1, 1, 3, 0, 0});
    CHECK(materials == std::vector<std::uint32_t>{0, 0, 1, 2, 3, 0, 0});
}

TEST_CASE("fragment planes: motion is where the point is in the other picture", "[raster][planes]") {
    const Scene scene = street();
    const Camera camera = camera_at({0.3f, 1.1f, 2}, {0, 0.6f, -4}, 1.1f, 0.3f),
                 turned = camera_at({0.6f, 1.3f, 2.2f}, {0.3f, 0.4f, -4}, 1.0f);
    Scene moved = scene;
    moved.instances[1].world_from_object = translation({0.3f, 0, -0.2f}) * scene.instances[1].world_from_object;
    const Points p(scene, camera);
    std::vector<float> motion(2 * p.instance.size(), 7.0f);
    const std::vector<float> still(motion.size(), 0.0f);
    REQUIRE(make_motion({scene, camera}, {scene, camera}, {kW, kH}, p.seen(), motion));
    CHECK(motion == still);
    REQUIRE(make_motion({scene, camera}, {moved, turned}, {kW, kH}, p.seen(), motion));
    int wrong = 0, compared = 0;
    for (std::size_t i = 0; i < p.instance.size(); ++i) {
        if (p.instance[i] == 0) {
            wrong += motion[2 * i] != 0 || motion[2 * i + 1] != 0;
            continue;
        }
        const auto a = corners_of(scene, p.instance[i], p.triangle[i]), b = corners_of(moved, p.instance[i], p.triangle[i]);
        const double b1 = p.barycentric[2 * i], b2 = p.barycentric[2 * i + 1];
        const auto at = [&](const auto& c) { return c[0] * (1 - b1 - b2) + c[1] * b1 + c[2] * b2; };
        const auto from = projected(camera, at(a)), to = projected(turned, at(b));
        // The projection's matrix is of floats; the floor's corners are 400 units away.
        wrong +=
            !(std::abs(to[0] - from[0] - double{motion[2 * i]}) < 0.02 && std::abs(to[1] - from[1] - double{motion[2 * i + 1]}) < 0.02);
        ++compared;
    }
    CHECK(wrong == 0);
    CHECK(compared > 5000);
    // A point behind the other camera has no place in its picture.
    REQUIRE(make_motion({scene, camera}, {scene, camera_at({0, 1, -500}, {0, 1, -600})}, {kW, kH}, p.seen(), motion));
    CHECK(motion == still);
    Scene without = scene;
    without.meshes.clear();
    REQUIRE(make_motion({scene, camera}, {without, turned}, {kW, kH}, p.seen(), motion));
    CHECK(motion == still);
    CHECK(!make_motion({scene, camera}, {scene, camera}, {kW, kH}, p.seen(), std::span(motion).first(2)));
}

TEST_CASE("fragment planes: triangles beyond 65,535 have their own numbers", "[raster][planes]") {
    Scene scene;
    add(scene, make_sphere(0.95f, 600, 400));
    const Points p(scene, camera_flat(), {}, 300, 300);
    std::uint32_t most = 0;
    int wrong = 0;
    for (std::size_t i = 0; i < p.instance.size(); ++i) {
        most = std::max(most, p.triangle[i]);
        if (p.instance[i] == 0) continue;
        const auto c = corners_of(scene, p.instance[i], p.triangle[i]);
        const double b1 = p.barycentric[2 * i], b2 = p.barycentric[2 * i + 1];
        const Vec3d at = c[0] * (1 - b1 - b2) + c[1] * b1 + c[2] * b2;
        const double x = 2 * (static_cast<double>(i % 300) + 0.5) / 300 - 1, y = 1 - 2 * (static_cast<double>(i / 300) + 0.5) / 300;
        wrong += !(std::abs(at.x - x) < 1e-4 && std::abs(at.y - y) < 1e-4);  // 1/256 of a pixel of 1/150
    }
    CHECK(wrong == 0);
    CHECK(most > 65535);
}
