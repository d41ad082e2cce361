// Points and lines: covered pixels, depth and colours against closed forms, and the same pixels however they are computed.
#include "halflit/renderer.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/isas.hpp"

#include <cmath>
#include <random>

using namespace halflit;

namespace {

constexpr int kSize = 96;

Settings plain(int samples) {
    Settings settings;
    settings.samples = samples;
    settings.shadows = ShadowMode::off;
    return settings;
}

std::vector<float> linear_of(const Scene& scene, const Camera& camera, const Settings& settings) {
    std::vector<std::uint8_t> codes(std::size_t{4} * kSize * kSize);
    std::vector<float> linear(codes.size());
    const auto report = render(scene, camera, settings, {kSize, kSize, codes.data(), linear.data()});
    REQUIRE(report);
    return linear;
}

double alpha_at(const std::vector<float>& linear, int x, int y) {
    return double{linear[4 * (static_cast<std::size_t>(y) * kSize + static_cast<std::size_t>(x)) + 3]};
}

/// World units are pixels: x to the right, y up, the picture's lower left corner at (0, 0).
Camera pixel_camera() {
    Camera camera;
    camera.orthographic = true;
    camera.half_height = camera.half_width = kSize / 2.0f;
    camera.world_from_camera = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {kSize / 2.0f, kSize / 2.0f, 10, 1}}};
    camera.near_z = 1;
    camera.far_z = 30;
    return camera;
}

Scene scene_of(Mesh mesh) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].unlit = true;
    mesh.material = 0;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, {}});
    return scene;
}

Mesh points_at(std::vector<Vec3f> positions) {
    Mesh mesh;
    mesh.topology = Topology::points;
    for (std::uint32_t i = 0; i < positions.size(); ++i) mesh.indices.push_back(i);
    mesh.positions = std::move(positions);
    return mesh;
}

Mesh lines_at(std::vector<Vec3f> positions) {
    Mesh mesh = points_at(std::move(positions));
    mesh.topology = Topology::lines;
    return mesh;
}

/// Points, lines and triangles in perspective; some of them behind the eye, some outside of the picture.
Scene crowd() {
    std::mt19937 random(7);
    const auto unit = [&] { return static_cast<float>(random() % 20001) / 10000.0f - 1.0f; };
    Scene scene;
    scene.materials.resize(3);
    scene.materials[0].unlit = true;
    scene.materials[1].metallic = 0;
    scene.materials[1].double_sided = true;
    scene.materials[2].unlit = true;
    scene.materials[2].alpha_mode = AlphaMode::blend;
    scene.materials[2].base_color.w = 0.5f;
    for (int m = 0; m < 6; ++m) {
        std::vector<Vec3f> positions, normals;
        std::vector<Vec4f> colors;
        for (int i = 0; i < 150; ++i) {
            positions.push_back({2 * unit(), 2 * unit(), 2 * unit()});
            normals.push_back({unit(), unit(), 1.1f});
            colors.push_back({0.5f + 0.5f * unit(), 0.5f, 0.5f - 0.5f * unit(), 1});
        }
        Mesh mesh = m % 2 == 0 ? points_at(positions) : lines_at(positions);
        mesh.colors = colors;
        mesh.material = m / 2;
        if (mesh.material == 1) mesh.normals = normals;
        scene.meshes.push_back(mesh);
        scene.instances.push_back({m, {}});
    }
    Mesh ball = make_sphere(0.7f, 16, 12);
    ball.material = 1;
    scene.meshes.push_back(ball);
    scene.instances.push_back({6, {}});
    // Each a mesh of its own, around the picture's rim.
    for (int i = 0; i < 40; ++i) {
        scene.meshes.push_back(points_at({{0, 0, 0}}));
        scene.meshes.back().material = 0;
        scene.instances.push_back(
            {7 + i, translation({1.02f * std::sin(static_cast<float>(i)), 1.02f * std::cos(static_cast<float>(i)), 0})});
    }
    Light sun;
    sun.direction_ws = {-0.3f, -1, -0.5f};
    scene.lights.push_back(sun);
    return scene;
}

Camera near_camera() {
    Camera camera;
    camera.world_from_camera = translation({0, 0, 1.5f});
    camera.fov_y_rad = 1.2f;
    camera.near_z = 0.05f;
    return camera;
}

}  // namespace

