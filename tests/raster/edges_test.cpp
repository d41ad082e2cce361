// Lines of edges in the picture, compared with closed forms and with edges that rays look for one by one.
#include "halflit/shapes.hpp"
#include "sh/mat4.hpp"
#include "tests/raster/edge_reference.hpp"
#include "tests/support/cameras.hpp"

using namespace halflit;
using namespace halflit::raster::test;

namespace {

constexpr double kPiHere = 3.14159265358979323846;
constexpr int kSize = 256;

Scene scene_of(const Mesh& mesh, const Mat4& place = {}) {
    Scene scene;
    scene.meshes.push_back(mesh);
    scene.instances.push_back({0, place});
    return scene;
}
void add(Scene& scene, const Mesh& mesh, const Mat4& place = {}) {
    scene.meshes.push_back(mesh);
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, place});
}

Settings lines_of(EdgeChoice choice, HiddenEdges hidden = HiddenEdges::none) {
    Settings settings;
    settings.edges = choice;
    settings.hidden_edges = hidden;
    return settings;
}

/// A view of the scene from a side, of a square picture.
Camera view_of(const Scene& scene, double azimuth_deg, double elevation_deg, bool orthographic) {
    ViewSettings view;
    view.azimuth_deg = static_cast<float>(azimuth_deg), view.elevation_deg = static_cast<float>(elevation_deg);
    view.orthographic = orthographic;
    return frame_scene(scene, 1.0f, view);
}

/// Looks from (1, 1, 1) by parallel rays at the origin; half the picture's height is 3 units.
Camera iso_camera() {
    const float a = std::sqrt(0.5f), b = std::sqrt(1.0f / 6.0f), c = std::sqrt(1.0f / 3.0f);
    Camera camera;
    camera.world_from_camera = {{{a, 0, -a, 0}, {-b, 2 * b, -b, 0}, {c, c, c, 0}, {10 * c, 10 * c, 10 * c, 1}}};
    camera.orthographic = true;
    camera.half_height = 3;
    camera.near_z = 0, camera.far_z = 20;
    return camera;
}

/// A cube of side 2 in that view: a regular hexagon around its nearest corner. Vertex k lies at 30 + 60 k degrees.
Point2 hexagon(int k) {
    const double radius = 2.0 * std::sqrt(2.0 / 3.0) * kSize / 6.0, angle = (30 + 60 * k) * kPiHere / 180;
    return {0.5 * kSize + radius * std::cos(angle), 0.5 * kSize - radius * std::sin(angle)};
}
constexpr Point2 kMiddle{0.5 * kSize, 0.5 * kSize};

/// A cylinder around the y axis, from y = -1 to 1, of radius 1.
Mesh cylinder(int sides) {
    Mesh mesh;
    const auto n = static_cast<std::uint32_t>(sides);
    for (std::uint32_t i = 0; i < n; ++i) {
        const double a = 2 * kPiHere * i / n;
        for (const float y : {-1.0f, 1.0f}) mesh.positions.push_back({static_cast<float>(std::sin(a)), y, static_cast<float>(std::cos(a))});
    }
    mesh.positions.push_back({0, -1, 0}), mesh.positions.push_back({0, 1, 0});
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % n);
        for (const std::uint32_t v : {a, b, b + 1, a, b + 1, a + 1, 2 * n, b, a, 2 * n + 1, a + 1, b + 1}) mesh.indices.push_back(v);
    }
    return mesh;
}

