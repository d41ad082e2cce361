#include "halflit/math.hpp"
#include "sh/mat4.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>

using namespace halflit;

namespace {

Mat4 sample_transform() { return translation({1, 2, 3}) * rotation({0.5f, 0.5f, 0.5f, 0.5f}) * scaling({2, 3, 4}); }

}  // namespace

TEST_CASE("vec3: the cross product is at a right angle to both, and right-handed", "[sh][vec3]") {
    CHECK(cross(Vec3f{1, 0, 0}, Vec3f{0, 1, 0}) == Vec3f{0, 0, 1});
    const Vec3f a{1, 2, 3}, b{-4, 5, 6};  // small integers: exact
    CHECK(dot(a, cross(a, b)) == 0.0f);
    CHECK(dot(b, cross(a, b)) == 0.0f);
}

TEST_CASE("vec3: normalize_or keeps the direction of every finite length", "[sh][vec3]") {
    for (const float size : {1e-45f, 1e-30f, 1e-10f, 1.0f, 1e20f, 1e38f}) {
        const Vec3f v = normalize_or({size, -size, size}, {0, 0, 1});
        CHECK(v.x == Approx(1 / std::sqrt(3.0)).epsilon(1e-7));
        CHECK(v.y == -v.x);
        CHECK(v.z == v.x);
    }
    const Vec3f fallback{0, 0, 1};
    CHECK(normalize_or({0, 0, 0}, fallback) == fallback);
    CHECK(normalize_or({std::numeric_limits<float>::quiet_NaN(), 0, 0}, fallback) == fallback);
    CHECK(normalize_or({std::numeric_limits<float>::infinity(), 0, 0}, fallback) == fallback);
}

TEST_CASE("mat4: a product applies the right-hand transform first", "[sh][mat4]") {
    const Vec3f p = transform_point(translation({1, 0, 0}) * scaling({2, 2, 2}), {3, 4, 5});
    CHECK(p == Vec3f{7, 8, 10});
    const Mat4 a = sample_transform(), b = scaling({0.5f, 2, 8}) * translation({-1, 4, 2});
    CHECK(transform_point(a * b, {1, 2, 4}) == transform_point(a, transform_point(b, {1, 2, 4})));
}

TEST_CASE("mat4: the quaternion of a third of a turn about (1, 1, 1) moves x to y to z", "[sh][mat4]") {
    const Mat4 m = rotation({0.5f, 0.5f, 0.5f, 0.5f});
    CHECK(transform_vector(m, {1, 0, 0}) == Vec3f{0, 1, 0});
    CHECK(transform_vector(m, {0, 1, 0}) == Vec3f{0, 0, 1});
    CHECK(transform_vector(m, {0, 0, 1}) == Vec3f{1, 0, 0});
}

TEST_CASE("mat4: normals stay at a right angle to a transformed plane, and outside under a mirror", "[sh][mat4]") {
    for (const Mat4& m : {sample_transform(), scaling({-1, 1, 1}), scaling({1, 5, 0.25f})}) {
        const NormalMatrix n = normal_matrix(m);
        const Vec3f u{1, 2, 0}, v{0, 1, 3}, normal = cross(u, v);
        const Vec3f moved = n.c[0] * normal.x + n.c[1] * normal.y + n.c[2] * normal.z;
        CHECK(dot(moved, transform_vector(m, u)) == Approx(0.0).margin(1e-5));
        CHECK(dot(moved, transform_vector(m, v)) == Approx(0.0).margin(1e-5));
        // A point on the outer side stays there.
        CHECK(dot(moved, transform_vector(m, normal)) > 0.0f);
    }
}

TEST_CASE("mat4: the determinant is the volume, negative for a mirror", "[sh][mat4]") {
    CHECK(determinant3(sample_transform()) == Approx(24.0));
    CHECK(determinant3(scaling({-2, 3, 4})) == -24.0);
}