TEST_CASE("points: squares below 3 pixels, with their upper and left side, and circles from there cover the pixel centres inside",
          "[raster][points]") {
    std::mt19937 random(1);
    for (const float size : {1.0f, 2.0f, 2.75f, 3.0f, 3.5f, 7.25f, 40.0f, 63.5f, 64.0f, 90.0f}) {
        const double x = 8 + static_cast<double>(random() % (80 * 256)) / 256, y = 8 + static_cast<double>(random() % (80 * 256)) / 256;
        Settings settings = plain(1);
        settings.point_size = size;
        INFO("size " << size << " at " << x << ", " << y << " from the upper left corner");
        const auto linear =
            linear_of(scene_of(points_at({{static_cast<float>(x), static_cast<float>(kSize - y), 0}})), pixel_camera(), settings);
        // An odd number of 1/256 pixels has its middle half a step off.
        const double low_x = x - std::floor(128.0 * double{size}) / 256, low_y = y - std::floor(128.0 * double{size}) / 256;
        int wrong = 0, inside_count = 0;
        for (int j = 0; j < kSize; ++j)
            for (int i = 0; i < kSize; ++i) {
                const double cx = i + 0.5, cy = j + 0.5;
                const bool inside = size < 3.0f ? cx >= low_x && cx < low_x + double{size} && cy >= low_y && cy < low_y + double{size}
                                                : std::hypot(cx - x, cy - y) <= 0.5 * double{size};
                inside_count += inside ? 1 : 0;
                wrong += (alpha_at(linear, i, j) == 1.0) != inside ? 1 : 0;
            }
        CHECK(inside_count > 0);
        CHECK(wrong == 0);
    }
}

TEST_CASE("points and lines: samples share in their area", "[raster][points]") {
    std::mt19937 random(2);
    const auto at = [&](int least, int most) {
        return static_cast<float>(least + static_cast<double>(random() % 10000) / 10000 * (most - least));
    };
    const auto total = [](const std::vector<float>& linear) {
        double sum = 0;
        for (int j = 0; j < kSize; ++j)
            for (int i = 0; i < kSize; ++i) sum += alpha_at(linear, i, j);
        return sum;
    };
    Settings settings = plain(16);
    double off_points = 0, off_lines = 0;
    constexpr int kCount = 60;
    for (int k = 0; k < kCount; ++k) {
        settings.point_size = at(1, 9);
        settings.line_width = at(1, 6);
        const double square = double{settings.point_size} * double{settings.point_size};
        const double area = settings.point_size < 3.0f ? square : 0.25 * 3.14159265358979 * square;
        off_points += std::abs(total(linear_of(scene_of(points_at({{at(16, 80), at(16, 80), 0}})), pixel_camera(), settings)) / area - 1);
        const Vec3f a{at(8, 88), at(8, 88), 0}, b{at(8, 88), at(8, 88), -3};
        const double length = std::hypot(double{b.x - a.x}, double{b.y - a.y});
        off_lines +=
            std::abs(total(linear_of(scene_of(lines_at({a, b})), pixel_camera(), settings)) / (length * double{settings.line_width}) - 1);
    }
    CHECK(off_points / kCount < 0.04);  // measured 0.021: sides along the axes meet whole columns of samples
    CHECK(off_lines / kCount < 0.02);   // measured 0.005
}

TEST_CASE("lines: a rectangle of their width, without caps, covers the pixel centres inside", "[raster][lines]") {
    std::mt19937 random(3);
    const auto at = [&] { return 5 + static_cast<double>(random() % 86000) / 1000; };
    int checked = 0;
    for (int k = 0; k < 40; ++k) {
        const double a[2] = {at(), at()}, b[2] = {at(), at()}, width = 0.5 + k * 0.3;
        Settings settings = plain(1);
        settings.line_width = static_cast<float>(width);
        const auto linear = linear_of(scene_of(lines_at({{static_cast<float>(a[0]), static_cast<float>(a[1]), 0},
                                                         {static_cast<float>(b[0]), static_cast<float>(b[1]), -2}})),
                                      pixel_camera(), settings);
        const double dx = b[0] - a[0], dy = b[1] - a[1], length = std::hypot(dx, dy);
        int wrong = 0;
        for (int j = 0; j < kSize; ++j)
            for (int i = 0; i < kSize; ++i) {
                const double x = i + 0.5 - a[0], y = kSize - j - 0.5 - a[1];
                const double along = (x * dx + y * dy) / length, across = std::abs(x * dy - y * dx) / length;
                const double margin = std::min({along, length - along, width / 2 - across});
                if (std::abs(margin) < 0.01) continue;  // corners snap to 1/256 pixel
                ++checked;
                wrong += (alpha_at(linear, i, j) == 1.0) != (margin > 0) ? 1 : 0;
            }
        INFO("line " << k);
        CHECK(wrong == 0);
    }
    CHECK(checked > 300000);
}