/// A square in the plane z = `z` that faces +z.
Mesh square(float half, float z) {
    Mesh mesh;
    mesh.positions = {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

/// A polyline through points of a curve: at(i / count) for i from 0 to count.
template <class At>
void add_curve(std::vector<Segment2>& lines, int count, const At& at) {
    for (int i = 0; i < count; ++i) lines.push_back({at(1.0 * i / count), at((i + 1.0) / count)});
}

/// Half the width, half a pixel, and a sixteenth of one for the ends of lines.
double reach(const Settings& settings) { return 0.5 * double{settings.edge_width} + 0.5 + 1.0 / 16; }

/// Each painted pixel is near a line that rays see, and each point of those is painted.
void check_by_rays(const Scene& scene, const Camera& camera, const Settings& settings, double beside = 0.25) {
    const EdgeReference reference(scene);
    const WindowOf window(camera, kSize, kSize);
    const auto seen = reference.seen_parts(settings.edges, double{settings.edge_angle_deg}, window);
    const Worst worst = compare(cover_of(scene, camera, settings, kSize, kSize), seen);
    CAPTURE(seen.size(), worst.painted, worst.missing, worst.points);
    CHECK(worst.points > 0);
    CHECK(worst.painted <= reach(settings) + beside);  // rays look a quarter of a pixel apart
    CHECK(worst.missing == 0);
}

}  // namespace

TEST_CASE("edges: a cube in the isometric view has nine lines, and three hidden ones, where geometry puts them", "[edges]") {
    const Scene cube = scene_of(make_box({1, 1, 1}));
    std::vector<Segment2> seen, hidden;
    for (int k = 0; k < 6; ++k) {
        seen.push_back({hexagon(k), hexagon(k + 1)});
        (k % 2 == 0 ? seen : hidden).push_back({kMiddle, hexagon(k)});
    }
    const Settings settings = lines_of(EdgeChoice::feature);
    const Cover cover = cover_of(cube, iso_camera(), settings, kSize, kSize);
    const Worst worst = compare(cover, seen);
    CAPTURE(worst.painted, worst.missing, worst.points);
    CHECK(worst.painted <= reach(settings));
    CHECK(worst.missing == 0);

    const Cover all = cover_of(cube, iso_camera(), lines_of(EdgeChoice::feature, HiddenEdges::dashed), kSize, kSize);
    std::vector<Segment2> both = seen;
    both.insert(both.end(), hidden.begin(), hidden.end());
    CHECK(compare(all, both).painted <= reach(settings));
    CHECK(compare(all, seen).missing == 0);
    for (const Segment2& line : hidden) {  // dashes of six widths and gaps of four; the width is a pixel at least
        const double period = 10 * std::max(0.7 * double{settings.edge_width}, 1.0);
        int painted = 0, changes = 0, points = 0;
        bool before = true;
        const double length = line.length();
        for (double at = 4; at < length - 4; at += 0.25, ++points) {
            const Point2 p = line.at(at / length);
            const bool now = std::max({all.at(p), all.at({p.x, p.y - 1}), all.at({p.x, p.y + 1})}) > 0.3;
            painted += now ? 1 : 0, changes += now != before ? 1 : 0, before = now;
        }
        CAPTURE(painted, changes, points);
        CHECK(std::abs(changes - 2 * length / period) <= 3);
        CHECK(painted > 0.5 * points);
        CHECK(painted < 0.8 * points);
    }
}

TEST_CASE("edges: silhouettes of a cube are its outline alone, and all edges are its triangles' too", "[edges]") {
    const Scene cube = scene_of(make_box({1, 1, 1}));
    std::vector<Segment2> outline;
    for (int k = 0; k < 6; ++k) outline.push_back({hexagon(k), hexagon(k + 1)});
    const Worst worst = compare(cover_of(cube, iso_camera(), lines_of(EdgeChoice::silhouette), kSize, kSize), outline);
    CHECK(worst.painted <= reach({}));
    CHECK(worst.missing == 0);
    check_by_rays(cube, iso_camera(), lines_of(EdgeChoice::all));
}

TEST_CASE("edges: a mirrored instance has the lines of its mirror image", "[edges]") {
    Mesh wedge = make_box({1, 0.7f, 0.4f});
    for (Vec3f& p : wedge.positions)
        if (p.x > 0) p.y *= 0.3f, p.z *= 2;
    Mesh image = wedge;
    for (Vec3f& p : image.positions) p.x = -p.x;
    for (std::size_t i = 0; i < image.indices.size(); i += 3) std::swap(image.indices[i], image.indices[i + 1]);
    const Scene mirrored = scene_of(wedge, scaling({-1, 1, 1})), plain = scene_of(image);
    const Camera camera = view_of(plain, 30, 20, false);
    const Settings settings = lines_of(EdgeChoice::feature);
    CHECK(cover_of(mirrored, camera, settings, kSize, kSize).rgba == cover_of(plain, camera, settings, kSize, kSize).rgba);
    check_by_rays(plain, camera, settings);
}

TEST_CASE("edges: boxes, tori and shells have the lines that rays see", "[edges]") {
    std::vector<std::pair<const char*, Scene>> scenes;
    scenes.emplace_back("cube", scene_of(make_box({1, 1, 1})));
    scenes.emplace_back("torus", scene_of(make_torus(1, 0.4f, 48, 24)));
    Scene touching = scene_of(make_box({1, 1, 1}));
    add(touching, make_box({1, 1, 1}), translation({2, 0, 0}));
    add(touching, make_box({0.5f, 0.5f, 0.5f}), translation({0, 1.5f, 0}));
    scenes.emplace_back("touching boxes", touching);
    Scene shell = scene_of(make_box({1, 1, 1}));
    add(shell, make_box({0.5f, 0.5f, 0.5f}));
    scenes.emplace_back("shell", shell);
    for (const auto& [name, scene] : scenes)
        for (const bool orthographic : {false, true})
            for (const double azimuth : {33.0, -118.0}) {
                CAPTURE(name, orthographic, azimuth);
                check_by_rays(scene, view_of(scene, azimuth, 24, orthographic), lines_of(EdgeChoice::feature));
            }
}

TEST_CASE("edges: a box inside of a box is hidden, and dashed on demand", "[edges]") {
    Scene shell = scene_of(make_box({1, 1, 1}));
    const Cover outer = cover_of(shell, iso_camera(), lines_of(EdgeChoice::feature), kSize, kSize);
    add(shell, make_box({0.5f, 0.5f, 0.5f}));
    CHECK(cover_of(shell, iso_camera(), lines_of(EdgeChoice::feature), kSize, kSize).rgba == outer.rgba);
    const Cover dashed = cover_of(shell, iso_camera(), lines_of(EdgeChoice::feature, HiddenEdges::dashed), kSize, kSize);
    int painted = 0;
    for (int k = 0; k < 6; ++k) {
        const Segment2 half{{0.5 * (kMiddle.x + hexagon(k).x), 0.5 * (kMiddle.y + hexagon(k).y)},
                            {0.5 * (kMiddle.x + hexagon(k + 1).x), 0.5 * (kMiddle.y + hexagon(k + 1).y)}};
        for (int i = 0; i < 20; ++i) painted += dashed.at(half.at((i + 0.5) / 20)) > 0 ? 1 : 0;
    }
    CHECK(painted > 60);
}

TEST_CASE("edges: a cylinder shows two rims and two outlines, and no bends of its wall below the angle", "[edges]") {
    Camera camera = halflit::test::camera_flat(2);  // turned down by 30 degrees
    const double e = kPiHere / 6;
    camera.world_from_camera.c[1] = {0, static_cast<float>(std::cos(e)), static_cast<float>(-std::sin(e)), 0};
    camera.world_from_camera.c[2] = {0, static_cast<float>(std::sin(e)), static_cast<float>(std::cos(e)), 0};
    camera.world_from_camera.c[3] = {0, static_cast<float>(10 * std::sin(e)), static_cast<float>(10 * std::cos(e)), 1};
    constexpr double kScale = kSize / 4.0;
    const auto at = [&](double x, double y, double z) {
        return Point2{0.5 * kSize + x * kScale, 0.5 * kSize - (y * std::cos(e) - z * std::sin(e)) * kScale};
    };
    for (const int sides : {12, 64, 500}) {
        std::vector<Segment2> lines;
        add_curve(lines, 720, [&](double t) { return at(std::sin(2 * kPiHere * t), 1, std::cos(2 * kPiHere * t)); });
        add_curve(lines, 360, [&](double t) { return at(std::sin(kPiHere * (t - 0.5)), -1, std::cos(kPiHere * (t - 0.5))); });
        for (const double x : {-1.0, 1.0}) lines.push_back({at(x, 1, 0), at(x, -1, 0)});
        Settings settings = lines_of(EdgeChoice::feature);
        settings.edge_angle_deg = 31;
        settings.edge_width = 3;
        const Worst worst = compare(cover_of(scene_of(cylinder(sides)), camera, settings, kSize, kSize), lines);
        const double sagitta = (1 - std::cos(kPiHere / sides)) * kScale;  // of a side below its arc
        CAPTURE(sides, worst.painted, worst.missing, worst.points, sagitta);
        // The two ends of the lower rim's half are a side off at most.
        CHECK(worst.painted <= reach(settings) + sagitta + (sides == 12 ? 4 : 0.3));
        if (sides > 12) CHECK(worst.missing == 0);
        settings.edge_angle_deg = 29;
        if (sides == 12) CHECK(compare(cover_of(scene_of(cylinder(sides)), camera, settings, kSize, kSize), lines).painted > 10);
    }
}

TEST_CASE("edges: a cylinder whose sides are seen edge-on has its whole outline, from each side", "[edges]") {
    for (const int sides : {4, 6, 30, 90}) {
        Mesh mesh = cylinder(sides);  // with the digits of a text file, by which such sides are edge-on exactly, or nearly
        for (Vec3f& p : mesh.positions) p.x = std::round(p.x * 1e5f) / 1e5f, p.z = std::round(p.z * 1e5f) / 1e5f;
        const Scene scene = scene_of(mesh);
        for (const double azimuth : {0.0, 90.0, 180.0, 270.0, -90.0}) {
            const Camera camera = view_of(scene, azimuth, 0, true);
            const WindowOf window(camera, kSize, kSize);
            Point2 low{1e9, 1e9}, high{-1e9, -1e9};
            for (const Vec3f& p : mesh.positions) {
                const Point2 at = window.point({p.x, p.y, p.z});
                low = {std::min(low.x, at.x), std::min(low.y, at.y)}, high = {std::max(high.x, at.x), std::max(high.y, at.y)};
            }
            std::vector<Segment2> outline{{low, {high.x, low.y}}, {{high.x, low.y}, high}, {high, {low.x, high.y}}, {{low.x, high.y}, low}};
            const Worst worst = compare(cover_of(scene, camera, lines_of(EdgeChoice::silhouette), kSize, kSize), outline);
            CAPTURE(sides, azimuth, worst.painted, worst.missing);
            CHECK(worst.painted <= reach({}));
            CHECK(worst.missing == 0);
        }
    }
}

TEST_CASE("edges: a square in the plane of a larger one shows its whole border", "[edges]") {
    Scene scene = scene_of(square(2, 0));
    add(scene, square(1, 0));
    for (const double azimuth : {0.0, 40.0, 75.0})
        for (const bool orthographic : {false, true}) {
            const Camera camera = view_of(scene, azimuth, 10, orthographic);
            const WindowOf window(camera, kSize, kSize);
            std::vector<Segment2> lines;
            for (const double half : {1.0, 2.0}) {
                const Vec3d c[4] = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
                for (int k = 0; k < 4; ++k) lines.push_back({window.point(c[k]), window.point(c[(k + 1) % 4])});
            }
            const Worst worst = compare(cover_of(scene, camera, lines_of(EdgeChoice::feature), kSize, kSize), lines);
            CAPTURE(azimuth, orthographic, worst.painted, worst.missing);
            CHECK(worst.painted <= reach({}));
            CHECK(worst.missing == 0);
        }
}

TEST_CASE("edges: a surface of triangles below a pixel hides what is behind", "[edges]") {
    for (const int triangles : {20000, 200000, 2000000}) {
        Scene scene = scene_of(make_sphere_of(1, triangles));
        Camera camera = halflit::test::camera_flat(1.5f);
        const Cover alone = cover_of(scene, camera, lines_of(EdgeChoice::feature), kSize, kSize);
        add(scene, make_box({0.6f, 0.6f, 0.1f}), translation({0, 0, -3}));  // within the sphere's outline
        const Cover both = cover_of(scene, camera, lines_of(EdgeChoice::feature), kSize, kSize);
        int dots = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) dots += both.at(x, y) != alone.at(x, y) ? 1 : 0;
        CAPTURE(triangles);
        CHECK(dots == 0);
        double farthest = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x)
                if (alone.at(x, y) > 0) farthest = std::max(farthest, std::abs(std::hypot(x + 0.5 - 128, y + 0.5 - 128) - kSize / 3.0));
        CHECK(farthest <= reach({}) + 0.1);
    }
}

