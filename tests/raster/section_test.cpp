#include "halflit/section.hpp"

#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "raster/geometry/section_fill.hpp"
#include "raster/geometry/section_mesh.hpp"
#include "raster/scene/placed_point.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <tuple>
#include <utility>

using namespace halflit;
using namespace halflit::raster;

namespace {

Scene scene_of(const std::vector<std::pair<Mesh, Mat4>>& bodies) {
    Scene scene;
    scene.materials.emplace_back();
    for (const auto& body : bodies) {
        scene.meshes.push_back(body.first);
        scene.meshes.back().material = 0;
        scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, body.second});
    }
    return scene;
}

Mesh turned_inside_out(Mesh mesh) {
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    for (Vec3f& n : mesh.normals) n = n * -1.0f;
    return mesh;
}

Mesh joined(Mesh a, const Mesh& b, Vec3f offset = {}) {
    const auto first = static_cast<std::uint32_t>(a.positions.size());
    for (const Vec3f& p : b.positions) a.positions.push_back(p + offset);
    for (const std::uint32_t i : b.indices) a.indices.push_back(first + i);
    a.normals.clear();
    a.uv0.clear();
    return a;
}

/// Prism of an n-gon of radius 1 around y, from -1 to 1.
Mesh prism(int n) {
    Mesh mesh;
    for (int i = 0; i < n; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / n;
        for (const float y : {-1.0f, 1.0f})
            mesh.positions.push_back({static_cast<float>(std::cos(angle)), y, static_cast<float>(std::sin(angle))});
    }
    mesh.positions.push_back({0, -1, 0});
    mesh.positions.push_back({0, 1, 0});
    const auto count = static_cast<std::uint32_t>(n);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % count);
        mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1, a, b + 1, b, a, b, 2 * count, a + 1, 2 * count + 1, b + 1});
    }
    return mesh;
}

double ngon_area(int n, double radius = 1.0) { return 0.5 * n * radius * radius * std::sin(2.0 * std::numbers::pi / n); }

/// A sphere whose vertices are moved along their radii at random; equal positions stay equal.
Mesh bumpy(std::mt19937& random, float radius, int slices, float depth) {
    Mesh mesh = make_sphere(radius, slices, slices / 2);
    std::map<std::tuple<float, float, float>, float> factors;
    for (Vec3f& p : mesh.positions) {
        const auto found = factors.try_emplace({p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}, 0.0f);
        if (found.second) found.first->second = 1.0f + depth * (static_cast<float>(random() % 2001) / 1000.0f - 1.0f);
        p = p * found.first->second;
    }
    return mesh;
}

Vec3d corner(const Scene& scene, const Instance& instance, std::size_t i) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    return placed_in_double(instance.world_from_object, mesh.positions[mesh.indices[i]]);
}

/// Volume inside of what is visible, caps included, by the divergence theorem.
double volume(const Scene& scene) {
    double sum = 0.0;
    for (const Instance& instance : scene.instances) {
        if (!instance.visible) continue;
        const std::size_t count = scene.meshes[static_cast<std::size_t>(instance.mesh)].indices.size();
        for (std::size_t i = 0; i + 2 < count; i += 3)
            sum += dot(corner(scene, instance, i), cross(corner(scene, instance, i + 1), corner(scene, instance, i + 2)));
    }
    return sum / 6.0;
}

