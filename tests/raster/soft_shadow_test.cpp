// Shadows of lights that have a size: penumbrae against rays to thousands of points of the light.
#include "halflit/renderer.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"
#include "raster/frame_plan.hpp"
#include "raster/view/soft_shadows.hpp"

#include "tests/raster/box_shadow.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/isas.hpp"

#include <cmath>
#include <random>

using namespace halflit;
using raster::unit;
using test::Box;

namespace {

constexpr int kSize = 192;
constexpr double kView = 3.0;

/// A box that floats over a white floor.
struct Model {
    Box box;
    Scene scene;
    Camera camera;
};

Model box_above_floor(double height, double half) {
    Model model;
    model.box = {{-half, height, -half}, {half, height + 2 * half, half}};
    model.scene.materials.resize(1);
    model.scene.materials[0].metallic = 0;
    const auto add = [&](Mesh mesh, Vec3f at) {
        mesh.material = 0;
        model.scene.instances.push_back({static_cast<std::int32_t>(model.scene.meshes.size()), translation(at)});
        model.scene.meshes.push_back(std::move(mesh));
    };
    add(make_plane(6, 1), {0, 0, 0});
    add(make_box({static_cast<float>(half), static_cast<float>(half), static_cast<float>(half)}),
        {0, static_cast<float>(height + half), 0});
    model.camera.orthographic = true;
    model.camera.half_height = static_cast<float>(kView);
    model.camera.world_from_camera = {{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 20, 0, 1}}};
    model.camera.near_z = 1;
    model.camera.far_z = 30;
    return model;
}

std::vector<float> drawn(const Scene& scene, const Camera& camera, const Settings& settings, const Execution& execution = {}) {
    std::vector<float> linear(std::size_t{4} * kSize * kSize);
    REQUIRE(render(scene, camera, settings, {.width = kSize, .height = kSize, .linear = linear.data()}, execution));
    return linear;
}

Settings matt() {
    Settings settings;
    settings.shading.specular = SpecularModel::none;
    settings.shadow_size = 1024;
    return settings;
}

/// Points of the light: directions times a large distance, or places.
std::vector<Vec3d> points_of(const Light& light, int n) {
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> unit01(-1, 1);
    std::vector<Vec3d> points;
    const double radius = static_cast<double>(light.shadow_radius);
    while (static_cast<int>(points.size()) < n) {
        const Vec3d in_cube{unit01(engine), unit01(engine), unit01(engine)};
        const bool parallel = light.type == LightType::directional;
        if (parallel) {
            // An even disc across the direction.
            if (in_cube.x * in_cube.x + in_cube.y * in_cube.y > 1) continue;
            const Vec3d axis = unit(to_double(light.direction_ws) * -1.0);
            const Vec3d side = unit(cross(axis, Vec3d{0.3, 0.2, 0.9})), other = cross(axis, side);
            points.push_back(unit(axis + (side * in_cube.x + other * in_cube.y) * std::tan(radius)) * 1e4);
        } else {
            points.push_back(in_cube);  // placed for each receiver
        }
    }
    return points;
}

/// Share of the light that reaches a place of the floor. A ball is seen as an even disc across the direction to its middle.
double seen_share(const Light& light, const std::vector<Vec3d>& points, Vec3d place, const Box& box) {
    const Vec3d middle = to_double(light.position_ws), to_light = unit(middle - place);
    const Vec3d side = unit(cross(to_light, Vec3d{0.3, 0.2, 0.9})), other = cross(to_light, side);
    int seen = 0, all = 0;
    for (const Vec3d& point : points) {
        Vec3d to = place + point;
        if (light.type != LightType::directional) {
            if (point.x * point.x + point.y * point.y > 1) continue;
            to = middle + (side * point.x + other * point.y) * static_cast<double>(light.shadow_radius);
        }
        ++all;
        seen += test::meets(place, to, box) ? 0 : 1;
    }
    return static_cast<double>(seen) / all;
}

struct Penumbra {
    double mean = 0, worst = 0;  ///< error of the share that is seen, over the pixels that see a part of the light
    int pixels = 0;
    double sharp_mean = 0;  ///< of the light without a size there
};

