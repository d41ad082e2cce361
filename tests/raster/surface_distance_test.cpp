// Distances to the nearest and the farthest surface, compared with all triangles one by one.
#include "raster/scene/surface_distance.hpp"
#include "sh/mat4.hpp"
#include "tests/raster/random_geometry.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <limits>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

using Vec3l = Vec3<long double>;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

long double squared(Vec3l v) { return dot(v, v); }

/// Squared distance from the origin to the segment a + b s, s in [0, 1].
long double to_segment(Vec3l a, Vec3l b) {
    const long double length = squared(b), s = length > 0 ? std::clamp(-dot(a, b) / length, 0.0L, 1.0L) : 0.0L;
    return squared(a + b * s);
}

/// Squared distance from the origin to the nearest of several points that surely lie on a triangle. One is the foot of the perpendicular on
/// its plane by the normal equations, if it is within the triangle. The others are on the edges: if the equations are nearly singular, an
/// edge is as near.
long double to_triangle(const std::array<Vec3l, 3>& p) {
    const Vec3l e = p[1] - p[0], f = p[2] - p[0];
    long double nearest = std::min({to_segment(p[0], e), to_segment(p[0], f), to_segment(p[1], p[2] - p[1])});
    const long double ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), ae = -dot(p[0], e), af = -dot(p[0], f), det = ee * ff - ef * ef;
    if (det > 0) {
        const long double s = (ff * ae - ef * af) / det, t = (ee * af - ef * ae) / det;
        if (s >= 0 && t >= 0 && s + t <= 1) nearest = std::min(nearest, squared(p[0] + (e * s + f * t)));
    }
    return nearest;
}

/// Squared distances. drawn: to the surfaces as they are drawn, with vertices that float32 has placed.
struct Distances {
    long double exact = std::numeric_limits<double>::max(), drawn = exact, farthest_drawn = 0;
};

/// Distances by all triangles whose corners are finite.
Distances by_all(const Scene& scene, Vec3d point) {
    Distances d;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const Vec4f* m = instance.world_from_object.c;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            std::array<Vec3l, 3> exact, drawn;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3f p = mesh.positions[mesh.indices[i + k]], placed = transform_point(instance.world_from_object, p);
                const auto row = [&](float a, float b, float c, float o) {
                    return (static_cast<long double>(a) * p.x + static_cast<long double>(b) * p.y) + static_cast<long double>(c) * p.z + o;
                };
                exact[k] = {row(m[0].x, m[1].x, m[2].x, m[3].x) - point.x, row(m[0].y, m[1].y, m[2].y, m[3].y) - point.y,
                            row(m[0].z, m[1].z, m[2].z, m[3].z) - point.z};
                drawn[k] = {placed.x - point.x, placed.y - point.y, placed.z - point.z};
            }
            if (!std::isfinite(squared(drawn[0]) + squared(drawn[1]) + squared(drawn[2]))) continue;
            d.exact = std::min(d.exact, to_triangle(exact));
            d.drawn = std::min(d.drawn, to_triangle(drawn));
            for (const Vec3l& corner : drawn) d.farthest_drawn = std::max(d.farthest_drawn, squared(corner));
        }
    }
    return d;
}

PreparedData made(const Scene& scene) {
    auto prepared = PreparedData::make(scene, {1});
    REQUIRE(prepared);
    return std::move(*prepared);
}

/// Point inside the scene, around it, far away, on a vertex or close to one.
Vec3d any_point(Random& random, const Scene& scene, double reach) {
    const double away = random.chance(0.5) ? reach : reach * std::pow(10.0, random.real(-2, 3));
    Vec3d point{random.real(-away, away), random.real(-away, away), random.real(-away, away)};
    const Instance& instance = scene.instances[static_cast<std::size_t>(random.index(static_cast<int>(scene.instances.size())))];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    if (random.chance(0.5) && !mesh.indices.empty()) {
        const auto i = static_cast<std::size_t>(random.index(static_cast<int>(mesh.indices.size())));
        const Vec3f on = transform_point(instance.world_from_object, mesh.positions[mesh.indices[i]]);
        const double off = random.chance(0.3) ? 0.0 : reach * std::pow(10.0, random.real(-6, -1));
        if (std::isfinite(on.x + on.y + on.z))
            point = Vec3d{on.x + random.real(-off, off), on.y + random.real(-off, off), on.z + random.real(-off, off)};
    }
    return point;
}

