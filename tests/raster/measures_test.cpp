// Measures of surfaces, compared with closed forms of polyhedra and with edges counted one by one.
#include "halflit/measures.hpp"
#include "halflit/shapes.hpp"
#include "sh/mat4.hpp"
#include "sh/trig.hpp"
#include "tests/raster/random_geometry.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

using namespace halflit;
using namespace halflit::raster::test;

namespace {

/// Relative error of measures that float32 positions of built-in shapes allow: some units of 2^-24.
constexpr double kFloatPositions = 1e-6;

Scene scene_of(const Mesh& mesh, const Mat4& place = {}) {
    Scene scene;
    scene.meshes.push_back(mesh);
    scene.instances.push_back({0, place});
    return scene;
}

Measures measured(const Scene& scene) {
    const auto found = measure_geometry(scene);
    REQUIRE(found);
    return *found;
}

Measures measured(const Mesh& mesh, const Mat4& place = {}) { return measured(scene_of(mesh, place)); }

void append(Mesh& mesh, const Mesh& other, Vec3f offset, bool turned = false) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3f p : other.positions) mesh.positions.push_back(p + offset);
    for (std::size_t i = 0; i < other.indices.size(); i += 3)
        for (const std::size_t k : {std::size_t{0}, std::size_t{turned ? 2u : 1u}, std::size_t{turned ? 1u : 2u}})
            mesh.indices.push_back(first + other.indices[i + k]);
}

/// Positions and triangles alone, in another order, each triangle beginning at any of its corners; split: with vertices of its own.
Mesh rearranged(Random& random, const Mesh& source, bool split) {
    Mesh mesh;
    mesh.positions = source.positions;
    mesh.indices = source.indices;
    shuffle_triangles(random, mesh);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        for (int turns = random.index(3); turns > 0; --turns) {
            std::swap(mesh.indices[i], mesh.indices[i + 1]);
            std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
        }
    if (!split) return mesh;
    Mesh parted;
    for (const std::uint32_t index : mesh.indices) {
        parted.indices.push_back(static_cast<std::uint32_t>(parted.positions.size()));
        parted.positions.push_back(mesh.positions[index]);
    }
    return parted;
}

void check_counts(const Measures& a, const Measures& b) {
    CHECK(a.triangles == b.triangles);
    CHECK(a.degenerate_triangles == b.degenerate_triangles);
    CHECK(a.not_finite_triangles == b.not_finite_triangles);
    CHECK(a.bodies == b.bodies);
    CHECK(a.open_edges == b.open_edges);
    CHECK(a.flipped_edges == b.flipped_edges);
    CHECK(a.crowded_edges == b.crowded_edges);
    CHECK(a.watertight == b.watertight);
}

void check_near(Vec3d found, Vec3d expected, double error) {
    CHECK(std::abs(found.x - expected.x) <= error);
    CHECK(std::abs(found.y - expected.y) <= error);
    CHECK(std::abs(found.z - expected.z) <= error);
}

void check_sound(const Measures& m, std::uint64_t bodies = 1) {
    CHECK(m.watertight);
    CHECK(m.bodies == bodies);
    CHECK(m.open_edges + m.flipped_edges + m.crowded_edges + m.degenerate_triangles + m.not_finite_triangles == 0);
}

/// A regular prism of n sides, its axis along y from 0 to `height`; caps are fans around a corner.
Mesh prism(std::uint32_t n, double radius, double height) {
    Mesh mesh;
    for (const double y : {0.0, height})
        for (std::uint32_t i = 0; i < n; ++i) {
            const double angle = 2 * kPi * i / n;
            mesh.positions.push_back(
                {static_cast<float>(radius * std::sin(angle)), static_cast<float>(y), static_cast<float>(radius * std::cos(angle))});
        }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t next = (i + 1) % n;
        mesh.indices.insert(mesh.indices.end(), {i, next, n + next, i, n + next, n + i});
        if (i > 0 && next > 0) mesh.indices.insert(mesh.indices.end(), {0, next, i, n, n + i, n + next});
    }
    return mesh;
}

}  // namespace