Penumbra measure(const Model& model, Light light, int maps) {
    Settings settings = matt();
    settings.soft_shadow_maps = maps;
    Scene scene = model.scene;
    scene.lights = {light};
    const std::vector<float> soft = drawn(scene, model.camera, settings);
    scene.lights[0].shadow_radius = 0;
    const std::vector<float> sharp = drawn(scene, model.camera, settings);
    settings.shadows = ShadowMode::off;
    const std::vector<float> open = drawn(scene, model.camera, settings);
    const std::vector<Vec3d> points = points_of(light, 3000);
    Penumbra out;
    for (int y = 0; y < kSize; y += 3)
        for (int x = 0; x < kSize; x += 3) {
            const Vec3d place{((x + 0.5) / kSize * 2 - 1) * kView, 0, ((y + 0.5) / kSize * 2 - 1) * kView};
            if (std::fabs(place.x) < model.box.high.x + 0.03 && std::fabs(place.z) < model.box.high.z + 0.03) continue;  // the box
            const double truth = seen_share(light, points, place, model.box);
            if (truth == 0.0 || truth == 1.0) continue;
            const auto at = static_cast<std::size_t>(4 * (y * kSize + x));
            const auto all = static_cast<double>(open[at]);
            if (!(all > 0)) continue;
            const double error = std::fabs(static_cast<double>(soft[at]) / all - truth);
            out.mean += error;
            out.worst = std::max(out.worst, error);
            out.sharp_mean += std::fabs(static_cast<double>(sharp[at]) / all - truth);
            ++out.pixels;
        }
    out.mean /= out.pixels;
    out.sharp_mean /= out.pixels;
    return out;
}

Light directional(double size_deg) {
    Light light;
    light.direction_ws = normalize_or(Vec3f{0.6f, -1.0f, 0.2f}, {0, -1, 0});
    light.shadow_radius = static_cast<float>(size_deg * 3.14159265 / 180);
    return light;
}

Light lamp(LightType type, float size) {
    Light light;
    light.type = type;
    light.position_ws = {-1.5f, 5, -0.5f};
    light.direction_ws = normalize_or(Vec3f{0.3f, -1.0f, 0.1f}, {0, -1, 0});
    light.color_linear = {20, 20, 20};
    light.outer_cone_rad = 1.0f;
    light.shadow_radius = size;
    return light;
}

}  // namespace

TEST_CASE("soft shadows: penumbrae are those of rays to 3,000 points of the light", "[raster][soft-shadows]") {
    struct Case {
        const char* name;
        Light light;
        double height, half;
    };
    for (const Case& c : {Case{"sun of 2 degrees, 0.5 above the floor", directional(2), 0.5, 0.5},
                          {"sun of 6 degrees, on the floor", directional(6), 0.0, 0.5},
                          {"sun of 6 degrees, 1 above the floor", directional(6), 1.0, 0.4},
                          {"point of radius 0.3", lamp(LightType::point, 0.3f), 0.5, 0.5},
                          {"spot of radius 0.5", lamp(LightType::spot, 0.5f), 0.7, 0.4}}) {
        const Model model = box_above_floor(c.height, c.half);
        double before = 1;
        for (const int maps : {8, 16, 64}) {
            const Penumbra p = measure(model, c.light, maps);
            INFO(c.name << ", " << maps << " maps: mean error " << p.mean << ", worst " << p.worst << ", without a size " << p.sharp_mean
                        << ", of " << p.pixels << " pixels");
            CHECK(p.pixels > 40);
            CHECK(p.mean < 0.6 / std::sqrt(maps) * 0.4);
            CHECK(p.mean < 0.35 * p.sharp_mean);
            CHECK(p.mean < std::max(before, 0.02));
            before = p.mean;
        }
    }
}

TEST_CASE("soft shadows: points of a light project to an even disc from every side", "[raster][soft-shadows]") {
    shading::LightPlan light{};
    light.type = LightType::point;
    light.shadow_radius = 2;
    light.position[0] = 5;
    const auto points = raster::light_points(light, 64);
    for (const Vec3d axis : {Vec3d{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0.6, 0.64, 0.48}}) {
        double mean_square = 0;
        Vec3d middle{};
        for (const auto& p : points) {
            const Vec3d d{p.position[0] - 5.0, p.position[1], p.position[2]};
            const Vec3d across = d - axis * dot(d, axis);
            CHECK(dot(d, d) <= 4.0001);
            mean_square += dot(across, across) / 64;
            middle = middle + across * (1.0 / 64);
        }
        CHECK(mean_square == Approx(2.0).epsilon(0.06));  // of an even disc: half the squared radius
        CHECK(length(middle) < 0.1);
    }
}