/// Directed edges of what is visible that have no opposite, by the bits of their ends in object space.
int open_edges(const Scene& scene) {
    using Point = std::tuple<float, float, float>;
    std::map<std::pair<Point, Point>, int> edges;
    for (const Instance& instance : scene.instances) {
        if (!instance.visible) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
            for (std::size_t c = 0; c < 3; ++c) {
                const auto point = [&](std::size_t k) {
                    const Vec3f p = mesh.positions[mesh.indices[i + k % 3]];
                    return Point{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
                };
                const Point a = point(c), b = point(c + 1);
                if (a == b) continue;
                if (a < b)
                    ++edges[{a, b}];
                else
                    --edges[{b, a}];
            }
    }
    int open = 0;
    for (const auto& edge : edges) open += std::abs(edge.second);
    return open;
}

SectionReport cut(Scene& scene, const std::vector<CutPlane>& planes, std::span<const int> parts = {}) {
    const auto report = cut_scene(scene, planes, {}, parts);
    REQUIRE(report);
    return *report;
}

double area_of_cut(Scene scene, const CutPlane& plane, std::span<const int> parts = {}) { return cut(scene, {plane}, parts).area(); }

/// Winding number of a surface around a point, by the solid angles of its triangles [van Oosterom and Strackee 1983].
double winding(const Scene& scene, Vec3d p) {
    double sum = 0.0;
    for (const Instance& instance : scene.instances) {
        const std::size_t count = scene.meshes[static_cast<std::size_t>(instance.mesh)].indices.size();
        for (std::size_t i = 0; i + 2 < count; i += 3) {
            const Vec3d a = corner(scene, instance, i) - p, b = corner(scene, instance, i + 1) - p, c = corner(scene, instance, i + 2) - p;
            const double la = length(a), lb = length(b), lc = length(c);
            sum += 2.0 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
        }
    }
    return sum / (4.0 * std::numbers::pi);
}

/// Number of triangles of caps around a point of the plane.
int covered(const Scene& scene, const SectionReport& report, Vec3d p, Vec3d normal) {
    int count = 0;
    for (const SectionCut& one : report.cuts) {
        if (one.cap < 0) continue;
        const Instance& instance = scene.instances[static_cast<std::size_t>(one.cap)];
        const std::size_t indices = scene.meshes[static_cast<std::size_t>(instance.mesh)].indices.size();
        for (std::size_t i = 0; i + 2 < indices; i += 3) {
            const Vec3d a = corner(scene, instance, i), b = corner(scene, instance, i + 1), c = corner(scene, instance, i + 2);
            count += dot(cross(b - a, p - a), normal) > 0 && dot(cross(c - b, p - b), normal) > 0 && dot(cross(a - c, p - c), normal) > 0;
        }
    }
    return count;
}

/// Instances that an orthographic picture of [-1, 1] x [-1, 1] shows, seen from +z; plus 1, 0: none.
std::vector<std::uint32_t> seen_from_z(const Scene& scene, int size) {
    Camera camera;
    camera.world_from_camera = look_at({0, 0, 10}, {0, 0, 0});
    camera.orthographic = true;
    camera.half_height = 1.0f;
    camera.far_z = 20.0f;
    std::vector<std::uint32_t> numbers(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    Image image = Image::make(size, size);
    Target target = image.target();
    target.instance = numbers.data();
    const auto report = render(scene, scene, camera, {}, target);
    REQUIRE(report);
    return numbers;
}

}  // namespace

TEST_CASE("section: planes through a cube cut squares and the regular hexagon", "[raster][section]") {
    const Scene cube = scene_of({{make_box({1, 1, 1}), Mat4{}}});
    for (const double offset : {-0.75, 0.0, 0.3, 0.999}) {
        INFO(offset);
        CHECK(area_of_cut(cube, {{1, 0, 0}, offset}) == Approx(4.0).epsilon(1e-6));
        CHECK(area_of_cut(cube, {{0, -3, 0}, 3 * offset}) == Approx(4.0).epsilon(1e-6));
    }
    // Side sqrt(2): 3 sqrt(3) / 2 times its square.
    CHECK(area_of_cut(cube, {{1, 1, 1}, 0.0}) == Approx(3.0 * std::sqrt(3.0)).epsilon(1e-6));
    // A corner at distance h from the plane: a triangle of area 3 sqrt(3) / 2 h^2.
    const double h = 0.5;
    CHECK(area_of_cut(cube, {{1, 1, 1}, 3.0 - h * std::sqrt(3.0)}) == Approx(1.5 * std::sqrt(3.0) * h * h).epsilon(1e-6));
    CHECK(area_of_cut(cube, {{1, 1, 0}, 0.0}) == Approx(4.0 * std::sqrt(2.0)).epsilon(1e-6));  // through four vertices
    const Scene turned = scene_of({{make_box({1, 1, 1}), translation({3, -2, 5}) * rotation({1, 2, 3}, 0.7f) * scaling({2, 2, -2})}});
    const Vec3d side = to_double(transform_vector(turned.instances[0].world_from_object, {1, 0, 0}));
    CHECK(area_of_cut(turned, {side, dot(side, Vec3d{3, -2, 5}) + 1.0}) == Approx(16.0).epsilon(1e-6));  // mirrored too
}

TEST_CASE("section: prisms and tori have the areas of their polygons", "[raster][section]") {
    for (const int n : {3, 7, 64, 1000}) {
        INFO(n);
        const Scene scene = scene_of({{prism(n), Mat4{}}});
        CHECK(area_of_cut(scene, {{0, 1, 0}, 0.25}) == Approx(ngon_area(n)).epsilon(1e-6));
        CHECK(area_of_cut(scene, {{0, -1, 0}, 0.5}) == Approx(ngon_area(n)).epsilon(1e-6));
    }
    const Scene torus = scene_of({{make_torus(1.0f, 0.25f, 48, 24), Mat4{}}});
    CHECK(area_of_cut(torus, {{1, 0, 0}, 0.0}) == Approx(2.0 * ngon_area(24, 0.25)).epsilon(1e-6));  // through vertices
    CHECK(area_of_cut(torus, {{0, 1, 0}, 0.0}) == Approx(ngon_area(48, 1.25) - ngon_area(48, 0.75)).epsilon(1e-6));
}

TEST_CASE("section: the nonzero rule makes voids of reversed shells and one body of nested ones", "[raster][section]") {
    const Mesh outer = make_box({1, 1, 1}), inner = make_box({0.5f, 0.25f, 0.5f});
    const CutPlane plane{{0, 0, 1}, 0.0};
    CHECK(area_of_cut(scene_of({{joined(outer, turned_inside_out(inner)), Mat4{}}}), plane) == Approx(4.0 - 0.5).epsilon(1e-6));
    CHECK(area_of_cut(scene_of({{joined(outer, inner), Mat4{}}}), plane) == Approx(4.0).epsilon(1e-6));
    CHECK(area_of_cut(scene_of({{joined(outer, outer, {1, 1, 0}), Mat4{}}}), plane) == Approx(7.0).epsilon(1e-6));  // they cross
    CHECK(area_of_cut(scene_of({{joined(outer, outer), Mat4{}}}), plane) == Approx(4.0).epsilon(1e-6));             // twice
    CHECK(area_of_cut(scene_of({{turned_inside_out(outer), Mat4{}}}), plane) == Approx(4.0).epsilon(1e-6));
}

TEST_CASE("section: an open body is said to be open and has no cap, a closed one of the same part has", "[raster][section]") {
    Mesh open = make_box({1, 1, 1});
    open.indices.resize(open.indices.size() - 6);  // without a side
    bool found_open = false;
    for (const Vec3d normal : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
        Scene scene = scene_of({{open, Mat4{}}});
        const SectionReport report = cut(scene, {{normal, 0.1}});
        REQUIRE(report.cuts.size() == 1);
        if (report.cuts[0].closed) {
            CHECK(report.cuts[0].area == Approx(4.0));
            continue;
        }
        found_open = true;
        CHECK(report.cuts[0].open_ends == 2);
        CHECK(report.cuts[0].area == 0.0);
        CHECK(report.cuts[0].cap == -1);
        CHECK(report.instances_cut == 1);
        // A closed box of the same part is capped all the same.
        const double along = dot(normal, Vec3d{0.1, 0.1, 0.1});
        const Mat4 aside = translation(to_float(Vec3d{along, along, along} + (Vec3d{1, 1, 1} - normal) * 4.0));
        Scene both = scene_of({{open, Mat4{}}, {make_box({0.5f, 0.5f, 0.5f}), aside}});
        const int one_part[] = {4, 4};
        const SectionReport capped = cut(both, {{normal, 0.1}}, one_part);
        REQUIRE(capped.cuts.size() == 1);
        CHECK(capped.cuts[0].part == 4);
        CHECK_FALSE(capped.cuts[0].closed);
        CHECK(capped.cuts[0].cap == 2);
        CHECK(capped.area() == Approx(1.0).epsilon(1e-6));
    }
    CHECK(found_open);
}

TEST_CASE("section: instances of one part are closed together, alone they are open", "[raster][section]") {
    Mesh first = make_box({1, 1, 1}), second = first;
    first.indices.resize(18);
    second.indices.erase(second.indices.begin(), second.indices.begin() + 18);
    const Scene scene = scene_of({{first, Mat4{}}, {second, Mat4{}}});
    const CutPlane plane{{1, 1, 1}, 0.0};
    const int together[] = {0, 0};
    Scene alone = scene, whole = scene;
    for (const SectionCut& one : cut(alone, {plane}).cuts) CHECK_FALSE(one.closed);
    const SectionReport report = cut(whole, {plane}, together);
    REQUIRE(report.cuts.size() == 1);
    CHECK(report.cuts[0].closed);
    CHECK(report.cuts[0].instance == 0);
    CHECK(report.cuts[0].cap == 2);
    CHECK(report.area() == Approx(3.0 * std::sqrt(3.0)).epsilon(1e-6));
    CHECK(open_edges(whole) == 0);
}

TEST_CASE("section: faces on the plane neither double the cap nor leave a hole", "[raster][section]") {
    const Mesh box = make_box({1, 1, 1});
    Scene below = scene_of({{box, Mat4{}}});
    CHECK(cut(below, {{{0, 1, 0}, 1.0}}).cuts.empty());  // it lies below the plane and touches it
    CHECK(below.instances[0].mesh == 0);
    CHECK(below.meshes.size() == 1);
    Scene above = scene_of({{box, Mat4{}}});
    const SectionReport gone = cut(above, {{{0, 1, 0}, -1.0}});
    CHECK(gone.cuts.empty());
    CHECK(gone.instances_removed == 1);
    CHECK_FALSE(above.instances[0].visible);
    // A box on a larger one, in one part: the plane between them has no cap, and the larger box its top.
    Scene tower = scene_of({{make_box({2, 1, 2}), translation({0, -1, 0})}, {box, translation({0, 1, 0})}});
    const int part[] = {0, 0};
    CHECK(cut(tower, {{{0, 1, 0}, 0.0}}, part).area() == 0.0);
    CHECK(volume(tower) == Approx(32.0).epsilon(1e-6));
    // A plane along the ceiling of a void: what is left is a ring.
    Scene hollow = scene_of({{joined(make_box({2, 2, 2}), turned_inside_out(box)), Mat4{}}});
    CHECK(cut(hollow, {{{0, 1, 0}, 1.0}}).area() == Approx(16.0 - 4.0).epsilon(1e-6));
    CHECK(open_edges(hollow) == 0);
    CHECK(volume(hollow) == Approx(16.0 * 3.0 - 8.0).epsilon(1e-6));
    Scene floor = scene_of({{joined(make_box({2, 2, 2}), turned_inside_out(box)), Mat4{}}});
    CHECK(cut(floor, {{{0, 1, 0}, -1.0}}).area() == Approx(16.0 - 4.0).epsilon(1e-6));  // its floor is a face of its own
    CHECK(volume(floor) == Approx(16.0).epsilon(1e-6));
    CHECK(open_edges(floor) == 0);
}

TEST_CASE("section: what is kept and what is kept of the other side are closed and add up to the whole", "[raster][section]") {
    std::mt19937 random(7);
    for (int trial = 0; trial < 40; ++trial) {
        const Scene whole = scene_of({{bumpy(random, 1.0f, 24, 0.3f), Mat4{}}});
        const auto number = [&] { return static_cast<double>(random() % 2001) / 1000.0 - 1.0; };
        CutPlane plane{{number(), number(), number() + 1.5}, 0.4 * number()};
        if (trial % 4 == 0) plane = {{0, trial % 8 ? 1.0 : -1.0, 0}, 0.0};  // along a ring of vertices, were they not moved
        INFO(trial);
        Scene kept = whole, other = whole;
        const SectionReport report = cut(kept, {plane});
        const SectionReport opposite = cut(other, {{plane.normal * -1.0, -plane.offset}});
        CHECK(open_edges(kept) == 0);
        CHECK(open_edges(other) == 0);
        CHECK(report.area() == Approx(opposite.area()).epsilon(1e-6));
        CHECK(volume(kept) + volume(other) == Approx(volume(whole)).epsilon(1e-6));
        CHECK(volume(kept) > 0.01);
    }
}

TEST_CASE("section: caps cover the points whose winding number is not 0, each once", "[raster][section]") {
    std::mt19937 random(11);
    int inside = 0, outside = 0;
    for (int trial = 0; trial < 12; ++trial) {
        Mesh mesh = bumpy(random, 1.0f, 16, 0.4f);
        const auto number = [&] { return static_cast<double>(random() % 2001) / 1000.0 - 1.0; };
        for (int body = 0; body < 1 + trial % 4; ++body) {
            Mesh more = bumpy(random, 0.6f, 12, 0.3f);
            if (body % 2 == 1) more = turned_inside_out(std::move(more));
            mesh = joined(std::move(mesh), more, to_float(Vec3d{number(), number(), 0.5 * number()}));
        }
        const Scene whole = scene_of({{mesh, Mat4{}}});
        Scene scene = whole;
        const CutPlane plane{{0.1 * number(), 0.2, 1}, 0.2 * number()};
        const SectionReport report = cut(scene, {plane});
        REQUIRE(report.cuts.size() == 1);
        CHECK(report.cuts[0].closed);
        INFO(trial);
        int samples_inside = 0;
        constexpr int kSamples = 400;
        for (int i = 0; i < kSamples; ++i) {
            Vec3d p{2.2 * number(), 2.2 * number(), 0};
            p.z = (plane.offset - plane.normal.x * p.x - plane.normal.y * p.y) / plane.normal.z;
            const bool expected = std::abs(winding(whole, p)) > 0.5;
            (expected ? inside : outside) += 1;
            samples_inside += expected;
            REQUIRE(covered(scene, report, p, plane.normal) == (expected ? 1 : 0));
        }
        // The samples fill the plane evenly: four standard deviations.
        const double share = samples_inside / static_cast<double>(kSamples), field = 4.4 * 4.4 * length(plane.normal) / plane.normal.z;
        CHECK(report.area() == Approx(share * field).margin(4.0 * field * std::sqrt(share * (1.0 - share) / kSamples) + 0.01));
    }
    CHECK(inside > 500);
    CHECK(outside > 500);
}

TEST_CASE("section: several planes keep what all of them keep, at once or one after the other", "[raster][section]") {
    const Scene whole = scene_of({{make_box({1, 1, 1}), Mat4{}}});
    const std::vector<CutPlane> planes{{{1, 0, 0}, 0.25}, {{0, 1, 0}, -0.5}, {{0.3, 0.2, 1}, 0.1}};
    Scene at_once = whole;
    const SectionReport report = cut(at_once, planes);
    REQUIRE(report.cuts.size() == 3);
    Scene in_turn = whole;
    std::vector<int> parts{0};
    double area = 0.0;
    for (const CutPlane& plane : planes) {
        parts.resize(in_turn.instances.size(), 0);
        const SectionReport one = cut(in_turn, {plane}, parts);
        for (const SectionCut& section : one.cuts) CHECK(section.closed);
    }
    for (std::size_t i = 1; i < in_turn.instances.size(); ++i)
        for (std::size_t t = 0; t + 2 < in_turn.meshes[static_cast<std::size_t>(in_turn.instances[i].mesh)].indices.size(); t += 3)
            area += 0.5 * length(cross(corner(in_turn, in_turn.instances[i], t + 1) - corner(in_turn, in_turn.instances[i], t),
                                       corner(in_turn, in_turn.instances[i], t + 2) - corner(in_turn, in_turn.instances[i], t)));
    CHECK(report.area() == Approx(area).epsilon(1e-6));
    CHECK(volume(at_once) == Approx(volume(in_turn)).epsilon(1e-6));
    CHECK(open_edges(in_turn) == 0);
    // x <= 0.25 and y <= -0.5 leave a column of 1.25 x 0.5; the third plane cuts it at the mean height.
    const double height = (0.1 - 0.3 * -0.375 - 0.2 * -0.75) + 1.0;
    CHECK(volume(at_once) == Approx(1.25 * 0.5 * height).epsilon(1e-6));
    Scene twice = whole;
    CHECK(cut(twice, {planes[0], planes[0]}).cuts.size() == 1);
    parts.assign(twice.instances.size(), 0);
    const std::size_t meshes = twice.meshes.size();
    CHECK(cut(twice, {planes[0]}, parts).cuts.empty());
    CHECK(twice.meshes.size() == meshes);
}

TEST_CASE("section: pixels of caps seen along the normal are those of their areas, and touching parts leave no gap", "[raster][section]") {
    constexpr int kSize = 256;
    const Scene whole = scene_of(
        {{make_box({0.25f, 0.5f, 0.5f}), translation({-0.25f, 0, 0})}, {make_box({0.25f, 0.5f, 0.5f}), translation({0.25f, 0, 0})}});
    Scene scene = whole;
    const SectionReport report = cut(scene, {{{0, 0, 1}, 0.125}});
    REQUIRE(report.cuts.size() == 2);
    const std::vector<std::uint32_t> seen = seen_from_z(scene, kSize);
    int counts[2] = {0, 0}, other = 0;
    for (const std::uint32_t n : seen)
        for (std::size_t c = 0; c < 2; ++c) counts[c] += n == static_cast<std::uint32_t>(report.cuts[c].cap) + 1;
    for (int y = kSize / 4; y < 3 * kSize / 4; ++y)
        for (int x = kSize / 4; x < 3 * kSize / 4; ++x) other += seen[static_cast<std::size_t>(y * kSize + x)] <= 2;
    CHECK(counts[0] == kSize * kSize / 8);
    CHECK(counts[1] == kSize * kSize / 8);
    CHECK(other == 0);
    std::mt19937 random(3);
    Scene bumps = scene_of({{bumpy(random, 0.8f, 64, 0.1f), Mat4{}}});
    const SectionReport round = cut(bumps, {{{0, 0, 1}, 0.0}});
    REQUIRE(round.cuts.size() == 1);
    int pixels = 0;
    for (const std::uint32_t n : seen_from_z(bumps, kSize)) pixels += n == static_cast<std::uint32_t>(round.cuts[0].cap) + 1;
    const double pixel = 4.0 / (kSize * kSize);
    CHECK(pixels * pixel == Approx(round.area()).margin(60 * pixel));  // of some 640 along its border, half a pixel each at random
}

TEST_CASE("section: attributes are interpolated, lines are clipped and points dropped", "[raster][section]") {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    mesh.normals = {{0, 0, 1}, {0, 0, 3}, {0, 0, 1}};
    mesh.tangents = {{1, 0, 0, -1}, {1, 0, 0, -1}, {1, 0, 0, -1}};
    mesh.uv0 = {{0, 0}, {1, 0}, {0, 1}};
    mesh.uv1 = {{5, 5}, {9, 5}, {5, 5}};
    mesh.colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}};
    mesh.indices = {0, 1, 2};
    Mesh line = mesh, point = mesh;
    line.topology = Topology::lines;
    line.indices = {0, 1, 1, 2, 0, 2};
    point.topology = Topology::points;
    Scene scene = scene_of({{mesh, Mat4{}}, {line, Mat4{}}, {point, Mat4{}}});
    const SectionReport report = cut(scene, {{{1, 0, 0}, 1.0}});
    CHECK(report.instances_cut == 3);
    const Mesh& kept = scene.meshes[static_cast<std::size_t>(scene.instances[0].mesh)];
    REQUIRE(kept.positions.size() == 4);
    bool found = false;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3f p = kept.positions[i];
        CHECK(kept.uv0[i] == Vec2f{p.x / 4, p.y / 4});
        CHECK(kept.uv1[i] == Vec2f{5 + p.x, 5});
        CHECK(kept.colors[i] == Vec4f{p.x / 4, p.y / 4, 0, 1});
        CHECK(kept.tangents[i].w == -1.0f);
        found = found || (p == Vec3f{1, 0, 0} && kept.normals[i] == Vec3f{0, 0, 1.5f});
    }
    CHECK(found);
    const Mesh& lines = scene.meshes[static_cast<std::size_t>(scene.instances[1].mesh)];
    REQUIRE(lines.indices.size() == 6);
    for (const std::uint32_t i : lines.indices) CHECK(lines.positions[i].x <= 1.0f);
    CHECK(scene.meshes[static_cast<std::size_t>(scene.instances[2].mesh)].indices.size() == 2);
}