TEST_CASE("measures: a box has the closed form's, scaled, mirrored and turned", "[raster][measures]") {
    const Mesh box = make_box({1, 2, 3});
    const Measures m = measured(box);
    check_sound(m);
    CHECK(m.triangles == 12);
    CHECK(m.volume == Approx(48).epsilon(1e-14));
    CHECK(m.area == Approx(88).epsilon(1e-14));
    CHECK(m.min == Vec3d{-1, -2, -3});
    CHECK(m.max == Vec3d{1, 2, 3});
    CHECK(m.size() == Vec3d{2, 4, 6});
    check_near(m.center, {0, 0, 0}, 1e-14);

    // Mirrored instances keep their outside, as they do where they are drawn.
    const Measures mirrored = measured(box, translation({10, 0, 0}) * scaling({-2, 3, 0.5f}));
    check_sound(mirrored);
    CHECK(mirrored.volume == Approx(48 * 3).epsilon(1e-14));
    CHECK(mirrored.area == Approx(2 * (4 * 12 + 12 * 3 + 3 * 4)).epsilon(1e-14));
    check_near(mirrored.center, {10, 0, 0}, 1e-13);
    CHECK(mirrored.size() == Vec3d{4, 12, 3});

    Random random(11);
    for (int i = 0; i < 100; ++i) {
        const Mat4 place = random_place(random, 100, random_decades(random, 1e-3, 1e3));
        const Measures moved = measured(box, place);
        check_sound(moved);
        CHECK(moved.volume == Approx(48 * std::abs(determinant3(place))).epsilon(1e-9));  // flat boxes far away: 1e-16 of 100 / 1e-5
        check_near(moved.center, axis(place, 3), 1e-10 * (100 + length(moved.size())));
    }
}

TEST_CASE("measures: a surface that is turned inside out has the negative volume", "[raster][measures]") {
    Mesh box;
    append(box, make_box({1, 2, 3}), {5, 0, 0}, true);
    const Measures m = measured(box);
    check_sound(m);
    CHECK(m.volume == Approx(-48).epsilon(1e-14));
    check_near(m.center, {5, 0, 0}, 1e-13);
}

TEST_CASE("measures: a sphere of slices and stacks has its polyhedron's, and tends to the sphere's", "[raster][measures]") {
    const auto error_of = [](int slices, int stacks) {
        const double radius = 1.5, n = slices;
        double volume = 0, area = 0;
        for (int i = 0; i < stacks; ++i) {  // frusta of regular pyramids
            const double a = kPi * i / stacks, b = kPi * (i + 1) / stacks, h = radius * (std::cos(a) - std::cos(b));
            const double r = radius * std::sin(a), s = radius * std::sin(b);
            volume += h / 3 * (0.5 * n * std::sin(2 * kPi / n)) * (r * r + r * s + s * s);
            area += n * std::sin(kPi / n) * (r + s) * std::hypot(h, (s - r) * std::cos(kPi / n));
        }
        const Measures m = measured(make_sphere(1.5f, slices, stacks));
        check_sound(m);
        CHECK(m.volume == Approx(volume).epsilon(kFloatPositions));
        CHECK(m.area == Approx(area).epsilon(kFloatPositions));
        check_near(m.center, {0, 0, 0}, kFloatPositions);
        return 4 * kPi / 3 * radius * radius * radius - m.volume;
    };
    error_of(3, 2);
    error_of(7, 11);
    const double coarse = error_of(64, 32), fine = error_of(128, 64);
    CHECK(coarse / fine == Approx(4).epsilon(0.01));  // second order in the angles
}

TEST_CASE("measures: a torus and a prism have the closed forms of their polyhedra", "[raster][measures]") {
    for (const auto& [slices, sides] : {std::pair(3, 3), std::pair(16, 8), std::pair(101, 37)}) {
        // Pappus for chords: each slice cuts a polygon at the angle 2 pi / n, and has the area sin(2 pi / n) / 2 r^2 at each height.
        const double polygon = 0.5 * sides * 0.25 * std::sin(2 * kPi / sides);
        const Measures m = measured(make_torus(2, 0.5f, slices, sides));
        check_sound(m);
        CHECK(m.volume == Approx(slices * std::sin(2 * kPi / slices) * 2 * polygon).epsilon(kFloatPositions));
        check_near(m.center, {0, 0, 0}, kFloatPositions);
    }
    for (const std::uint32_t n : {3u, 4u, 50u, 1000u}) {
        const double radius = 0.7, height = 3, cap = 0.5 * n * radius * radius * std::sin(2 * kPi / n);
        const Measures m = measured(prism(n, radius, height));
        check_sound(m);
        CHECK(m.triangles == 4 * n - 4);
        CHECK(m.volume == Approx(cap * height).epsilon(kFloatPositions));
        CHECK(m.area == Approx(2 * cap + n * 2 * radius * std::sin(kPi / n) * height).epsilon(kFloatPositions));
        check_near(m.center, {0, height / 2, 0}, kFloatPositions);
    }
}