TEST_CASE("lines: colours along a line are perspective correct, and depth hides what lies behind", "[raster][lines]") {
    // From (-1, 0, -1) to (3, 0, -5), seen from the origin with a field of 90 degrees: at the picture's u in [-1, 1], x = u d, where d is
    // the depth. On the line, x = -1 + 4 t and d = 1 + 4 t, so t = (1 + u) / (4 (1 - u)).
    Mesh line = lines_at({{-1, 0, -1}, {3, 0, -5}});
    line.colors = {{0, 0, 0, 1}, {1, 1, 1, 1}};
    Scene scene = scene_of(line);
    // A wall at depth 3 hides what lies behind it by more than the line is lifted: by its width, as a share of half the picture's side.
    Mesh wall = make_box({10, 10, 0.001f});
    wall.material = 1;
    scene.materials.resize(2);
    scene.materials[1].unlit = true;
    scene.materials[1].base_color = {0, 0, 1, 1};
    scene.meshes.push_back(wall);
    scene.instances.push_back({1, translation({0, 0, -3})});
    Camera camera;
    camera.fov_y_rad = 1.5707963f;
    camera.near_z = 0.1f;
    Settings settings = plain(1);
    settings.line_width = 4;
    const auto linear = linear_of(scene, camera, settings);
    const double lifted = 4.0 / (kSize / 2.0), first_hidden = (3.0 / (1.0 - lifted) - 1.0) / 4.0;
    int on_line = 0, hidden = 0;
    for (int i = 1; i < kSize - 1; ++i) {
        const double u = (2 * i + 1.0) / kSize - 1, t = (1 + u) / (4 * (1 - u));
        const std::size_t at = std::size_t{4} * (kSize / 2 * kSize + static_cast<std::size_t>(i));
        const double red = double{linear[at]}, blue = double{linear[at + 2]};
        if (t > 0.02 && t < 0.49) {
            CHECK(red == Approx(t).margin(2e-3));
            CHECK(blue == Approx(t).margin(2e-3));
            ++on_line;
        } else if (t > first_hidden + 0.01 && t < 0.99) {
            CHECK(red == 0.0);
            CHECK(blue == Approx(1.0));
            ++hidden;
        }
    }
    CHECK(on_line > 50);
    CHECK(hidden > 5);
}

TEST_CASE("lines: one that passes the eye is drawn as far as the near plane", "[raster][lines]") {
    Camera camera;
    camera.fov_y_rad = 1.0f;
    camera.near_z = 0.25f;
    const double t = (3.0 - 0.25) / (3.0 + 2.0);  // where z = -0.25 on the line from z = -3 to z = 2
    const Vec3f a{-1, 0.5f, -3}, b{0.4f, -0.3f, 2};
    const Vec3f cut{static_cast<float>(-1 + 1.4 * t), static_cast<float>(0.5 - 0.8 * t), -0.2500001f};
    Settings settings = plain(1);
    settings.line_width = 3;
    int drawn = 0, different = 0;
    for (const bool turned : {false, true}) {
        const auto whole = linear_of(scene_of(lines_at(turned ? std::vector{b, a} : std::vector{a, b})), camera, settings);
        const auto part = linear_of(scene_of(lines_at({a, cut})), camera, settings);
        for (int j = 0; j < kSize; ++j)
            for (int i = 0; i < kSize; ++i) {
                drawn += alpha_at(whole, i, j) == 1.0 ? 1 : 0;
                different += alpha_at(whole, i, j) != alpha_at(part, i, j) ? 1 : 0;
            }
    }
    CHECK(drawn > 100);
    CHECK(different <= 6);  // centres on an edge: ends are rounded in another order
}

