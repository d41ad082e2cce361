// The nearest triangle, and the largest distance between two surfaces, against brute force.
#include "apps/engine/compare/hausdorff.hpp"
#include "halflit/shapes.hpp"
#include "sh/vec3d.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/random.hpp"

#include <algorithm>
#include <vector>

using namespace halflit;
using namespace halflit::engine;
using namespace halflit::test;

namespace {

Scene scene_of(Mesh mesh) {
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.resize(1);
    return scene;
}

Vec3f random_point(Random& random, float reach) {
    return {random.real32(-reach, reach), random.real32(-reach, reach), random.real32(-reach, reach)};
}

/// Triangles of many sizes, some without area, some at one place.
Mesh some_triangles(Random& random, int count) {
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const Vec3f middle = random_point(random, 1);
        const float reach = random.chance(0.1) ? 1.0f : 0.1f;
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(random.chance(0.05) ? middle : middle + random_point(random, reach));
        const bool again = random.chance(0.1);
        const std::uint32_t first = static_cast<std::uint32_t>(mesh.positions.size()) - 3;
        for (int copy = 0; copy < (again ? 2 : 1); ++copy) mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2});
    }
    return mesh;
}

double brute_force(const Surface& surface, Vec3d point) {
    double least = 1e300;
    for (const Triangle& triangle : surface.triangles()) least = std::min(least, distance_to(triangle, point));
    return least;
}

}  // namespace

TEST_CASE("surface: the nearest triangle is that of brute force, from whatever triangle the search begins", "[compare]") {
    Random random(5);
    for (const int count : {1, 2, 3, 5, 9, 40, 700}) {
        const Surface surface(scene_of(some_triangles(random, count)));
        const auto triangles = static_cast<std::int64_t>(surface.triangles().size());
        for (int i = 0; i < 300; ++i) {
            const Vec3d point = to_double(random_point(random, i % 3 == 0 ? 100.0f : 1.5f));
            const double least = brute_force(surface, point);
            const auto guess = static_cast<std::uint32_t>(random.integer(0, triangles - 1));
            const Surface::Nearest found = surface.nearest(point, guess);
            INFO(count << " triangles, point " << i);
            CHECK(found.distance == Approx(least).epsilon(1e-12));
            CHECK(distance_to(surface.triangles()[found.triangle], point) == found.distance);
            // A search that may end early ends within that distance, or at the nearest one.
            const double enough = least * random.real(0, 3);
            const Surface::Nearest early = surface.nearest(point, guess, enough);
            CHECK(early.distance <= std::max(enough, least) * (1 + 1e-12));
            CHECK(distance_to(surface.triangles()[early.triangle], point) == early.distance);
        }
    }
}

TEST_CASE("surface: the largest distance lies between the bounds, by dense points of random surfaces", "[compare]") {
    Random random(6);
    for (int model = 0; model < 20; ++model) {
        const Surface from(scene_of(some_triangles(random, 30))), to(scene_of(some_triangles(random, 60)));
        const double accuracy = model % 2 == 0 ? 1e-2 : 1e-3;
        const FarthestPoint found = farthest_point(from, to, accuracy);
        double most = 0;
        constexpr int kSteps = 24;
        for (const Triangle& t : from.triangles())
            for (int i = 0; i <= kSteps; ++i)
                for (int j = 0; i + j <= kSteps; ++j)
                    most = std::max(most, brute_force(to, t.a + (t.b - t.a) * (1.0 * i / kSteps) + (t.c - t.a) * (1.0 * j / kSteps)));
        INFO("model " << model << ": " << found.at_least << " to " << found.at_most << ", " << most << " by dense points");
        CHECK(most <= found.at_most * (1 + 1e-12));
        CHECK(found.at_least <= found.at_most);
        CHECK(found.at_most - found.at_least <= accuracy * (1 + 1e-12));
        CHECK(brute_force(to, found.point) == Approx(found.at_least).epsilon(1e-12));
    }
}

TEST_CASE("surface: balls of one middle are as far apart as their radii, and a surface is where it is", "[compare]") {
    const Surface small(scene_of(make_sphere_of(1, 20'000))), large(scene_of(make_sphere_of(1.5f, 20'000)));
    constexpr double kAccuracy = 3e-4, kFlat = 1e-3;  // triangles of such balls lie so deep below the sphere
    for (const bool outwards : {false, true}) {
        const FarthestPoint found = outwards ? farthest_point(small, large, kAccuracy) : farthest_point(large, small, kAccuracy);
        CHECK(found.at_least > 0.5 - kFlat);
        CHECK(found.at_most < 0.5 + kFlat);
        CHECK(found.at_most - found.at_least <= kAccuracy * (1 + 1e-12));
    }
    CHECK(farthest_point(small, small, kAccuracy).at_most < 1e-12);
}
