#include "tests/look/certified.hpp"
#include "tests/support/solids.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <sstream>
#include <string>

using namespace halflit;
using namespace halflit::engine;
using namespace halflit::test;

namespace {

Vec3d towards_viewer(const Camera& camera) {
    const Vec4f& back = camera.world_from_camera.c[2];
    return {back.x, back.y, back.z};
}

Vec3d point_of(const RayTriangle& triangle, Random& random) {
    double a = random.real(0, 1), b = random.real(0, 1);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    return triangle.corners[0] * (1 - a - b) + triangle.corners[1] * a + triangle.corners[2] * b;
}

/// Counts of the checks of many models.
struct Tally {
    std::size_t models = 0, triangles = 0, seen = 0, less = 0, hidden = 0, unknown = 0;
    std::size_t wrong_seen = 0, wrong_hidden = 0;
    std::int64_t rays = 0, escaped = 0, all_around = 0, escaped_around = 0;
    std::string first_wrong;
};

void note(Tally& tally, const std::string& what) {
    if (tally.first_wrong.empty()) tally.first_wrong = what;
}

/// Pixels of each kept picture, against rays. A claim is wrong if rays give other numbers of pixels than the claim, beyond those that
/// pass an edge.
void check_seen(const Certified& one, Tally& tally) {
    for (std::size_t view = 0; view < one.certificate.shots.size(); ++view) {
        const ViewShot& shot = one.certificate.shots[view];
        const auto counts = count_by_rays(one.triangles, shot.camera, shot.width(), shot.height(), kFirstOfFour);
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const TriangleView& claim = one.certificate.triangles[i];
            if (claim.view != static_cast<int>(view)) continue;
            if (claim.pixels >= counts[i].sure && claim.pixels <= counts[i].possible) continue;
            ++tally.wrong_seen;
            note(tally, "model " + std::to_string(tally.models) + ", triangle " + std::to_string(i) + " in view " + shot.name);
        }
    }
}

/// No ray through a pixel's centre meets a hidden triangle first.
void check_hidden(const Certified& one, Random& random, Tally& tally) {
    std::vector<std::size_t> hidden;
    for (std::size_t i = 0; i < one.triangles.size(); ++i)
        if (one.certificate.triangles[i].status == TriangleStatus::hidden) hidden.push_back(i);
    if (hidden.empty()) return;
    const auto facing = [&](std::size_t i, Vec3d direction) {
        const RayTriangle& t = one.triangles[i];
        const double area = 0.5 * dot(cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]), direction);
        return t.two_sided ? std::abs(area) : std::max(area, 0.0);
    };
    for (const LookedFrom& looked : one.certificate.looked) {
        const auto counts = count_by_rays(one.triangles, looked.camera, one.job.width, one.job.height, kPixelCentre);
        for (const std::size_t i : hidden)
            if (counts[i].sure > 0) {
                ++tally.wrong_hidden;
                note(tally, "model " + std::to_string(tally.models) + ", hidden triangle " + std::to_string(i) + " from " + looked.name);
            }
    }
    const double far = length(to_double(one.job.film.bounds.max) - to_double(one.job.film.bounds.min));
    constexpr std::size_t kMostChecked = 20;
    for (std::size_t k = 0; k < hidden.size(); k += 1 + hidden.size() / kMostChecked) {
        const std::size_t i = hidden[k];
        for (const LookedFrom& looked : one.certificate.looked) {
            const Vec3d direction = towards_viewer(looked.camera);
            const double pixel = 2.0 * looked.camera.half_height / one.job.height;
            if (facing(i, direction) < one.certificate.least * pixel * pixel) continue;
            ++tally.rays;
            if (!is_blocked(one.triangles, point_of(one.triangles[i], random), direction, i, 1e-6 * far)) ++tally.escaped;
        }
        for (int n = 0; n < 50; ++n) {
            Vec3d direction{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
            direction = direction * (1.0 / length(direction));
            if (!(facing(i, direction) > 0.0)) continue;
            ++tally.all_around;
            if (!is_blocked(one.triangles, point_of(one.triangles[i], random), direction, i, 1e-6 * far)) ++tally.escaped_around;
        }
    }
}

Tally check_models(std::uint64_t first, std::uint64_t count, int width, int height) {
    Tally tally;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        const Certified one = certified(random_model(seed), width, height, 4);
        Random random(seed);
        ++tally.models;
        tally.triangles += one.triangles.size();
        tally.seen += one.certificate.count(TriangleStatus::seen);
        tally.less += one.certificate.count(TriangleStatus::less);
        tally.hidden += one.certificate.count(TriangleStatus::hidden);
        tally.unknown += one.certificate.count(TriangleStatus::unknown);
        check_seen(one, tally);
        check_hidden(one, random, tally);
    }
    return tally;
}

void check(const Tally& tally) {
    std::ostringstream figures;
    figures << tally.models << " models, " << tally.triangles << " triangles: " << tally.seen << " seen, " << tally.less << " with less, "
            << tally.hidden << " hidden, " << tally.unknown << " unknown; " << tally.escaped << " of " << tally.rays
            << " rays escape, all around " << tally.escaped_around << " of " << tally.all_around << "\n";
    INFO(figures.str() << tally.first_wrong);
    CHECK(tally.seen > 0);
    CHECK(tally.hidden > 0);
    CHECK(tally.wrong_seen == 0);
    CHECK(tally.wrong_hidden == 0);
    CHECK(tally.escaped * 1000 <= tally.rays);  // a gap narrower than a pixel lets some through
    if (tally.models > 100) std::cout << figures.str();
}

}  // namespace