/// Rounding errors of distances relative to all coordinates: some 10 units of 2^-53; for thin triangles, their aspect times that (measured:
/// 9e-11 above and 2e-9 below, aspects of 1e4 and more, at distances of 1e-8).
constexpr double kRounding = 2e-15, kThinRounding = 1e-8;

struct Comparison {
    double rounding;
    int points = 0, too_near = 0, too_far = 0;  ///< compared with the scene's surfaces, exact or as they are drawn
    int beyond_drawn = 0, beyond_farthest = 0;

    void add(const Scene& scene, const PreparedData& prepared, Vec3d point, double size) {
        const Distances truth = by_all(scene, point);
        const double exact = std::sqrt(static_cast<double>(truth.exact)), drawn = std::sqrt(static_cast<double>(truth.drawn));
        const double found = std::sqrt(nearest_surface_squared(prepared, point));
        const double slack = 1e-9 * exact + rounding * (size + std::abs(point.x) + std::abs(point.y) + std::abs(point.z));
        too_near += found < std::min(exact, drawn) - slack;
        too_far += found > std::max(exact, drawn) + slack;
        // Error budgets take 0.999 of the squared distance as its least. Point lights have a radius of 1e-4 by default, so nearer is no
        // error.
        beyond_drawn += 0.999 * found * found > std::max(drawn * drawn, 1e-8);
        beyond_farthest += static_cast<double>(truth.farthest_drawn) > farthest_surface_squared(prepared, point) * (1 + 1e-14);
        ++points;
    }
};

Mesh sound_mesh(Random& random) {
    switch (random.index(4)) {
        case 0:
            return make_sphere_of(1, random.integer(12, 5000));
        case 1:
            return make_plane(1, static_cast<int>(random.integer(1, 40)));
        case 2:
            return make_box({1, 0.3f, 0.6f});
        default:
            return triangle_soup(random, static_cast<int>(random.integer(1, 700)), 1, false);
    }
}

}  // namespace

TEST_CASE("surface distance: that of the nearest triangle of random scenes, and none farther than the farthest", "[raster][distance]") {
    Random random(1);
    Comparison sum{kRounding};
    for (int round = 0; round < 120; ++round) {
        Scene scene;
        for (int i = 0; i < 3; ++i) scene.meshes.push_back(sound_mesh(random));
        const double reach = random_decades(random, 0.1, 20);
        const int instances = static_cast<int>(random.integer(1, 12));
        for (int i = 0; i < instances; ++i) {
            const int mesh = random.index(3);
            scene.instances.push_back({mesh, random_place(random, reach, random_decades(random, 1e-2, 2))});
        }
        const PreparedData prepared = made(scene);
        for (int i = 0; i < 5; ++i) sum.add(scene, prepared, any_point(random, scene, reach), reach);
    }
    CHECK(sum.too_far == 0);
    CHECK(sum.too_near == 0);
    CHECK(sum.beyond_farthest == 0);
    CHECK(sum.points == 600);
}

TEST_CASE("surface distance: that of the nearest triangle, for triangles that are lines or nearly so", "[raster][distance]") {
    Random random(2);
    Comparison sum{kThinRounding};
    for (int round = 0; round < 4000; ++round) {
        Scene scene;
        scene.meshes.push_back(triangle_soup(random, static_cast<int>(random.integer(1, 12)), 1, true));
        Mesh& mesh = scene.meshes[0];
        // Some exactly on a line: halves and sums of small whole numbers.
        if (random.chance(0.5))
            for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
                const Vec3f a{static_cast<float>(random.index(9)), static_cast<float>(random.index(9)),
                              static_cast<float>(random.index(9))};
                const Vec3f step{static_cast<float>(random.index(5) - 2), static_cast<float>(random.index(5) - 2),
                                 static_cast<float>(random.index(5) - 2)};
                for (std::size_t k = 0; k < 3; ++k) mesh.positions[i + k] = a + step * static_cast<float>(random.index(7) - 3);
            }
        scene.instances.push_back({0, random_place(random, 3)});
        sum.add(scene, made(scene), any_point(random, scene, 3), 20);
    }
    CHECK(sum.too_far == 0);
    CHECK(sum.too_near == 0);
    CHECK(sum.points == 4000);
}

