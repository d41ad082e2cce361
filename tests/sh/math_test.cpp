// The public matrices: products in their order, rotations against the C library, and views that stay rigid whatever they look at.
#include "halflit/math.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>

using namespace halflit;
using halflit::test::Random;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr float kTiny = 1e-42f;  // denormal

Vec3d wide(Vec4f v) { return {v.x, v.y, v.z}; }
Vec3d wide(Vec3f v) { return {v.x, v.y, v.z}; }
Vec3d unit(Vec3d v) { return v * (1.0 / length(v)); }

/// Largest deviation from a rotation: columns of length 1 at right angles, of positive orientation, and the last row 0 0 0.
double off_rigid(const Mat4& m) {
    const Vec3d x = wide(m.c[0]), y = wide(m.c[1]), z = wide(m.c[2]);
    double worst = 0;
    for (const double d : {dot(x, x) - 1, dot(y, y) - 1, dot(z, z) - 1, dot(x, y), dot(y, z), dot(z, x), dot(cross(x, y), z) - 1,
                           double{m.c[0].w}, double{m.c[1].w}, double{m.c[2].w}}) {
        if (!(std::fabs(d) < 1e300)) return 1e300;
        worst = std::max(worst, std::fabs(d));
    }
    return worst;
}

// Nine entries, each rounded to float: at most 2^-24 each, and two of them in every product.
constexpr double kRigid = 4e-7;

double off_by(const Mat4& a, const Mat4& b) {
    double worst = 0;
    for (int j = 0; j < 4; ++j)
        for (const double d : {double{a.c[j].x} - double{b.c[j].x}, double{a.c[j].y} - double{b.c[j].y},
                               double{a.c[j].z} - double{b.c[j].z}, double{a.c[j].w} - double{b.c[j].w}}) {
            if (!(std::fabs(d) < 1e300)) return 1e300;
            worst = std::max(worst, std::fabs(d));
        }
    return worst;
}

Vec3f random_vector(Random& random, double most) {
    return {random.real32(-most, most), random.real32(-most, most), random.real32(-most, most)};
}

}  // namespace

TEST_CASE("math: a matrix without values is the identity, at compile time too", "[sh][math]") {
    static_assert(Mat4{} == Mat4::identity());
    static_assert(Mat4::identity().c[3] == Vec4f{0, 0, 0, 1});
    const Vec4f v{1.25f, -2, 3e30f, 1};
    CHECK(Mat4{} * v == v);
    const Mat4 m = translation({1, 2, 3}) * rotation({1, 1, 0}, 0.4f);
    CHECK(Mat4{} * m == m);
    CHECK(m * Mat4{} == m);
}

TEST_CASE("math: a product applies its right factor first", "[sh][math]") {
    const Vec4f p{1, 1, 1, 1};
    CHECK(translation({10, 20, 30}) * scaling({2, 3, 4}) * p == Vec4f{12, 23, 34, 1});
    CHECK(scaling({2, 3, 4}) * translation({10, 20, 30}) * p == Vec4f{22, 63, 124, 1});
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const Mat4 a = rotation(random_vector(random, 1), random.real32(-4, 4)), b = translation(random_vector(random, 1));
        const Vec3f q = random_vector(random, 1);
        const Vec4f once = (a * b) * Vec4f{q.x, q.y, q.z, 1}, twice = a * (b * Vec4f{q.x, q.y, q.z, 1});
        CHECK(length(wide(once) - wide(twice)) < 2e-6);  // a dozen roundings of numbers up to 3.5
        CHECK(once.w == 1.0f);
    }
}

TEST_CASE("math: a sum of products has the order that the header writes out", "[sh][math]") {
    Random random(4);
    for (int i = 0; i < 1000; ++i) {
        Mat4 m;
        for (Vec4f& c : m.c) c = {random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)};
        const Vec4f v{random.real32(-9, 9), random.real32(-9, 9), random.real32(-9, 9), random.real32(-9, 9)};
        const auto sum = [&](float x, float y, float z, float w) {
            const float first = x * v.x, second = y * v.y, third = z * v.z, fourth = w * v.w;
            const float two = first + second, three = two + third;
            return three + fourth;
        };
        const Vec4f p = m * v;
        CHECK(p.x == sum(m.c[0].x, m.c[1].x, m.c[2].x, m.c[3].x));
        CHECK(p.y == sum(m.c[0].y, m.c[1].y, m.c[2].y, m.c[3].y));
        CHECK(p.z == sum(m.c[0].z, m.c[1].z, m.c[2].z, m.c[3].z));
        CHECK(p.w == sum(m.c[0].w, m.c[1].w, m.c[2].w, m.c[3].w));
    }
}