TEST_CASE("points and lines: the same pixels from every instruction set, thread count, tile size and region", "[raster][points]") {
    const Scene scene = crowd();
    const Camera camera = near_camera();
    constexpr int kWidth = 160, kHeight = 120;
    for (const int samples : {1, 4}) {
        Settings settings = plain(samples);
        settings.shadows = ShadowMode::soft_split;
        settings.shadow_size = 256;
        settings.point_size = 9.3f;
        settings.line_width = 5.1f;
        settings.background_linear = {0.1f, 0.1f, 0.1f, 1};
        const int look = GENERATE(0, 1, 2);
        if (look > 0) settings.point_size = 0;
        if (look > 0) settings.edl = look == 1 ? EyeDomeLighting::automatic : EyeDomeLighting::on;
        CAPTURE(look);
        std::vector<std::uint8_t> expected(std::size_t{4} * kWidth * kHeight);
        REQUIRE(render(scene, camera, settings, {kWidth, kHeight, expected.data()}, {.threads = 1, .isa = Isa::scalar}));
        int tile = 16, threads = 1;
        for (const Isa isa : test::available_isas()) {
            std::vector<std::uint8_t> codes(expected.size());
            REQUIRE(render(scene, camera, settings, {kWidth, kHeight, codes.data()}, {.threads = threads, .tile_size = tile, .isa = isa}));
            CHECK(codes == expected);
            tile = tile == 64 ? 16 : 2 * tile;
            threads = threads % 3 + 1;
        }
        for (const Region region : {Region{0, 0, 20, 20}, Region{70, 33, 41, 50}, Region{155, 100, 5, 20}, Region{80, 60, 1, 1}}) {
            settings.region = region;
            std::vector<std::uint8_t> codes(expected.size());
            REQUIRE(render(scene, camera, settings, {kWidth, kHeight, codes.data()}));
            int wrong = 0;
            for (int y = region.y; y < region.y + region.height; ++y)
                for (int x = region.x; x < region.x + region.width; ++x)
                    for (int c = 0; c < 4; ++c) {
                        const auto at = static_cast<std::size_t>(4 * (y * kWidth + x) + c);
                        wrong += codes[at] != expected[at] ? 1 : 0;
                    }
            INFO("region at " << region.x << ", " << region.y);
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE("points and lines: indices that share vertices draw as vertices of their own do", "[raster][points]") {
    Mesh shared = lines_at({{-1, -1, 0}, {1, -0.5f, 0}, {0.2f, 1, -0.5f}, {9, 9, 9}});
    shared.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}};
    shared.indices = {0, 1, 1, 2, 2, 0};
    Mesh own = lines_at(
        {shared.positions[0], shared.positions[1], shared.positions[1], shared.positions[2], shared.positions[2], shared.positions[0]});
    own.colors = {shared.colors[0], shared.colors[1], shared.colors[1], shared.colors[2], shared.colors[2], shared.colors[0]};
    Settings settings = plain(4);
    settings.line_width = 6;
    const auto a = linear_of(scene_of(shared), near_camera(), settings), b = linear_of(scene_of(own), near_camera(), settings);
    CHECK(a == b);
    shared.topology = own.topology = Topology::points;
    settings.point_size = 12;
    CHECK(linear_of(scene_of(shared), near_camera(), settings) == linear_of(scene_of(own), near_camera(), settings));
    CHECK(linear_of(scene_of(shared), near_camera(), settings) != a);
}

TEST_CASE("points and lines: faulty ones are refused, and those that are not finite are counted", "[raster][points]") {
    std::vector<std::uint8_t> codes(std::size_t{4} * kSize * kSize);
    Mesh line = lines_at({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}});
    CHECK(!render(scene_of(line), pixel_camera(), plain(1), {kSize, kSize, codes.data()}));
    Mesh point = points_at({{1, 1, 0}});
    point.indices = {1};
    CHECK(!render(scene_of(point), pixel_camera(), plain(1), {kSize, kSize, codes.data()}));
    for (const float size : {0.0f, 0.05f, 257.0f, std::numeric_limits<float>::quiet_NaN()}) {
        Settings settings = plain(1);
        settings.point_size = size;
        CHECK(!check_settings(settings, 10, 10) == (size != 0.0f));  // 0: chosen by the renderer
        settings = plain(1);
        settings.line_width = size;
        CHECK(!check_settings(settings, 10, 10));
    }
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto report = render(scene_of(points_at({{1, 1, 0}, {nan, 0, 0}})), pixel_camera(), plain(1), {kSize, kSize, codes.data()});
    REQUIRE(report);
    CHECK(report->triangles_not_finite == 2);
}