TEST_CASE("measures: boxes that touch along an edge or a face are one body, at a corner two", "[raster][measures]") {
    const Mesh box = make_box({1, 1, 1});
    const auto pair = [&](Vec3f offset) {
        Mesh two;
        append(two, box, {});
        append(two, box, offset);
        const Measures m = measured(two);
        CHECK(m.watertight);
        CHECK(m.volume == Approx(16).epsilon(1e-14));
        CHECK(m.area == Approx(48).epsilon(1e-14));
        CHECK(m.open_edges + m.flipped_edges == 0);
        return m;
    };
    CHECK(pair({3, 0, 0}).bodies == 2);
    CHECK(pair({2, 2, 2}).bodies == 2);
    const Measures edge = pair({2, 2, 0}), face = pair({2, 0, 0});
    CHECK(edge.bodies == 1);
    CHECK(edge.crowded_edges == 1);
    CHECK(face.bodies == 1);
    CHECK((face.crowded_edges == 4 || face.crowded_edges == 5));  // 5: the diagonals of the common face are the same
}

TEST_CASE("measures: a cavity is taken off, and moves the centre away", "[raster][measures]") {
    Mesh shell;
    append(shell, make_box({2, 2, 2}), {});
    append(shell, make_box({1, 1, 1}), {0.5f, 0, 0}, true);
    const Measures m = measured(shell);
    check_sound(m, 2);
    CHECK(m.volume == Approx(64 - 8).epsilon(1e-14));
    CHECK(m.area == Approx(96 + 24).epsilon(1e-14));
    check_near(m.center, {-8 * 0.5 / 56, 0, 0}, 1e-14);
}

TEST_CASE("measures: edges tell why a surface is not watertight", "[raster][measures]") {
    Mesh box = make_box({1, 1, 1});
    SECTION("a face is missing") {
        box.indices.resize(30);
        const Measures m = measured(box);
        CHECK_FALSE(m.watertight);
        CHECK(m.open_edges == 4);
        CHECK(m.flipped_edges + m.crowded_edges == 0);
        CHECK(m.area == Approx(20).epsilon(1e-14));
        CHECK(length(m.center) == Approx(0.2).epsilon(1e-14));  // of the area: five faces, without the one at distance 1
    }
    SECTION("a triangle is flipped") {
        std::swap(box.indices[0], box.indices[1]);
        const Measures m = measured(box);
        CHECK_FALSE(m.watertight);
        CHECK(m.flipped_edges == 3);
        CHECK(m.open_edges + m.crowded_edges == 0);
        CHECK(m.bodies == 1);
    }
    SECTION("a fin stands on an edge") {
        const std::uint32_t a = box.indices[0], b = box.indices[1];
        box.indices.insert(box.indices.end(), {a, b, static_cast<std::uint32_t>(box.positions.size())});
        box.positions.push_back({5, 5, 5});
        const Measures m = measured(box);
        CHECK_FALSE(m.watertight);
        CHECK(m.open_edges == 2);
        CHECK(m.crowded_edges == 1);
        CHECK(m.bodies == 1);
    }
    SECTION("a sheet with two sides is closed, without a volume") {
        Mesh sheet;
        append(sheet, make_plane(1, 1), {});
        append(sheet, make_plane(1, 1), {}, true);
        const Measures m = measured(sheet, translation({3, 1, 0}));
        CHECK(m.watertight);
        CHECK(m.volume == 0.0);
        CHECK(m.crowded_edges == 1);  // the diagonal, of four triangles
        check_near(m.center, {3, 1, 0}, 1e-14);
    }
}