TEST_CASE("math: rotation about an axis is counter-clockwise seen against the axis", "[sh][math]") {
    const float quarter = 1.57079633f;
    const auto maps = [&](Vec3f axis, Vec3f from, Vec3f to) {
        const Vec4f image = rotation(axis, quarter) * Vec4f{from.x, from.y, from.z, 0};
        return length(wide(image) - wide(to)) < 1e-7;
    };
    CHECK(maps({0, 0, 1}, {1, 0, 0}, {0, 1, 0}));
    CHECK(maps({1, 0, 0}, {0, 1, 0}, {0, 0, 1}));
    CHECK(maps({0, 1, 0}, {0, 0, 1}, {1, 0, 0}));
    CHECK(maps({0, 0, -1}, {0, 1, 0}, {1, 0, 0}));
}

TEST_CASE("math: rotation about an axis of any length is that of the quaternion", "[sh][math]") {
    Random random(5);
    for (int i = 0; i < 20000; ++i) {
        const Vec3f direction = random_vector(random, 1);
        if (!(length(direction) > 0.01f)) continue;
        const double angle = random.real(-12, 12);
        const auto angle_rad = static_cast<float>(angle);
        const Vec3d n = unit(wide(direction));
        const double s = std::sin(0.5 * double{angle_rad}), c = std::cos(0.5 * double{angle_rad});
        const Mat4 wanted =
            rotation(Vec4f{static_cast<float>(n.x * s), static_cast<float>(n.y * s), static_cast<float>(n.z * s), static_cast<float>(c)});
        // The quaternion's four numbers are rounded before they are multiplied; the matrix about the axis only at its end.
        for (const float size : {1.0f, 1e-37f, 1e37f, 3e-3f}) CHECK(off_by(rotation(direction * size, angle_rad), wanted) < 6e-7);
        CHECK(off_rigid(rotation(direction, angle_rad)) < kRigid);
    }
    CHECK(off_by(rotation({kTiny, 0, 0}, 0.5f), rotation({1, 0, 0}, 0.5f)) == 0);
    CHECK(off_by(rotation({kLargest, kLargest, 0}, 0.5f), rotation({1, 1, 0}, 0.5f)) < 1e-7);
}

TEST_CASE("math: rotation by many turns keeps its angle up to a million radians", "[sh][math]") {
    for (const float angle : {100.0f, -1234.5f, 1e5f, 999999.0f, -1e6f}) {
        const Vec4f image = rotation({0, 0, 1}, angle) * Vec4f{1, 0, 0, 0};
        INFO(angle);
        CHECK(double{image.x} == Approx(std::cos(double{angle})).margin(1e-7));
        CHECK(double{image.y} == Approx(std::sin(double{angle})).margin(1e-7));
    }
    CHECK(rotation({0, 0, 1}, 2e6f) == Mat4{});
}

TEST_CASE("math: rotation without an axis or an angle is the identity", "[sh][math]") {
    for (const Vec3f axis :
         {Vec3f{0, 0, 0}, Vec3f{-0.0f, 0, 0}, Vec3f{kNan, 0, 0}, Vec3f{1, kNan, 1}, Vec3f{kInf, 0, 0}, Vec3f{1, -kInf, 1}})
        CHECK(rotation(axis, 1.0f) == Mat4{});
    for (const float angle : {0.0f, -0.0f, kNan, kInf, -kInf}) CHECK(rotation({1, 2, 3}, angle) == Mat4{});
}

TEST_CASE("math: look_at stands at the eye, looks at the target, and holds `up` upwards", "[sh][math]") {
    Random random(6);
    int looked = 0;
    for (int i = 0; i < 20000; ++i) {
        // From 1e-36 to 1e36: distances leave the range in which float's squares are finite.
        const double scale = std::pow(10.0, random.real(-36, 36));
        const Vec3f eye = random_vector(random, scale), target = random_vector(random, i % 2 == 0 ? scale : scale * 1e-3);
        const Vec3f up = i % 3 == 0 ? Vec3f{0, 1, 0} : random_vector(random, std::pow(10.0, random.real(-36, 36)));
        const Mat4 m = look_at(eye, target, up);
        const Vec3d view = unit(wide(target) - wide(eye)), upward = unit(wide(up));
        if (!(length(cross(view, upward)) > 1e-3)) continue;
        ++looked;
        INFO("scale " << scale);
        CHECK(off_rigid(m) < kRigid);
        CHECK(m.c[3] == Vec4f{eye.x, eye.y, eye.z, 1});
        CHECK(length(wide(m.c[2]) + view) < 2e-7);
        CHECK(std::fabs(dot(wide(m.c[0]), upward)) < 2e-7);  // the horizon is level
        CHECK(dot(wide(m.c[1]), upward) > 0);
    }
    CHECK(looked > 19000);
}