TEST_CASE("surface distance: no surface is drawn nearer, far from the origin too", "[raster][distance]") {
    // float32 has steps of 1/128 to 1/64 at that distance, and the objects are not much larger.
    Random random(3);
    Comparison sum{kRounding};
    for (int round = 0; round < 100; ++round) {
        Scene scene;
        scene.meshes.push_back(make_sphere(0.5f, 8, 5));
        const Vec3f far_away = random_point(random, 2e5);
        for (int i = 0; i < 40; ++i) scene.instances.push_back({0, random_place(random, 0.5, random_decades(random, 0.02, 0.3))});
        for (Instance& instance : scene.instances) {
            Vec4f& at = instance.world_from_object.c[3];
            at = {at.x + far_away.x, at.y + far_away.y, at.z + far_away.z, 1};
        }
        const PreparedData prepared = made(scene);
        for (int i = 0; i < 6; ++i) {
            const Vec3d point{far_away.x + random.real(-0.5, 0.5), far_away.y + random.real(-0.5, 0.5),
                              far_away.z + random.real(-0.5, 0.5)};
            sum.add(scene, prepared, point, 2e5);
        }
    }
    CHECK(sum.too_far == 0);
    CHECK(sum.beyond_drawn == 0);
    CHECK(sum.beyond_farthest == 0);
    CHECK(sum.points == 600);
}

TEST_CASE("surface distance: vertices that are not finite hide no surface", "[raster][distance]") {
    Random random(4);
    Comparison sum{kThinRounding};
    for (int round = 0; round < 200; ++round) {
        Scene scene;
        scene.meshes.push_back(random_mesh(random, 2000));
        std::vector<Vec3f>& positions = scene.meshes[0].positions;
        for (int i = 0; i < 10; ++i) {
            Vec3f& p = positions[static_cast<std::size_t>(random.index(static_cast<int>(positions.size())))];
            (random.chance(0.5) ? p.x : p.y) = random.chance(0.5) ? kNan : std::numeric_limits<float>::infinity();
        }
        for (int i = 0; i < 3; ++i) scene.instances.push_back({0, random_place(random, 2)});
        scene.instances[0].world_from_object.c[3].z = random.chance(0.3) ? kNan : 0.0f;
        sum.add(scene, made(scene), any_point(random, scene, 2), 4);
    }
    CHECK(sum.too_far == 0);
    CHECK(sum.points == 200);
}

TEST_CASE("surface distance: a box has the distances of the closed form", "[raster][distance]") {
    Scene scene;
    scene.meshes.push_back(make_box({1, 2, 3}));
    scene.instances.push_back({0, {}});
    const PreparedData box = made(scene);
    CHECK(nearest_surface_squared(box, {5, 0, 0}) == Approx(16));
    CHECK(nearest_surface_squared(box, {0, 0, 0}) == Approx(1));
    CHECK(nearest_surface_squared(box, {4, 6, 3}) == Approx(25));
    CHECK(nearest_surface_squared(box, {4, 6, 15}) == Approx(169));
    CHECK(nearest_surface_squared(box, {0.5, 2, 0.25}) == 0.0);
    CHECK(farthest_surface_squared(box, {0, 0, 0}) == Approx(14));
    CHECK(farthest_surface_squared(box, {2, 2, 3}) == Approx(9 + 16 + 36));
    CHECK(nearest_surface_squared(made({}), {0, 0, 0}) > 1e30);  // nothing is near
}