TEST_CASE("edges: both sides of a sheet made twice, and a triangle that is wound the wrong way, add no lines", "[edges]") {
    Mesh grid = make_plane(1, 4);
    grid.normals.clear(), grid.uv0.clear();
    Scene once = scene_of(grid);
    once.materials.resize(1);
    once.materials[0].double_sided = true;
    once.meshes[0].material = 0;
    const Camera camera = view_of(once, 25, 50, false);
    const Cover expected = cover_of(once, camera, lines_of(EdgeChoice::feature), kSize, kSize);
    Scene turned = once;
    std::swap(turned.meshes[0].indices[30], turned.meshes[0].indices[31]);
    CHECK(cover_of(turned, camera, lines_of(EdgeChoice::feature), kSize, kSize).rgba == expected.rgba);
    Scene twice = once;
    twice.materials[0].double_sided = false;
    for (std::size_t i = 0; i < grid.indices.size(); i += 3)
        for (const std::size_t k : {0, 2, 1}) twice.meshes[0].indices.push_back(grid.indices[i + k]);
    CHECK(cover_of(twice, camera, lines_of(EdgeChoice::feature), kSize, kSize).rgba == expected.rgba);
}

TEST_CASE("edges: lines end at the near and the far plane", "[edges]") {
    // A strip along z from 2 to -8, seen from z = 0 downwards at it.
    Mesh strip;
    strip.positions = {{-0.5f, -1, 2}, {0.5f, -1, 2}, {0.5f, -1, -8}, {-0.5f, -1, -8}};
    strip.indices = {0, 1, 2, 0, 2, 3};
    for (const bool orthographic : {false, true}) {
        Camera camera = halflit::test::camera_at({0, 0, 0}, {0, -0.5f, -1}, 1.4f, 1.0f);
        camera.orthographic = orthographic;
        camera.half_height = 4;
        camera.far_z = 4;
        const WindowOf window(camera, kSize, kSize);
        std::vector<Segment2> lines;
        for (const double x : {-0.5, 0.5}) {
            // Depth along the view axis: (0.5 * 1 + -z) / sqrt(1.25).
            const double scale = std::sqrt(1.25), near_z = 0.5 - 1.0 * scale, far_z = 0.5 - 4.0 * scale;
            lines.push_back({window.point({x, -1, near_z}), window.point({x, -1, far_z})});
        }
        const Worst worst = compare(cover_of(scene_of(strip), camera, lines_of(EdgeChoice::feature), kSize, kSize), lines);
        CAPTURE(orthographic, worst.painted, worst.missing, worst.points);
        CHECK(worst.points > 50);
        CHECK(worst.painted <= reach({}));
        CHECK(worst.missing == 0);
    }
}

