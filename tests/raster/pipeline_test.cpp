// From scene to visible triangles: clipping, culling, binning. Compared with a float64 reference that does none of these.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "tests/raster/debug_view.hpp"
#include "tests/raster/visibility_reference.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;
using halflit::test::camera_at;
using halflit::test::Random;

namespace {

constexpr int kWidth = 96, kHeight = 64;

/// One mesh in world space with one unlit material.
Scene scene_of(Mesh mesh, bool double_sided = true) {
    Scene scene;
    Material material;
    material.unlit = true;
    material.double_sided = double_sided;
    scene.materials.push_back(material);
    mesh.material = 0;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, {}});
    return scene;
}

void add_triangle(Mesh& mesh, Vec3f a, Vec3f b, Vec3f c) {
    for (const Vec3f p : {a, b, c}) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(p);
    }
}

Vec3f random_point(Random& random, double reach) {
    return {random.real32(-reach, reach), random.real32(-reach, reach), random.real32(-reach, reach)};
}

VisibilityView view_of(const Scene& scene, const Camera& camera, int width = kWidth, int height = kHeight, const Region& region = {}) {
    Settings settings;
    settings.region = region;
    const auto view = visibility(scene, camera, settings, width, height);
    REQUIRE(view);
    return *view;
}

Comparison compare(const Scene& scene, const Camera& camera) {
    return compare_visibility(view_of(scene, camera), {0, 0, kWidth, kHeight}, reference_triangles(scene, camera, kWidth, kHeight));
}

struct Total {
    Comparison sum;
    void add(const Comparison& c) {
        sum.pixels += c.pixels;
        sum.covered += c.covered;
        sum.undecided += c.undecided;
        sum.wrong += c.wrong;
        sum.wrong_depth += c.wrong_depth;
    }
    void check(double most_undecided, double least_covered) const {
        INFO("compared " << sum.pixels << ", covered " << sum.covered << ", undecided " << sum.undecided);
        CHECK(sum.wrong == 0);
        CHECK(sum.wrong_depth == 0);
        CHECK(sum.undecided_share() < most_undecided);
        CHECK(sum.covered > least_covered * sum.pixels);
    }
};

int holes(const VisibilityView& view) { return static_cast<int>(std::count(view.triangle.begin(), view.triangle.end(), 0u)); }

}  // namespace

TEST_CASE("pipeline: triangles around and behind the eye are cut where the near plane cuts them", "[raster][pipeline]") {
    Random random(1);
    Total total;
    for (int round = 0; round < 80; ++round) {
        Mesh mesh;
        // The eye is among the triangles: most cross the near plane, many also leave the guard band.
        const double reach = random.chance(0.5) ? 2.0 : 0.3;
        for (int i = 0; i < 12; ++i)
            add_triangle(mesh, random_point(random, reach), random_point(random, reach), random_point(random, reach));
        const Camera camera =
            camera_at(random_point(random, 0.2 * reach), random_point(random, reach), random.real32(0.3, 2.5), random.real32(0.001, 0.2));
        total.add(compare(scene_of(mesh, random.chance(0.7)), camera));
    }
    total.check(0.01, 0.3);
}

TEST_CASE("pipeline: triangles wholly behind the eye are not drawn", "[raster][pipeline]") {
    Random random(2);
    Mesh mesh;
    for (int i = 0; i < 200; ++i) {
        Vec3f p[3];
        for (Vec3f& v : p) v = {random.real32(-5, 5), random.real32(-5, 5), random.real32(0.001, 5)};
        add_triangle(mesh, p[0], p[1], p[2]);
    }
    CHECK(holes(view_of(scene_of(mesh), camera_at({0, 0, 0}, {0, 0, -1}))) == kWidth * kHeight);
}

TEST_CASE("pipeline: a far limit cuts per pixel", "[raster][pipeline]") {
    Random random(3);
    Total total;
    for (int round = 0; round < 40; ++round) {
        Mesh mesh;
        for (int i = 0; i < 10; ++i) add_triangle(mesh, random_point(random, 4), random_point(random, 4), random_point(random, 4));
        Camera camera = camera_at(random_point(random, 3), {0, 0, 0}, 1.2f, 0.05f);
        camera.far_z = random.real32(1, 5);
        if (random.chance(0.4)) {
            camera.orthographic = true;
            camera.half_height = random.real32(0.5, 5);
        }
        total.add(compare(scene_of(mesh), camera));
    }
    total.check(0.01, 0.2);
}