TEST_CASE("measures: meshes of one part are closed together, and parts with other transforms are apart", "[raster][measures]") {
    Mesh upper = make_box({1, 1, 1}), lower = upper;
    upper.indices.resize(18);
    lower.indices.erase(lower.indices.begin(), lower.indices.begin() + 18);
    Scene scene;
    scene.meshes = {upper, lower};
    const Mat4 place = translation({0.1f, 7, 0}) * rotation(Vec3f{1, 2, 3}, 0.7f);
    scene.instances = {{0, place}, {1, place}};
    const Measures both = measured(scene);
    check_sound(both);
    CHECK(both.volume == Approx(8).epsilon(1e-6));  // of a float32 rotation
    const int first[] = {0};
    const auto half = measure_geometry(scene, first);
    REQUIRE(half);
    CHECK_FALSE(half->watertight);
    CHECK(half->open_edges > 0);
    CHECK(half->area == Approx(both.area / 2).epsilon(1e-6));

    // A box of two meshes, and two boxes that touch it and each other.
    scene.meshes.push_back(make_box({1, 1, 1}));
    scene.instances = {{0, {}}, {1, {}}, {2, translation({2, 0, 0})}, {2, translation({4, 0, 0})}};
    const Measures apart = measured(scene);
    check_sound(apart, 3);
    CHECK(apart.volume == Approx(24).epsilon(1e-14));
    CHECK(apart.size() == Vec3d{6, 2, 2});
    check_near(apart.center, {2, 0, 0}, 1e-14);
    const int all[] = {3, 1, 2, 0};
    const auto joined = measure_geometry(scene, all);
    REQUIRE(joined);
    CHECK(joined->bodies == 1);
    CHECK(joined->watertight);
    CHECK(joined->volume == Approx(24).epsilon(1e-14));
    scene.meshes[1].indices.resize(15);
    CHECK_FALSE(measured(scene).watertight);
}

TEST_CASE("measures: hidden instances, lines, points and shadow catchers do not count", "[raster][measures]") {
    Scene scene = scene_of(make_box({1, 1, 1}));
    const Measures box = measured(scene);
    Mesh lines = make_box({9, 9, 9}), points = lines;
    lines.topology = Topology::lines;
    points.topology = Topology::points;
    scene.meshes.insert(scene.meshes.end(), {lines, points, make_plane(9, 2)});
    scene.materials.resize(1);
    scene.materials[0].shadow_catcher = true;
    scene.instances.push_back({1, {}});
    scene.instances.push_back({2, {}});
    scene.instances.push_back({3, {}});
    scene.instances.back().material = 0;
    scene.instances.push_back({0, translation({5, 0, 0})});
    scene.instances.back().visible = false;
    const Measures m = measured(scene);
    check_counts(m, box);
    CHECK(m.size() == box.size());
    const int hidden[] = {4, 3};
    const auto listed = measure_geometry(scene, hidden);
    REQUIRE(listed);
    check_counts(*listed, box);
    CHECK(listed->min == Vec3d{4, -1, -1});
    const Measures none = measured(Scene{});
    CHECK(none.triangles == 0);
    CHECK(none.size() == Vec3d{0, 0, 0});
    CHECK_FALSE(none.watertight);
}

TEST_CASE("measures: triangles without area and those that are not finite are counted", "[raster][measures]") {
    Mesh box = make_box({1, 1, 1});
    // Two corners at one position; then three on a line, whose long edge and two short ones are of no other triangle.
    box.indices.insert(box.indices.end(), {0, 0, 5, 24, 25, 26});
    box.positions.insert(box.positions.end(), {{0, 0, 0}, {0.25f, 0, 0}, {1, 0, 0}});
    const Measures flat = measured(box);
    CHECK(flat.triangles == 14);
    CHECK(flat.degenerate_triangles == 2);
    CHECK(flat.open_edges == 3);
    CHECK(flat.bodies == 2);
    CHECK(flat.area == Approx(24).epsilon(1e-14));

    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Mesh broken = make_box({1, 1, 1});
        append(broken, make_plane(9, 1), {});
        for (std::size_t i = 24; i < broken.positions.size(); ++i) broken.positions[i].y = bad;
        const Measures m = measured(broken);
        CHECK(m.not_finite_triangles == 2);
        CHECK(m.triangles == 14);
        CHECK_FALSE(m.watertight);
        CHECK(m.size() == Vec3d{2, 2, 2});
        CHECK(m.volume == Approx(8).epsilon(1e-14));
        Mat4 lost;
        lost.c[3].x = bad;
        CHECK(measured(make_box({1, 1, 1}), lost).not_finite_triangles == 12);
    }
    // Positions at the end of float32's range have finite measures. A place beyond it is not finite.
    const float most = std::numeric_limits<float>::max();
    const Measures huge = measured(make_box({most, most, most}));
    CHECK(huge.watertight);
    CHECK(huge.volume == Approx(8.0 * most * most * most).epsilon(1e-14));
    CHECK(measured(make_box({most, 1, 1}), translation({most, 0, 0})).not_finite_triangles > 0);
}