TEST_CASE("edges: the part of a triangle that the near plane cuts away hides nothing", "[edges]") {
    // A wall that rises towards the viewer, at the depth 3 - 2 y, and a square behind it. The near plane at 3 leaves the wall's lower half.
    Mesh wall;
    wall.positions = {{-19, -9, -21}, {19, -9, -21}, {19, 1, -1}, {-19, 1, -1}};
    wall.indices = {0, 1, 2, 0, 2, 3};
    for (const bool orthographic : {false, true}) {
        Scene scene = scene_of(square(0.5f, -6));
        add(scene, wall);
        Camera camera = halflit::test::camera_at({0, 0, 0}, {0, 0, -1}, 0.5f, 3.0f);
        camera.orthographic = orthographic, camera.half_height = 0.9f, camera.far_z = 40;
        const WindowOf window(camera, kSize, kSize);
        const std::vector<Segment2> upper = {{window.point({-0.5, 0, -6}), window.point({-0.5, 0.5, -6})},
                                             {window.point({-0.5, 0.5, -6}), window.point({0.5, 0.5, -6})},
                                             {window.point({0.5, 0.5, -6}), window.point({0.5, 0, -6})}};
        const Worst worst = compare(cover_of(scene, camera, lines_of(EdgeChoice::feature), kSize, kSize), upper);
        CAPTURE(orthographic, worst.painted, worst.missing);
        CHECK(worst.painted <= reach({}) + 0.1);
        CHECK(worst.missing == 0);
    }
}