TEST_CASE("pipeline: triangles that leave the guard band keep their shape in the picture", "[raster][pipeline]") {
    Random random(4);
    Total total;
    for (int round = 0; round < 60; ++round) {
        Mesh mesh;
        for (int i = 0; i < 6; ++i) {
            // A corner in view, two far outside: thousands to millions of pixels away.
            const Vec3f a{random.real32(-1, 1), random.real32(-1, 1), random.real32(-4, -1)};
            const double far_away = std::exp2(random.real(6, 22));
            add_triangle(mesh, a, random_point(random, far_away), random_point(random, far_away));
        }
        total.add(compare(scene_of(mesh), camera_at({0, 0, 0}, {0, 0, -1}, random.real32(0.2, 2.0), 0.01f)));
    }
    total.check(0.01, 0.2);
}

TEST_CASE("pipeline: coordinates of ten million agree with the reference, far from the origin and near to it", "[raster][pipeline]") {
    Random random(5);
    Total total;
    for (int round = 0; round < 40; ++round) {
        Mesh mesh;
        const bool at_origin = random.chance(0.5);
        const Vec3f center = at_origin ? Vec3f{0, 0, 0} : random_point(random, 1e7);
        for (int i = 0; i < 10; ++i)
            add_triangle(mesh, center + random_point(random, 1e7), center + random_point(random, 1e7), center + random_point(random, 1e3));
        total.add(compare(scene_of(mesh), camera_at(center + random_point(random, 1e4), center + random_point(random, 1e7), 1.0f,
                                                    random.chance(0.5) ? 0.1f : 100.0f)));
    }
    total.check(0.01, 0.2);
}

TEST_CASE("pipeline: the widest picture, whose border is the guard band's, agrees with the reference", "[raster][pipeline]") {
    Random random(12);
    constexpr int kWide = 2 * 16384, kTall = 40;
    Total total;
    for (int round = 0; round < 12; ++round) {
        Mesh mesh;
        for (int i = 0; i < 12; ++i) {
            // A view of 32768 x 40 pixels that is 2 units high shows 819 units to either side.
            const float x = random.chance(0.5) ? -819.0f : 819.0f;
            const Vec3f a{x + random.real32(-2, 2), random.real32(-1, 1), random.real32(-5, -1)};
            add_triangle(mesh, a, a + random_point(random, 3),
                         a + Vec3f{random.real32(-900, 900), random.real32(-1, 1), random.real32(-900, 0.5)});
        }
        const Scene scene = scene_of(mesh);
        Camera camera;
        camera.orthographic = round % 2 == 0;
        camera.fov_y_rad = 0.5f;
        camera.near_z = 0.1f;
        if (camera.orthographic) camera.far_z = 1000;  // without one, depths would be shares of a distance that the scene decides
        for (const Region region : {Region{0, 0, 70, kTall}, Region{kWide - 70, 0, 70, kTall}})
            total.add(
                compare_visibility(view_of(scene, camera, kWide, kTall, region), region, reference_triangles(scene, camera, kWide, kTall)));
    }
    total.check(0.02, 0.2);
}

TEST_CASE("pipeline: degenerate triangles draw nothing and disturb nothing", "[raster][pipeline]") {
    Random random(6);
    for (int round = 0; round < 20; ++round) {
        Mesh mesh;
        const Vec3f a = random_point(random, 1), b = random_point(random, 1);
        const Vec3f d = (b - a) * 0.5f;  // halves: a + d lies on the line up to one rounding
        add_triangle(mesh, a, a, a);
        add_triangle(mesh, a, b, a);
        add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {2, 0, 0});
        add_triangle(mesh, {0, 0, 5}, {0, 0, -5}, {0, 0, 0});  // through the eye
        const Scene scene = scene_of(mesh);
        CHECK(holes(view_of(scene, camera_at({0, 0, 3}, {0, 0, 0}))) == kWidth * kHeight);
        add_triangle(mesh, a - d, b + d, a + d + Vec3f{0, 0.5f, 0});
        const Comparison c = compare(scene_of(mesh), camera_at({0, 0, 3}, {0, 0, 0}));
        CHECK(c.wrong == 0);
        CHECK(c.wrong_depth == 0);
    }
}