TEST_CASE("points and lines: they cast no shadow and take those of triangles", "[raster][points]") {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].metallic = 0;
    Mesh floor = points_at({});
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) floor.positions.push_back({-2 + 0.1f * static_cast<float>(i), 0, -2 + 0.1f * static_cast<float>(j)});
    floor.normals.assign(floor.positions.size(), {0, 1, 0});
    for (std::uint32_t i = 0; i < floor.positions.size(); ++i) floor.indices.push_back(i);
    floor.material = 0;
    scene.meshes.push_back(floor);
    scene.instances.push_back({0, {}});
    Light sun;
    sun.direction_ws = {0, -1, 0};
    scene.lights.push_back(sun);
    Camera camera;
    camera.orthographic = true;
    camera.half_height = 2;
    camera.world_from_camera = {{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 10, 0, 1}}};
    camera.near_z = 1;
    camera.far_z = 30;
    Settings settings = plain(1);
    settings.shadows = ShadowMode::hard;
    settings.point_size = 4;
    const auto light = [&] {
        const std::vector<float> linear = linear_of(scene, camera, settings);
        return double{linear[std::size_t{4} * (kSize / 2 * kSize + kSize / 2)]};
    };
    const double open = light();
    CHECK(open > 0.2);
    Mesh roof = lines_at({{-2, 11, 0}, {2, 11, 0}, {-2, 11, 0.01f}, {2, 11, 0.01f}});
    roof.material = 0;
    scene.meshes.push_back(roof);
    scene.instances.push_back({1, {}});
    CHECK(light() == open);
    Mesh box = make_box({1, 0.1f, 1});
    box.material = 0;
    scene.meshes.push_back(box);
    scene.instances.push_back({2, translation({0, 12, 0})});
    CHECK(light() < 0.01 * open);
}

TEST_CASE("lines: those that lie on a surface are seen whole, up to a tilt of 60 degrees", "[raster][lines]") {
    // A square of two grey triangles, and a star of white lines in its plane. The picture of the lines alone says which pixels they cover.
    const int samples = GENERATE(1, 4);
    const bool orthographic = GENERATE(false, true);
    const double tilt_deg = GENERATE(0.0, 20.0, 40.0, 55.0, 60.0);
    const int turn = GENERATE(0, 1, 2);
    CAPTURE(samples, orthographic, tilt_deg, turn);
    const float c = static_cast<float>(std::cos(tilt_deg * 3.14159265358979 / 180)),
                s = static_cast<float>(std::sin(tilt_deg * 3.14159265358979 / 180));
    const auto placed = [&](float x, float y) {
        const float u = turn == 1 ? y : x, v = turn == 1 ? x : y;
        return turn == 0 ? Vec3f{u, v * c, v * s} : turn == 1 ? Vec3f{u * c, v, -u * s} : Vec3f{u * c, v, u * s};
    };
    std::vector<Vec3f> ends;
    for (int i = 0; i < 12; ++i) {
        const double angle = i * 3.14159265358979 / 12;
        const auto x = static_cast<float>(0.9 * std::cos(angle)), y = static_cast<float>(0.9 * std::sin(angle));
        ends.push_back(placed(x, y));
        ends.push_back(placed(-x, -y));
    }
    Scene lines = scene_of(lines_at(ends));
    lines.materials[0].base_color = {1, 1, 1, 1};
    Scene both = lines;
    Mesh square;
    square.positions = {placed(-1, -1), placed(1, -1), placed(1, 1), placed(-1, 1)};
    square.indices = {0, 1, 2, 0, 2, 3};
    square.material = 1;
    both.materials.resize(2);
    both.materials[1].unlit = both.materials[1].double_sided = true;
    both.materials[1].base_color = {0.1f, 0.1f, 0.1f, 1};
    both.meshes.push_back(std::move(square));
    both.instances.insert(both.instances.begin(), Instance{1, {}});
    Camera camera;
    camera.orthographic = orthographic;
    camera.half_height = 1.2f;
    camera.fov_y_rad = 0.5f;
    camera.near_z = 1;
    camera.world_from_camera = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 5, 1}}};
    Settings settings = plain(samples);
    settings.line_width = 2.0f;
    const auto alone = linear_of(lines, camera, settings), over = linear_of(both, camera, settings);
    int covered = 0, lost = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            if (alpha_at(alone, x, y) < 1.0) continue;
            ++covered;
            lost += over[4 * (static_cast<std::size_t>(y) * kSize + static_cast<std::size_t>(x))] < 1.0f ? 1 : 0;
        }
    REQUIRE(covered > 300);
    CHECK(lost == 0);
}