TEST_CASE("section: segments that cross everywhere are filled, or said to be too complex", "[raster][section]") {
    std::mt19937 random(5);
    for (const int n : {50, 400}) {
        std::vector<Vec2<double>> points;
        std::vector<PlaneSegment> segments;
        for (int i = 0; i < n; ++i) {
            points.push_back({static_cast<double>(random() % 1000), static_cast<double>(random() % 1000)});
            segments.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>((i + 1) % n)});
        }
        const PlaneFill fill = fill_segments(points, segments);
        CHECK_FALSE(fill.too_complex);
        CHECK(fill.open_ends == 0);
        double sum = 0.0;
        for (std::size_t t = 0; t + 2 < fill.triangles.size(); t += 3) {
            const Vec2<double> a = fill.points[fill.triangles[t]].at, b = fill.points[fill.triangles[t + 1]].at - a,
                               c = fill.points[fill.triangles[t + 2]].at - a;
            sum += 0.5 * (b.x * c.y - b.y * c.x);
        }
        CHECK(sum == Approx(fill.area).epsilon(1e-9));
        int wrong = 0, inside = 0;
        for (int k = 0; k < 500; ++k) {
            const Vec2<double> p{static_cast<double>(random() % 1000) + 0.37, static_cast<double>(random() % 1000) + 0.41};
            int around = 0, covers = 0;
            for (const PlaneSegment& s : segments) {  // crossings of the ray to the right
                const Vec2<double> a = points[s.from], b = points[s.to];
                if ((a.y <= p.y) == (b.y <= p.y)) continue;
                const double x = a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y);
                if (x > p.x) around += a.y <= p.y ? 1 : -1;
            }
            for (std::size_t t = 0; t + 2 < fill.triangles.size(); t += 3) {
                int left = 0;
                for (std::size_t c = 0; c < 3; ++c) {
                    const Vec2<double> a = fill.points[fill.triangles[t + c]].at, b = fill.points[fill.triangles[t + (c + 1) % 3]].at;
                    left += (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0;
                }
                covers += left == 3;
            }
            inside += around != 0;
            wrong += covers != (around != 0 ? 1 : 0);
        }
        CHECK(wrong == 0);
        CHECK(inside > 50);
    }
}