TEST_CASE("pipeline: a camera inside a mesh sees what the reference does", "[raster][pipeline]") {
    Random random(7);
    Total total;
    for (int round = 0; round < 12; ++round) {
        const Mesh mesh = round % 3 == 0   ? make_sphere(1.0f, 12, 7)
                          : round % 3 == 1 ? make_box({0.8f, 1.1f, 0.6f})
                                           : make_torus(1.0f, 0.4f, 14, 9);
        const Vec3f eye = round % 3 == 2 ? Vec3f{1.0f + random.real32(-0.2, 0.2), random.real32(-0.2, 0.2), random.real32(-0.1, 0.1)}
                                         : random_point(random, 0.4);
        total.add(compare(scene_of(mesh, round % 2 == 0),
                          camera_at(eye, random_point(random, 2), random.real32(0.5, 2.4), random.real32(0.005, 0.3))));
    }
    total.check(0.01, 0.3);
}

TEST_CASE("pipeline: a closed box has no crack, seen from inside", "[raster][pipeline]") {
    Random random(8);
    int frames = 0;
    for (const float size : {1e-3f, 1.0f, 1e3f, 1e7f}) {
        for (int round = 0; round < 25; ++round) {
            // Views from corner to corner at wide angles put walls through the near plane and far outside the guard band.
            const Vec3f eye = random_point(random, 0.9) * size;
            const Camera camera = camera_at(eye, eye + random_point(random, 1) * size, random.real32(0.2, 2.8), 0.002f * size);
            const VisibilityView view = view_of(scene_of(make_box({size, size, size})), camera, 160, 100);
            CHECK(holes(view) == 0);
            ++frames;
        }
    }
    CHECK(frames == 100);
}

TEST_CASE("pipeline: a finely divided ground reaches the horizon without a hole", "[raster][pipeline]") {
    Random random(9);
    constexpr int kW = 240, kH = 160;
    for (int round = 0; round < 12; ++round) {
        const float half = round % 3 == 0 ? 1e3f : round % 3 == 1 ? 1e5f : 1e6f;
        const Scene scene = scene_of(make_plane(half, round % 2 ? 301 : 64), false);
        const Vec3f eye{random.real32(-3, 3), 1.7f, random.real32(-3, 3)};
        const double heading = random.real(0, 6.28), pitch = random.real(-0.5, 0.2);
        const Vec3f ahead{static_cast<float>(std::cos(heading) * std::cos(pitch)), static_cast<float>(std::sin(pitch)),
                          static_cast<float>(std::sin(heading) * std::cos(pitch))};
        const Camera camera = camera_at(eye, eye + ahead, random.real32(0.4, 1.8), 0.05f);
        const VisibilityView view = view_of(scene, camera, kW, kH);
        // A pixel shows the ground if the ray through it meets the square. Pixels within 1/64 pixel of the square's rim are left out.
        const Vec4f* axis = camera.world_from_camera.c;
        const double tan_y = std::tan(0.5 * static_cast<double>(camera.fov_y_rad)), tan_x = tan_y * kW / kH;
        int wrong = 0, ground = 0;
        for (int y = 0; y < kH; ++y)
            for (int x = 0; x < kW; ++x) {
                const auto meets = [&](double px, double py) {
                    const double u = (2 * px / kW - 1) * tan_x, v = (1 - 2 * py / kH) * tan_y;
                    const double dx = axis[0].x * u + axis[1].x * v - axis[2].x, dy = axis[0].y * u + axis[1].y * v - axis[2].y,
                                 dz = axis[0].z * u + axis[1].z * v - axis[2].z;
                    if (dy >= 0) return false;
                    const double t = -eye.y / dy;
                    return std::abs(eye.x + t * dx) < half && std::abs(eye.z + t * dz) < half;
                };
                const double c = 1.0 / 64;
                const bool here = meets(x + 0.5, y + 0.5);
                if (meets(x + 0.5 - c, y + 0.5 - c) != here || meets(x + 0.5 + c, y + 0.5 + c) != here ||
                    meets(x + 0.5 - c, y + 0.5 + c) != here || meets(x + 0.5 + c, y + 0.5 - c) != here)
                    continue;
                ground += here;
                wrong += (view.triangle[static_cast<std::size_t>(y * kW + x)] != 0) != here;
            }
        INFO("round " << round);
        CHECK(wrong == 0);
        CHECK(ground > 500);
    }
}