TEST_CASE("math: look_at is what the axes say", "[sh][math]") {
    CHECK(look_at({0, 0, 5}, {0, 0, 0}) == translation({0, 0, 5}));
    CHECK(look_at({7, 0, 0}, {0, 0, 0}) == Mat4{{{0, 0, -1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}, {7, 0, 0, 1}}});
    CHECK(look_at({0, 0, 5}, {0, 0, 0}, {-1, 0, 0}) == Mat4{{{0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 5, 1}}});
}

TEST_CASE("math: look_at is rigid where `up` is along the view", "[sh][math]") {
    Random random(7);
    for (int i = 0; i < 5000; ++i) {
        const Vec3f eye = random_vector(random, 10),
                    target = i % 4 == 0 ? eye + Vec3f{0, i % 8 == 0 ? 1.0f : -1.0f, 0} : random_vector(random, 10);
        const Vec3f view = target - eye;
        const double turn = std::pow(10.0, random.real(-12, -3));  // from parallel within rounding to clearly not
        for (const float sign : {1.0f, -1.0f}) {
            const Vec3f up = view * sign + random_vector(random, turn);
            const Mat4 m = look_at(eye, target, i % 4 == 0 ? Vec3f{0, sign, 0} : up);
            CHECK(off_rigid(m) < kRigid);
            CHECK(length(wide(m.c[2]) + unit(wide(target) - wide(eye))) < 2e-7);
        }
    }
}

TEST_CASE("math: look_at is rigid where there is nothing to look at", "[sh][math]") {
    const Vec3f here{1, 2, 3};
    for (const Vec3f up : {Vec3f{0, 1, 0}, Vec3f{0, 0, 1}, Vec3f{0, 0, -5}, Vec3f{0, 0, 0}, Vec3f{kNan, 0, 0}, Vec3f{kInf, 1, 0},
                           Vec3f{kTiny, 0, 0}, Vec3f{kLargest, -kLargest, 0}})
        for (const Vec3f target : {here, Vec3f{1, 2, 0}, Vec3f{kNan, 0, 0}, Vec3f{0, kInf, 0}, Vec3f{kLargest, kLargest, -kLargest}}) {
            const Mat4 m = look_at(here, target, up);
            CHECK(off_rigid(m) < kRigid);
            CHECK(m.c[3] == Vec4f{1, 2, 3, 1});
        }
    CHECK(off_rigid(look_at({0, 0, 0}, {kTiny, 0, 0})) < kRigid);
    CHECK(wide(look_at({0, 0, 0}, {kTiny, 0, 0}).c[2]) == Vec3d{-1, 0, 0});
    CHECK(off_rigid(look_at({kLargest, 0, 0}, {-kLargest, kLargest, 0})) < kRigid);
    // For an eye without a position, only the position is not a number.
    CHECK(off_rigid(look_at({kNan, 0, 0}, {0, 0, 0})) < kRigid);
    CHECK(off_rigid(look_at({kInf, kInf, 0}, {0, 0, 0})) < kRigid);
}

TEST_CASE("math: normalize_or keeps the direction of every finite vector", "[sh][math]") {
    Random random(8);
    for (int i = 0; i < 5000; ++i) {
        const Vec3f v = random_vector(random, std::pow(10.0, random.real(-40, 38)));
        if (v == Vec3f{}) continue;
        CHECK(length(wide(normalize_or(v, {kNan, kNan, kNan})) - unit(wide(v))) < 1.1e-7);
    }
    const Vec3f fallback{0, 0, 9};
    for (const Vec3f v : {Vec3f{0, 0, 0}, Vec3f{kNan, 1, 1}, Vec3f{1, kInf, 0}, Vec3f{-kInf, kInf, 0}})
        CHECK(normalize_or(v, fallback) == fallback);
}