TEST_CASE("section: a finely cut disc has triangles of good shape", "[raster][section]") {
    std::vector<Vec2<double>> points;
    std::vector<PlaneSegment> segments;
    constexpr std::uint32_t kPoints = 2000;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kPoints;
        points.push_back({std::cos(angle), std::sin(angle)});
        segments.push_back({i, (i + 1) % kPoints});
    }
    const PlaneFill fill = fill_segments(points, segments);
    CHECK(fill.area == Approx(ngon_area(kPoints)).epsilon(1e-9));
    CHECK(fill.points.size() < 4 * kPoints);
    double thin = 0.0, sum = 0.0;
    for (std::size_t t = 0; t + 2 < fill.triangles.size(); t += 3) {
        const auto at = [&](std::size_t c) { return fill.points[fill.triangles[t + c % 3]].at; };
        const Vec2<double> b = at(1) - at(0), c = at(2) - at(0);
        const double area = 0.5 * (b.x * c.y - b.y * c.x);
        double longest = 0.0;
        for (std::size_t s = 0; s < 3; ++s) longest = std::max(longest, std::hypot(at(s + 1).x - at(s).x, at(s + 1).y - at(s).y));
        sum += area;
        CHECK(area >= 0.0);
        if (longest * longest > 20.0 * area) thin += area;  // its height is below a tenth of its longest side
    }
    CHECK(sum == Approx(fill.area).epsilon(1e-9));
    CHECK(thin < 0.01 * sum);
}

TEST_CASE("section: wrong planes, settings, parts and meshes are refused and leave the scene as it is", "[raster][section]") {
    Scene scene = scene_of({{make_box({1, 1, 1}), Mat4{}}});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const CutPlane& plane : {CutPlane{{0, 0, 0}, 0}, CutPlane{{nan, 0, 0}, 0}, CutPlane{{1, 0, 0}, nan}})
        CHECK(cut_scene(scene, {&plane, 1}).error().code == ErrorCode::usage);
    const CutPlane plane;
    CHECK(cut_scene(scene, {&plane, 1}, {true, -1.0}).error().code == ErrorCode::usage);
    const int parts[] = {0, 1}, negative[] = {-1};
    CHECK(cut_scene(scene, {&plane, 1}, {}, parts).error().code == ErrorCode::usage);
    CHECK(cut_scene(scene, {&plane, 1}, {}, negative).error().code == ErrorCode::usage);
    scene.meshes[0].indices[4] = 1000;
    CHECK(cut_scene(scene, {&plane, 1}).error().code == ErrorCode::bad_input);
    CHECK(scene.meshes.size() == 1);
    CHECK(scene.materials.size() == 1);
}