TEST_CASE("certificate: rays show each triangle with as many pixels as it claims, and no hidden one", "[look]") {
    check(check_models(1, 10, 160, 128));
}

TEST_CASE("certificate: two hundred models are as it claims, by rays", "[look][deep]") { check(check_models(100, 200, 240, 192)); }

TEST_CASE("certificate: a stray triangle, which whole views leave out, is seen in a close-up and not called hidden", "[look]") {
    Scene scene;
    SolidBuilder stray;
    stray.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    scene.meshes = {ball_mesh(1, 3), stray.take()};
    scene.instances.resize(2);
    scene.instances[1] = {.mesh = 1, .world_from_object = translation({5000, 3000, 0})};
    const Certified one = certified(scene, 160, 128, 4, 60);
    const std::array<int, 1> far{1};
    for (const LookedFrom& looked : one.certificate.looked) REQUIRE(looked.camera.half_height < 100);
    CHECK(one.certificate.count(TriangleStatus::hidden, far) == 0);
    CHECK(one.certificate.count(TriangleStatus::seen, far) == 1);
    Tally tally;
    check_seen(one, tally);
    CHECK(tally.wrong_seen == 0);
}

TEST_CASE("certificate: a closed body within another is hidden, and seen once the outer one has a hole", "[look]") {
    const Mesh outer = box_mesh({-1, -1, -1}, {1, 1, 1}, 4), inner = ball_mesh(0.5, 1);
    for (const bool open : {false, true}) {
        Scene scene;
        const std::array<std::size_t, 2> lid{74, 75};
        scene.meshes = {open ? without_triangles(outer, lid) : outer, inner};
        scene.instances.resize(2);
        scene.instances[1].mesh = 1;
        const Certified one = certified(scene, 160, 128, 4);
        const std::array<int, 1> inside{1};
        INFO(open);
        CHECK((one.certificate.count(TriangleStatus::hidden, inside) == inner.indices.size() / 3) == !open);
        CHECK((one.certificate.count(TriangleStatus::seen, inside) > 0) == open);
    }
}

TEST_CASE("certificate: every number of threads gives the same one", "[look]") {
    for (const std::uint64_t seed : {3, 4, 5}) {
        const Certificate expected = certified(random_model(seed), 160, 128, 4, 24, 1).certificate;
        for (const int threads : {2, 3, 8}) {
            const Certificate found = certified(random_model(seed), 160, 128, 4, 24, threads).certificate;
            INFO("model " << seed << ", threads " << threads);
            REQUIRE(found.triangles.size() == expected.triangles.size());
            std::size_t other = 0;
            for (std::size_t i = 0; i < found.triangles.size(); ++i) {
                const TriangleView &a = found.triangles[i], &b = expected.triangles[i];
                other += a.status != b.status || a.view != b.view || a.pixels != b.pixels || a.directions != b.directions ? 1 : 0;
            }
            CHECK(other == 0);
            REQUIRE(found.looked.size() == expected.looked.size());
            for (std::size_t i = 0; i < found.looked.size(); ++i) CHECK(found.looked[i].name == expected.looked[i].name);
            REQUIRE(found.shots.size() == expected.shots.size());
            for (std::size_t i = 0; i < found.shots.size(); ++i) {
                CHECK(found.shots[i].name == expected.shots[i].name);
                CHECK(found.shots[i].instance == expected.shots[i].instance);
                CHECK(found.shots[i].triangle == expected.shots[i].triangle);
            }
        }
    }
}

TEST_CASE("certificate: what is called seen with less is shown by a picture that is kept", "[look]") {
    // Few pictures, so that others show more.
    for (const std::uint64_t seed : {3, 4, 5, 6}) {
        const Certified one = certified(random_model(seed), 160, 128, 12, 5);
        std::vector<std::int32_t> most(one.triangles.size(), 0);
        for (const ViewShot& shot : one.certificate.shots) {
            std::vector<std::int32_t> pixels(one.triangles.size(), 0);
            for (std::size_t i = 0; i < shot.instance.size(); ++i)
                if (shot.instance[i] > 0) ++pixels[one.certificate.first[shot.instance[i] - 1] + shot.triangle[i] - 1];
            for (std::size_t i = 0; i < most.size(); ++i) most[i] = std::max(most[i], pixels[i]);
        }
        std::size_t less = 0, unknown = 0;
        for (std::size_t i = 0; i < most.size(); ++i) {
            const TriangleView& claim = one.certificate.triangles[i];
            if (claim.status == TriangleStatus::not_drawn || claim.status == TriangleStatus::no_area) continue;
            INFO("model " << seed << ", triangle " << i);
            CHECK(claim.pixels == most[i]);
            CHECK((claim.status == TriangleStatus::seen) == (most[i] >= 12));
            CHECK((claim.status == TriangleStatus::less) == (most[i] > 0 && most[i] < 12));
            less += claim.status == TriangleStatus::less ? 1 : 0, unknown += claim.status == TriangleStatus::unknown ? 1 : 0;
        }
        CHECK(less > 0);
        CHECK(unknown > 0);
    }
}