TEST_CASE("measures: order and splitting of vertices and a move far away change nothing", "[raster][measures]") {
    Random random(12);
    for (int round = 0; round < 60; ++round) {
        Mesh mesh = random_mesh(random, 1500);
        collapse_some(random, mesh);
        const Measures whole = measured(mesh);
        const Measures other = measured(rearranged(random, mesh, round % 2 == 0));
        const double size = length(whole.size());
        check_counts(whole, other);
        CHECK(other.area == Approx(whole.area).epsilon(1e-13));
        CHECK(std::abs(other.volume - whole.volume) <= 1e-13 * whole.area * size);
        CHECK(whole.min == other.min);
        CHECK(whole.max == other.max);
        // Double has 2^-53 of the distance: 4e-9 at 2^25.
        const Vec3f away{0x1p25f, -0x1p24f, 0x1p20f};
        const Measures far = measured(mesh, translation(away));
        CHECK(far.watertight == whole.watertight);
        CHECK(far.bodies == whole.bodies);
        CHECK(std::abs(far.area - whole.area) <= 1e-7 * (whole.area + size));
        CHECK(std::abs(far.volume - whole.volume) <= 1e-7 * (whole.area * size + size * size));
    }
}

TEST_CASE("measures: edges and bodies are those that are counted one by one", "[raster][measures]") {
    Random random(13);
    for (int round = 0; round < 300; ++round) {
        // Triangles between few places, so that edges are open, shared, flipped and crowded.
        const auto places = static_cast<std::uint32_t>(random.integer(3, 40));
        const int count = static_cast<int>(random.integer(1, 60));
        Mesh mesh;
        for (std::uint32_t p = 0; p < places; ++p) mesh.positions.push_back(random_point(random, 1));
        std::vector<std::vector<std::uint32_t>> kept;
        for (int t = 0; t < count; ++t) {
            std::vector<std::uint32_t> triangle;
            for (int k = 0; k < 3; ++k) triangle.push_back(static_cast<std::uint32_t>(random.index(static_cast<int>(places))));
            mesh.indices.insert(mesh.indices.end(), triangle.begin(), triangle.end());
            if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]) kept.push_back(triangle);
        }
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> uses;  // up and down
        for (const auto& t : kept)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = t[k], b = t[(k + 1) % 3];
                (a < b ? uses[{a, b}].first : uses[{b, a}].second) += 1;
            }
        std::uint64_t open = 0, flipped = 0, crowded = 0;
        bool balanced = !kept.empty();
        for (const auto& [edge, use] : uses) {
            const int sum = use.first + use.second;
            open += sum == 1;
            flipped += sum == 2 && use.first != 1;
            crowded += sum > 2;
            balanced = balanced && use.first == use.second;
        }
        // Bodies: labels spread over common edges until nothing changes.
        std::vector<std::size_t> label(kept.size());
        for (std::size_t i = 0; i < label.size(); ++i) label[i] = i;
        const auto common = [&](std::size_t a, std::size_t b) {
            int corners = 0;
            for (const std::uint32_t p : kept[a])
                for (const std::uint32_t q : kept[b]) corners += p == q;
            return corners >= 2;
        };
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t a = 0; a < label.size(); ++a)
                for (std::size_t b = 0; b < label.size(); ++b)
                    if (label[b] > label[a] && common(a, b)) {
                        label[b] = label[a];
                        changed = true;
                    }
        }
        std::uint64_t bodies = 0;
        for (std::size_t i = 0; i < label.size(); ++i) bodies += label[i] == i;
        const Measures m = measured(mesh);
        CHECK(m.open_edges == open);
        CHECK(m.flipped_edges == flipped);
        CHECK(m.crowded_edges == crowded);
        CHECK(m.bodies == bodies);
        CHECK(m.watertight == balanced);
        CHECK(m.degenerate_triangles == static_cast<std::uint64_t>(count) - kept.size());
    }
}

TEST_CASE("measures: a faulty scene or index is refused", "[raster][measures]") {
    Scene scene = scene_of(make_box({1, 1, 1}));
    for (const int number : {-1, 1}) {
        const auto found = measure_geometry(scene, std::span(&number, 1));
        REQUIRE_FALSE(found);
        CHECK(found.error().code == ErrorCode::usage);
        CHECK(found.error().message == "instance " + std::to_string(number) + ", expected an index below 1");
    }
    scene.instances[0].mesh = 3;
    CHECK(measure_geometry(scene).error().message == "instance 0: mesh 3, expected an index below 1");
    scene.instances[0].mesh = 0;
    scene.meshes[0].indices[7] = 24;
    CHECK(measure_geometry(scene).error().code == ErrorCode::bad_input);
    CHECK(measure_geometry(scene).error().message == "mesh 0: vertex 24, expected an index below 24");
}