TEST_CASE("pipeline: clipped neighbours cover each pixel once", "[raster][pipeline]") {
    // The ground is half transparent: a pixel that two triangles draw would have alpha 0.75.
    Random random(10);
    for (int round = 0; round < 10; ++round) {
        Mesh mesh = make_plane(50.0f, 24);
        // Moves the points in the plane by less than half a cell, so that edges do not follow the grid's rows.
        for (Vec3f& p : mesh.positions) p = p + Vec3f{random.real32(-0.9, 0.9), 0, random.real32(-0.9, 0.9)};
        Scene scene = scene_of(mesh, false);
        scene.materials[0].alpha_mode = AlphaMode::blend;
        scene.materials[0].base_color = {1, 1, 1, 0.5f};
        const Camera camera =
            camera_at({random.real32(-9, 9), 0.8f, random.real32(-9, 9)}, {random.real32(-50, 50), 0, random.real32(-50, 50)}, 1.5f, 0.02f);
        std::vector<float> linear(4 * 200 * 120);
        REQUIRE(render(scene, camera, {}, {200, 120, nullptr, linear.data()}));
        int once = 0, other = 0;
        for (std::size_t i = 3; i < linear.size(); i += 4) {
            once += linear[i] == 0.5f;
            other += linear[i] != 0.5f && linear[i] != 0.0f;
        }
        CHECK(other == 0);
        CHECK(once > 2000);
    }
}

TEST_CASE("pipeline: colours are perspective-correct, across the near plane and the guard band too", "[raster][pipeline]") {
    Random random(11);
    double worst = 0;
    int compared = 0;
    for (int round = 0; round < 60; ++round) {
        Mesh mesh;
        const double reach = random.chance(0.5) ? 1.0 : 30.0;
        add_triangle(mesh, random_point(random, reach), random_point(random, reach), random_point(random, reach));
        for (int k = 0; k < 3; ++k) mesh.colors.push_back({random.real32(0, 1), random.real32(0, 1), random.real32(0, 1), 1});
        const Scene scene = scene_of(mesh);
        const Camera camera =
            camera_at(random_point(random, 1), mesh.positions[0] * 0.4f + mesh.positions[1] * 0.3f + mesh.positions[2] * 0.3f, 1.2f, 0.01f);
        std::vector<float> linear(4 * kWidth * kHeight);
        REQUIRE(render(scene, camera, {}, {kWidth, kHeight, nullptr, linear.data()}));
        const ReferenceTriangle triangle = reference_triangles(scene, camera, kWidth, kHeight)[0];
        if (!triangle.drawn) continue;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const auto p = triangle.shape.at(x + 0.5, y + 0.5);
                if (std::min({p.edge_px[0], p.edge_px[1], p.edge_px[2], p.near_px}) < kEdgeTolerancePx) continue;
                double slope = 0;  // steepest barycentric coordinate: the effect of moving a corner by part of a pixel
                for (int i = 0; i < 3; ++i) {
                    const auto s = triangle.shape.barycentric_slope(i, x + 0.5, y + 0.5);
                    slope = std::max(slope, std::abs(s.dx) + std::abs(s.dy));
                }
                if (slope > 0.5) continue;  // the triangle has too few pixels across for a comparison
                const float* pixel = &linear[static_cast<std::size_t>(4 * (y * kWidth + x))];
                for (int c = 0; c < 3; ++c) {
                    double want = 0;
                    for (std::size_t k = 0; k < 3; ++k) want += p.barycentric[k] * static_cast<double>((&mesh.colors[k].x)[c]);
                    worst = std::max(worst, std::abs(static_cast<double>(pixel[c]) - want) / (slope * 2 * kEdgeTolerancePx + 1e-5));
                    ++compared;
                }
            }
    }
    CHECK(worst < 1.0);
    CHECK(compared > 50'000);
}
