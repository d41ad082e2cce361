// Rays against a scene's triangles, compared with all triangles one by one.
#include "raster/explain/ray_hits.hpp"
#include "halflit/shapes.hpp"
#include "raster/view/projection.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"
#include "tests/support/cameras.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace halflit;
using namespace halflit::raster;

namespace {

using Vec3l = Vec3<long double>;
Vec3l wide(Vec3d v) { return {v.x, v.y, v.z}; }

struct Expected {
    long double distance;
    std::size_t instance, triangle;
};

/// Hits by the plane of each triangle and its three edges. Those nearer than 1e-6 to an edge are counted as doubtful.
std::vector<Expected> by_all(const Scene& scene, const Ray& ray, bool casters, int& doubtful) {
    std::vector<Expected> found;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
        if (casters && material.is_layer()) continue;
        const bool mirrored = determinant3(instance.world_from_object) < 0;
        for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
            Vec3l p[3];
            for (std::size_t k = 0; k < 3; ++k)
                p[k] = wide(to_double(transform_point(instance.world_from_object, mesh.positions[mesh.indices[3 * t + k]])));
            Vec3l normal = cross(p[1] - p[0], p[2] - p[0]);
            if (mirrored) normal = normal * -1.0L;
            const Vec3l direction = wide(ray.direction), origin = wide(ray.origin);
            const long double along = dot(direction, normal);
            if (along == 0 || (!material.double_sided && (casters ? along < 0 : along > 0))) continue;
            const long double distance = dot(p[0] - origin, normal) / along;
            const Vec3l at = origin + direction * distance;
            long double inside = 1;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3l edge = p[(k + 1) % 3] - p[k];
                const long double side = dot(cross(edge, at - p[k]), normal) * (mirrored ? -1 : 1);
                inside = std::min(inside, side / (dot(normal, normal)));
            }
            if (std::abs(inside) < 1e-6L) ++doubtful;
            if (inside >= 0 && distance > ray.least && distance < ray.most) found.push_back({distance, i, t});
        }
    }
    std::sort(found.begin(), found.end(), [](const Expected& a, const Expected& b) { return a.distance < b.distance; });
    return found;
}

/// Tori, one of them mirrored, one a layer, and boxes of both sides.
Scene tori() {
    Scene scene;
    scene.materials.resize(3);
    scene.materials[1].double_sided = true;
    scene.materials[2].alpha_mode = AlphaMode::blend;
    scene.meshes = {make_torus(1.0f, 0.4f, 60, 40), make_box({0.3f, 0.5f, 0.2f}), make_torus(0.7f, 0.2f, 30, 20)};
    for (std::size_t i = 0; i < 3; ++i) scene.meshes[i].material = static_cast<int>(i);
    for (int i = 0; i < 6; ++i) {
        const float at = static_cast<float>(i) * 0.4f - 1.0f;
        Mat4 place = translation({at, 0.3f * at, -at}) * rotation({1, at, 0.3f}, 1.0f + at);
        if (i % 2 == 1) place = place * scaling({-1.0f, 1.2f, 0.8f});
        scene.instances.push_back({i % 3, place});
    }
    return scene;
}

}  // namespace

TEST_CASE("ray hits: they are those of all triangles, for views and for lights", "[raster][explain]") {
    const Scene scene = tori();
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-1.2, 1.2);
    int compared = 0, hits = 0;
    for (int i = 0; i < 1200; ++i) {
        Ray ray{{number(random), number(random), number(random)}, {number(random), number(random), number(random)}};
        if (i % 10 == 0) ray.direction = {0, i % 20 == 0 ? 1.0 : -1.0, 0};
        ray.direction = ray.direction * (1.0 / length(ray.direction));
        ray.least = 0.01;
        if (i % 3 == 0) ray.most = 1.5;
        const bool casters = i % 2 == 0;
        int doubtful = 0;
        const std::vector<Expected> expected = by_all(scene, ray, casters, doubtful);
        if (doubtful > 0) continue;
        const std::size_t count = i % 5 == 0 ? 1 : 8;
        const auto found = hits_along(prepared->data(), ray, casters ? RaySees::casters : RaySees::drawn, count);
        INFO(i);
        REQUIRE(found.size() == std::min(count, expected.size()));
        for (std::size_t k = 0; k < found.size(); ++k) {
            CHECK(std::abs(static_cast<double>(expected[k].distance) - found[k].distance) < 1e-9);
            CHECK(found[k].instance == expected[k].instance);
            CHECK(found[k].triangle == expected[k].triangle);
            CHECK(length(found[k].position - (ray.origin + ray.direction * found[k].distance)) < 1e-9);
            ++hits;
        }
        ++compared;
    }
    CHECK(compared > 1100);
    CHECK(hits > 400);
}