TEST_CASE("measures: each body has the box, volume and edges of its own, and the instance that begins it", "[raster][measures]") {
    // In one mesh: a box, two boxes that touch along an edge, an open box. Another instance: a box, turned inside out.
    Mesh mesh, inside_out;
    const Mesh box = make_box({0.5f, 0.5f, 0.5f});
    append(mesh, box, {0, 0, 0});
    append(mesh, box, {10, 0, 0});
    append(mesh, box, {11, 1, 0});
    append(mesh, box, {20, 0, 0});
    mesh.indices.resize(mesh.indices.size() - 3);
    append(inside_out, box, {30, 0, 0}, true);
    Scene scene;
    scene.meshes = {mesh, inside_out};
    Mat4 moved;
    moved.c[3] = {0, 5, 0, 1};
    scene.instances = {{0, {}}, {1, moved}};
    const auto found = measure_bodies(scene, 10);
    REQUIRE(found);
    const auto& bodies = found->bodies;
    REQUIRE(bodies.size() == 4);
    CHECK(found->all.bodies == 4);
    const double middles[] = {0, 10.5, 20, 30};
    const double volumes[] = {1, 2, 0, -1};
    for (std::size_t i = 0; i < 4; ++i) {
        INFO(i);
        const Measures& one = bodies[i].measures;
        CHECK(bodies[i].instance == (i == 3 ? 1u : 0u));
        CHECK(one.bodies == 1);
        CHECK((one.min.x + one.max.x) * 0.5 == middles[i]);
        CHECK(one.size().x == (i == 1 ? 2 : 1));
        CHECK((one.min.y + one.max.y) * 0.5 == (i == 3 ? 5 : i == 1 ? 0.5 : 0));
        CHECK(one.watertight == (i != 2));
        CHECK(one.open_edges == (i == 2 ? 3u : 0u));
        CHECK(one.crowded_edges == (i == 1 ? 1u : 0u));
        CHECK(one.triangles == (i == 1 ? 24u : i == 2 ? 11u : 12u));
        if (i != 2) CHECK(std::abs(one.volume - volumes[i]) < 1e-12);
        if (i != 2) CHECK(std::abs(one.center.x - middles[i]) < 1e-9);
    }
    // A list that ends before the bodies do has the same first ones.
    for (const std::size_t most : {std::size_t{0}, std::size_t{1}, std::size_t{3}}) {
        const auto fewer = measure_bodies(scene, most);
        REQUIRE(fewer);
        REQUIRE(fewer->bodies.size() == most);
        CHECK(fewer->all.volume == found->all.volume);
        CHECK(fewer->all.bodies == 4);
        for (std::size_t i = 0; i < most; ++i) CHECK(fewer->bodies[i].measures.volume == bodies[i].measures.volume);
    }
}

TEST_CASE("measures: bodies of random surfaces add up to the whole", "[raster][measures]") {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        Random random(seed);
        Mesh mesh;
        for (int i = 0; i < 6; ++i)
            append(mesh, make_box({0.5f, 0.5f, 0.5f}), {static_cast<float>(random.index(4)), static_cast<float>(random.index(4)), 0});
        mesh = rearranged(random, mesh, true);
        mesh.indices.resize(mesh.indices.size() - 3 * static_cast<std::size_t>(random.index(5)));
        const auto found = measure_bodies(scene_of(mesh), 1000);
        REQUIRE(found);
        INFO(seed);
        REQUIRE(found->bodies.size() == found->all.bodies);
        double area = 0;
        std::uint64_t triangles = 0, open = 0, flipped = 0, crowded = 0;
        bool watertight = true;
        for (const Body& body : found->bodies) {
            area += body.measures.area;
            triangles += body.measures.triangles;
            open += body.measures.open_edges, flipped += body.measures.flipped_edges, crowded += body.measures.crowded_edges;
            watertight = watertight && body.measures.watertight;
        }
        CHECK(std::abs(area - found->all.area) < 1e-9 * found->all.area);
        CHECK(triangles == found->all.triangles);
        CHECK(open == found->all.open_edges);
        CHECK(flipped == found->all.flipped_edges);
        CHECK(crowded == found->all.crowded_edges);
        CHECK(watertight == found->all.watertight);
    }
}