TEST_CASE("soft shadows: what is wholly lit or wholly hidden keeps its bits, and sets, tiles and crops agree", "[raster][soft-shadows]") {
    const Model model = box_above_floor(0.5, 0.5);
    for (const Light& light : {directional(4), lamp(LightType::point, 0.4f), lamp(LightType::spot, 0.4f)}) {
        Scene scene = model.scene;
        scene.lights = {light};
        const std::vector<float> soft = drawn(scene, model.camera, matt(), {.isa = Isa::scalar});
        for (const Isa isa : test::available_isas())
            CHECK(drawn(scene, model.camera, matt(), {.threads = 2, .tile_size = 16, .isa = isa}) == soft);
        Settings part = matt();
        part.region = {31, 40, 77, 66};
        const std::vector<float> cropped = drawn(scene, model.camera, part);
        bool same = true;
        for (int y = 40; y < 106; ++y) {
            const auto at = static_cast<std::size_t>(4 * (y * kSize + 31));
            same &= std::equal(&cropped[at], &cropped[at] + 4 * 77, &soft[at]);
        }
        CHECK(same);
        Settings open = matt();
        open.shadows = ShadowMode::off;
        const std::vector<float> unshadowed = drawn(scene, model.camera, open);
        int lit = 0, dark = 0;
        for (std::size_t i = 0; i < soft.size(); i += 4) {
            CHECK(soft[i] <= unshadowed[i]);
            lit += soft[i] == unshadowed[i];
            dark += soft[i] == 0.0f && unshadowed[i] > 0.0f;
        }
        CHECK(lit > kSize * kSize / 2);
        CHECK(dark > 100);
    }
}

TEST_CASE("soft shadows: a light has fewer points where their maps do not fit the limit of memory", "[raster][soft-shadows]") {
    const Model model = box_above_floor(0.5, 0.5);
    Scene scene = model.scene;
    scene.lights = {directional(4)};
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    for (const auto& [bytes, points] : {std::pair{std::size_t{16} * 16384, 16}, {std::size_t{200000}, 8}, {std::size_t{20000}, 1}}) {
        Settings settings = matt();
        settings.shadow_memory_limit = bytes;
        auto lights = shading::plan_lights(scene.lights);
        const auto views = raster::plan_light_shadows(lights, prepared->data(), nullptr, settings, {});
        REQUIRE(views);
        CHECK(lights[0].shadow_points == points);
        CHECK(views->maps.size() == static_cast<std::size_t>(points));
        CHECK(views->warning.empty() == false);
    }
    shading::LightPlan middle = shading::plan_lights(scene.lights)[0];
    CHECK(raster::light_points(middle, 1)[0].to_light[0] == middle.to_light[0]);
}

TEST_CASE("soft shadows: the maps of all lights and of the sky stay within the limit of memory together", "[raster][soft-shadows]") {
    Scene scene = box_above_floor(0.5, 0.5).scene;
    scene.ambient = {{1, 1, 1}, {1, 1, 1}};
    scene.lights = {directional(4), lamp(LightType::point, 0.0f), lamp(LightType::spot, 0.4f), directional(0)};
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    for (const std::size_t limit : {std::size_t{64} << 20, std::size_t{8} << 20, std::size_t{4} << 20}) {
        Settings settings = matt();
        settings.sky_shadows = 64;
        settings.shadow_memory_limit = limit;
        const auto plan = raster::plan_frame(prepared->data(), prepared->scene(), Camera{}, settings, 64, 64);
        REQUIRE(plan);
        REQUIRE(plan->shadow_views.size() > 64);
        std::size_t last = 0;  // texel with which the last map begins
        for (const raster::ShadowView& view : plan->shadow_views) last = std::max(last, view.first_texel);
        CHECK(last * sizeof(float) < limit);
    }
}

TEST_CASE("soft shadows: their number is checked, and each point that sees casters has a map", "[raster][soft-shadows]") {
    const Model model = box_above_floor(0.5, 0.5);
    Scene scene = model.scene;
    scene.lights = {directional(4), lamp(LightType::spot, 0.4f), lamp(LightType::spot, 0.0f)};
    std::vector<float> linear(std::size_t{4} * kSize * kSize);
    for (const int n : {0, 3, 65, -1}) {
        Settings settings = matt();
        settings.soft_shadow_maps = n;
        const auto report = render(scene, model.camera, settings, {.width = kSize, .height = kSize, .linear = linear.data()});
        REQUIRE_FALSE(report);
        CHECK(report.error().message.find("soft shadow maps") != std::string::npos);
    }
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    auto lights = shading::plan_lights(scene.lights);
    const auto views = raster::plan_light_shadows(lights, prepared->data(), nullptr, matt(), {});
    REQUIRE(views);
    REQUIRE(views->map_of_light.size() == 3);
    CHECK(views->maps.size() == 33);
    CHECK(lights[0].shadow_points == 16);
    CHECK(lights[2].shadow_points == 1);
    for (const std::size_t l : {0u, 1u, 2u}) {
        int chained = 1;
        for (auto map = static_cast<std::size_t>(views->map_of_light[l]); views->maps[map].next != 0; ++chained)
            map += static_cast<std::size_t>(views->maps[map].next);
        CHECK(chained == lights[l].shadow_points);
    }
}