TEST_CASE("ray hits: no ray slips between the triangles of a closed surface, nor through its corners", "[raster][explain]") {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = {make_sphere(1.0f, 24, 16)};
    scene.meshes[0].material = 0;
    scene.instances.push_back({0, {}});
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    // From the middle outwards, exactly through vertices and middles of edges. Light passes from inside to outside through fronts.
    const Mesh& mesh = scene.meshes[0];
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const Vec3d a = to_double(mesh.positions[mesh.indices[i]]), b = to_double(mesh.positions[mesh.indices[i - i % 3 + (i + 1) % 3]]);
        for (const Vec3d through : {a, (a + b) * 0.5}) {
            const Ray ray{{0, 0, 0}, through * (1.0 / length(through))};
            CHECK(hits_along(prepared->data(), ray, RaySees::casters, 8).size() == 1);
        }
    }
}

TEST_CASE("ray hits: a triangle that is left out and one without area are not hit", "[raster][explain]") {
    Scene scene;
    scene.materials.resize(1);
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 0}, {NAN, 0, 0}};
    mesh.normals.assign(6, {0, 0, 1});
    mesh.indices = {0, 1, 2, 0, 3, 4, 0, 1, 5};
    mesh.material = 0;
    scene.meshes = {mesh};
    scene.instances.push_back({0, {}});
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    const Ray ray{{0, 0, 3}, {0, 0, -1}};
    const auto hits = hits_along(prepared->data(), ray, RaySees::drawn, 8);
    REQUIRE(hits.size() == 1);
    CHECK(hits[0].distance == 3.0);
    CHECK(hits[0].barycentrics == std::array<double, 3>{0.25, 0.25, 0.5});
    CHECK(hits_along(prepared->data(), ray, RaySees::drawn, 8, TriangleOfInstance{0, 0}).empty());
    CHECK(hits_along(prepared->data(), ray, RaySees::casters, 8).empty());  // its back is turned to a light below
}

TEST_CASE("ray hits: the ray of a pixel meets the pixel's middle in the picture, between near and far", "[raster][explain]") {
    const PictureSize size{48, 20};
    for (const bool orthographic : {false, true})
        for (const bool own_sides : {false, true}) {
            Camera camera = halflit::test::camera_at({1, 2, 5}, {0.3f, 0, 0}, 0.7f, 0.5f);
            camera.orthographic = orthographic, camera.half_height = 2, camera.far_z = 9;
            if (own_sides) camera.sides = ViewSides{-0.2f, 0.7f, -0.4f, 0.3f};
            const Mat4 clip = clip_from_world(camera, 48.0f / 20.0f);
            for (int x = 0; x < 48; x += 5)
                for (int y = 0; y < 20; y += 3) {
                    const Ray ray = ray_of_pixel(camera, size, x, y);
                    for (const double t : {ray.least, ray.most}) {
                        const Vec3f p = to_float(ray.origin + ray.direction * t);
                        const Vec4f at = clip * Vec4f{p.x, p.y, p.z, 1};
                        CHECK((at.x / at.w + 1) * 24 == Approx(x + 0.5).margin(1e-4));
                        CHECK((1 - at.y / at.w) * 10 == Approx(y + 0.5).margin(1e-4));
                        CHECK(at.z / at.w == Approx(t == ray.least ? 1.0 : 0.0).margin(1e-5));
                    }
                    const Ray same = ray_to(camera, size, ray.origin + ray.direction * 3.0);
                    CHECK(length(same.origin - ray.origin) < 1e-6);
                    CHECK(length(same.direction - ray.direction) < 1e-6);
                }
        }
}
