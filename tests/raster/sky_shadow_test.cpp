// Sky shadows against rays in many directions, and what they must leave alone.
#include "halflit/renderer.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"
#include "sh/equirect.hpp"
#include "sh/trig.hpp"

#include "shading/plan/sky_grid_plan.hpp"
#include "shading/sky_lights.hpp"
#include "tests/raster/box_shadow.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/isas.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

using namespace halflit;
using test::Box;

namespace {

constexpr int kWidth = 96, kHeight = 72;

/// A point that a picture shows, and the normal there.
struct SurfacePoint {
    Vec3d p, normal;
};

/// A scene of white Lambert bodies, and the same in closed form.
struct Model {
    const char* name;
    Scene scene;
    Camera camera;
    /// Where the ray from a point along a unit direction first meets the bodies.
    std::function<std::optional<SurfacePoint>(Vec3d, Vec3d)> first;
};

void add(Scene& scene, Mesh mesh, Vec3f at) {
    mesh.material = 0;
    scene.instances.push_back({static_cast<std::int32_t>(scene.meshes.size()), translation(at)});
    scene.meshes.push_back(std::move(mesh));
}

Scene white_scene(const EnvironmentImage& sky) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].metallic = 0;
    scene.environment = make_environment(sky, {.extract_suns = false, .keep_light = true}).value();
    return scene;
}

Camera looking(Vec3f eye, Vec3f target) {
    Camera camera;
    camera.world_from_camera = look_at(eye, target);
    return camera;
}

/// The nearer of two points along a ray.
struct Nearest {
    double t = 1e300;
    std::optional<SurfacePoint> point;
    void add(double at, Vec3d from, Vec3d d, Vec3d normal) {
        if (at > 1e-9 && at < t) t = at, point = {from + d * at, normal};
    }
    void add_box(const Box& box, Vec3d from, Vec3d d) {
        const double o[3] = {from.x, from.y, from.z}, v[3] = {d.x, d.y, d.z};
        const double low[3] = {box.low.x, box.low.y, box.low.z}, high[3] = {box.high.x, box.high.y, box.high.z};
        double enter = 0, leave = 1e300;
        int axis = -1;
        for (int i = 0; i < 3; ++i) {
            if (v[i] == 0) {
                if (o[i] < low[i] || o[i] > high[i]) return;
                continue;
            }
            const double a = (low[i] - o[i]) / v[i], b = (high[i] - o[i]) / v[i];
            if (std::min(a, b) > enter) enter = std::min(a, b), axis = i;
            leave = std::min(leave, std::max(a, b));
        }
        if (!(enter < leave) || axis < 0) return;
        const double sign = v[axis] > 0 ? -1 : 1;
        add(enter, from, d, {axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0});
    }
    /// The half of a sphere about the origin below y = 0, seen from inside.
    void add_bowl(double radius, Vec3d from, Vec3d d) {
        const double b = dot(from, d), c = dot(from, from) - radius * radius, root = b * b - c;
        if (root < 0) return;
        const double far = -b + std::sqrt(root);
        const Vec3d p = from + d * far;
        if (p.y < 0) add(far, from, d, p * (-1.0 / radius));
    }
    void add_ball(Vec3d centre, double radius, Vec3d from, Vec3d d) {
        const Vec3d offset = from - centre;
        const double b = dot(offset, d), c = dot(offset, offset) - radius * radius, root = b * b - c;
        if (root < 0) return;
        const double near = -b - std::sqrt(root);
        add(near, from, d, (offset + d * near) * (1.0 / radius));
    }
};

Model of_boxes(const char* name, const EnvironmentImage& sky, std::vector<Box> boxes, Camera camera) {
    Model model{name, white_scene(sky), std::move(camera), {}};
    for (const Box& box : boxes) add(model.scene, make_box(to_float((box.high - box.low) * 0.5)), to_float((box.high + box.low) * 0.5));
    model.first = [boxes = std::move(boxes)](Vec3d from, Vec3d d) {
        Nearest nearest;
        for (const Box& box : boxes) nearest.add_box(box, from, d);
        return nearest.point;
    };
    return model;
}

Model box_on_plane(const EnvironmentImage& sky) {
    return of_boxes("a box on a plane", sky, {{{-3, -0.2, -3}, {3, 0, 3}}, {{-0.5, 0, -0.5}, {0.5, 1, 0.5}}},
                    looking({2.5f, 2.5f, 4}, {0, 0.3f, 0}));
}

Model niche(const EnvironmentImage& sky) {
    return of_boxes("a niche", sky,
                    {{{-1.2, -1.2, -1.2}, {1.2, -1, 1}},  // floor
                     {{-1.2, 1, -1.2}, {1.2, 1.2, 1}},    // ceiling
                     {{-1.2, -1, -1.2}, {-1, 1, 1}},      // left
                     {{1, -1, -1.2}, {1.2, 1, 1}},        // right
                     {{-1, -1, -1.2}, {1, 1, -1}},        // back
                     {{-0.6, -1, -0.6}, {0, 0.2, 0}},     // two blocks in it
                     {{0.2, -1, -0.1}, {0.7, -0.4, 0.4}}},
                    looking({0.3f, 0.2f, 4.5f}, {0, 0, 0}));
}

Model ball_in_bowl(const EnvironmentImage& sky) {
    constexpr double kBowl = 1.0;
    const Vec3d centre{0.2, -0.55, 0.1};
    constexpr double kBall = 0.35;
    Model model{"a ball in a bowl", white_scene(sky), looking({0, 3, 2}, {0, -0.3f, 0}), {}};
    // The lower half of a sphere, turned inside out.
    Mesh bowl = make_sphere(static_cast<float>(kBowl), 128, 128);
    std::vector<std::uint32_t> indices;
    for (std::size_t i = 0; i + 2 < bowl.indices.size(); i += 3) {
        const auto low = [&](std::size_t k) { return bowl.positions[bowl.indices[i + k]].y < 1e-4f; };
        if (low(0) && low(1) && low(2)) indices.insert(indices.end(), {bowl.indices[i], bowl.indices[i + 2], bowl.indices[i + 1]});
    }
    bowl.indices = indices;
    for (Vec3f& normal : bowl.normals) normal = normal * -1.0f;
    add(model.scene, std::move(bowl), {0, 0, 0});
    add(model.scene, make_sphere(static_cast<float>(kBall), 64, 64), to_float(centre));
    model.scene.materials[0].double_sided = true;  // the outside of the bowl hides, too
    model.first = [=](Vec3d from, Vec3d d) {
        Nearest nearest;
        nearest.add_bowl(kBowl, from, d);
        nearest.add_ball(centre, kBall, from, d);
        return nearest.point;
    };
    return model;
}

Settings lambert() {
    Settings settings;
    settings.shading.specular = SpecularModel::none;
    return settings;
}

std::vector<float> draw(const Model& model, int sky_shadows) {
    Settings settings = lambert();
    settings.sky_shadows = sky_shadows;
    std::vector<float> linear(static_cast<std::size_t>(4 * kWidth * kHeight));
    REQUIRE(render(model.scene, model.camera, settings, {.width = kWidth, .height = kHeight, .linear = linear.data()}));
    return linear;
}

double encoded(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }
double code(double linear) { return 255 * encoded(std::clamp(linear, 0.0, 1.0)); }

struct Errors {
    double mean = 0, worst = 0, unshadowed = 0;
    int pixels = 0;
};

/// Errors of a picture in codes against light that rays in `directions` directions bring in. bounce: share of what they do not.
Errors against_rays(const Model& model, const EnvironmentImage& sky, const std::vector<float>& picture, const std::vector<float>& open,
                    int directions, double bounce = 0) {
    const std::vector<Vec3d> around = shading::sky_directions(directions);
    std::vector<double> radiance;
    for (const Vec3d& d : around) {
        const sh::EquirectPoint at = sh::equirect_point(d);
        const int x = std::min(static_cast<int>(at.u * sky.width), sky.width - 1),
                  y = std::min(static_cast<int>(at.v * sky.height), sky.height - 1);
        radiance.push_back(double{sky.rgb[static_cast<std::size_t>(3 * (y * sky.width + x) + 1)]});
    }
    const Mat4& m = model.camera.world_from_camera;
    const Vec3d right = to_double({m.c[0].x, m.c[0].y, m.c[0].z}), up = to_double({m.c[1].x, m.c[1].y, m.c[1].z}),
                back = to_double({m.c[2].x, m.c[2].y, m.c[2].z}), eye = to_double({m.c[3].x, m.c[3].y, m.c[3].z});
    const double half = std::tan(0.5 * double{model.camera.fov_y_rad});
    Errors errors;
    for (int y = 1; y < kHeight; y += 3)
        for (int x = 1; x < kWidth; x += 3) {
            const double sx = (2 * (x + 0.5) / kWidth - 1) * half * kWidth / kHeight, sy = (1 - 2 * (y + 0.5) / kHeight) * half;
            Vec3d d = right * sx + up * sy - back;
            d = d * (1.0 / length(d));
            const auto hit = model.first(eye, d);
            const auto at = static_cast<std::size_t>(4 * (y * kWidth + x));
            if (!hit || picture[at + 3] < 1.0f) continue;
            double light = 0;
            for (std::size_t i = 0; i < around.size(); ++i) {
                const double cosine = dot(hit->normal, around[i]);
                if (cosine <= 0) continue;
                const bool hidden = model.first(hit->p + hit->normal * 1e-6, around[i]).has_value();
                light += cosine * radiance[i] * 4 / directions * (hidden ? bounce : 1);
            }
            const double error = std::abs(code(double{picture[at + 1]}) - code(light));
            errors.mean += error;
            errors.worst = std::max(errors.worst, error);
            errors.unshadowed += std::abs(code(double{open[at + 1]}) - code(light));
            ++errors.pixels;
        }
    errors.mean /= errors.pixels;
    errors.unshadowed /= errors.pixels;
    return errors;
}

/// A sky brighter above and on one side.
EnvironmentImage uneven_sky() {
    EnvironmentImage sky{64, 32, {}, true};
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            const Vec3d d = sh::equirect_direction((x + 0.5) / 64, (y + 0.5) / 32);
            const auto light = static_cast<float>(0.35 + 0.25 * d.y + 0.2 * d.x);
            sky.rgb.insert(sky.rgb.end(), {light, light, light});
        }
    return sky;
}

}  // namespace

TEST_CASE("sky shadows: the light of rays in 4,096 directions, within five codes on average, and two with 256 maps, and by small lights",
          "[raster][sky-shadows]") {
    for (const bool studio : {false, true}) {
        const EnvironmentImage sky = studio ? studio_image() : uneven_sky();
        for (const auto& make : {box_on_plane, niche, ball_in_bowl}) {
            const Model model = make(sky);
            const std::vector<float> open = draw(model, 0);
            for (const int directions : {64, 128, 256}) {
                const Errors errors = against_rays(model, sky, draw(model, directions), open, 4096);
                UNSCOPED_INFO(model.name << (studio ? " in the studio" : "") << ", " << directions << " directions: mean " << errors.mean
                                         << " codes, worst " << errors.worst << ", without sky shadows " << errors.unshadowed);
                CHECK(errors.pixels > 150);
                CHECK(errors.mean <= (directions == 64 ? 5.0 : directions == 128 ? 3.0 : 2.2) + (studio ? 1.5 : 0.0));
                CHECK(errors.mean < errors.unshadowed / 4);
            }
            const Errors errors = against_rays(model, sky, draw(model, kSkyShadowsAuto), open, 4096, double{shading::kGridBounce});
            UNSCOPED_INFO(model.name << (studio ? " in the studio" : "") << ", by the grid: mean " << errors.mean << " codes, worst "
                                     << errors.worst << ", without sky shadows " << errors.unshadowed);
            CHECK(errors.mean <= 6.0);
            CHECK(errors.mean < errors.unshadowed * 0.55);  // of the box; of the others less than a tenth
        }
    }
}

TEST_CASE("sky shadows: what the grid hides on a wide floor fades before its border", "[raster][sky-shadows]") {
    Model model = of_boxes("two boxes on a floor", uneven_sky(), {{{-2, 0, -0.3}, {-1.4, 2, 0.3}}, {{1.4, 0, -0.3}, {2, 2, 0.3}}},
                           looking({0, 9, 0.01f}, {0, 0, 0}));
    add_ground(model.scene, scene_bounds(model.scene));
    const std::vector<float> picture = draw(model, kSkyShadowsAuto);
    const auto is_floor = [](const float* pixel) { return pixel[1] == 0.0f; };  // a catcher of shadows is black
    double at_border = 0;
    int shadowed = 0, pairs = 0;
    for (int y = 1; y < kHeight; ++y)
        for (int x = 1; x < kWidth; ++x) {
            const float* const here = &picture[static_cast<std::size_t>(4 * (y * kWidth + x))];
            shadowed += is_floor(here) && here[3] > 0.02f;
            for (const float* const before : {here - 4, here - 4 * kWidth})
                if (is_floor(here) && is_floor(before) && (here[3] == 0.0f || before[3] == 0.0f))
                    at_border = std::max(at_border, double{std::max(here[3], before[3])}), pairs += here[3] != before[3];
        }
    CAPTURE(shadowed, pairs, at_border);
    CHECK(pairs > 50);
    CHECK(shadowed > 150);
    CHECK(at_border < 0.1);  // 0.08; 0.19 where shares end at once
}

/// The model in another unit of length.
Model scaled(const Model& model, float by) {
    Model out = model;
    for (Mesh& mesh : out.scene.meshes)
        for (Vec3f& p : mesh.positions) p = p * by;
    const auto move = [by](Mat4& m) { m.c[3] = {m.c[3].x * by, m.c[3].y * by, m.c[3].z * by, m.c[3].w}; };
    for (Instance& instance : out.scene.instances) move(instance.world_from_object);
    move(out.camera.world_from_camera);
    return out;
}

/// The largest difference of two pictures in codes, and the share of values that differ by more than two.
struct Difference {
    double worst = 0, far_off = 0;
};
Difference between(const std::vector<float>& a, const std::vector<float>& b) {
    Difference out;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double apart = std::abs(code(double{a[i]}) - code(double{b[i]}));
        out.worst = std::max(out.worst, apart);
        out.far_off += apart > 2 ? 1.0 / static_cast<double>(a.size()) : 0.0;
    }
    return out;
}

TEST_CASE("sky shadows: the unit of length does not matter to the grid", "[raster][sky-shadows]") {
    const EnvironmentImage sky = uneven_sky();
    for (const auto& make : {box_on_plane, ball_in_bowl}) {
        const Model model = make(sky);
        const std::vector<float> picture = draw(model, kSkyShadowsAuto);
        CHECK(picture != draw(model, 0));
        for (const int power : {-60, -10, 2, 30, 60}) CHECK(draw(scaled(model, std::ldexp(1.0f, power)), kSkyShadowsAuto) == picture);
        for (const float by : {3.0f, 2.54f, 1000.0f, 1e-3f, 1e18f}) {
            const Difference difference = between(draw(scaled(model, by), kSkyShadowsAuto), picture);
            const Difference edges = between(draw(scaled(model, by), 0), draw(model, 0));
            CAPTURE(model.name, by, difference.worst, difference.far_off, edges.far_off);
            CHECK(difference.far_off <= edges.far_off + 1e-3);
        }
    }
}

TEST_CASE("sky shadows: a part that moves out of view leaves what stands still as it is", "[raster][sky-shadows]") {
    for (const float x : {0.0f, 2.5f}) {
        const auto drawn = [&](float height) {
            Model model = box_on_plane(uneven_sky());
            add(model.scene, make_sphere_of(0.1f, 200), {x, height, x});
            model.camera = looking({2, 1.5f, 3}, {0, 0.2f, 0});
            return draw(model, kSkyShadowsAuto);
        };
        for (const float by : {0.05f, 0.4f}) {
            const Difference difference = between(drawn(3.2f), drawn(3.2f + by));
            CAPTURE(x, by, difference.worst, difference.far_off);
            CHECK(difference.far_off <= 1e-3);
        }
    }
}

TEST_CASE("sky shadows: light passes through the backs of single-sided walls alone", "[raster][sky-shadows]") {
    // A room whose walls face inwards, seen through the nearest of them.
    Model model{"a room", white_scene(uneven_sky()), looking({0, 0.3f, 6}, {0, 0, 0}), {}};
    Mesh walls = make_box({1, 1, 1});
    for (std::size_t i = 0; i + 2 < walls.indices.size(); i += 3) std::swap(walls.indices[i + 1], walls.indices[i + 2]);
    for (Vec3f& normal : walls.normals) normal = normal * -1.0f;
    add(model.scene, std::move(walls), {0, 0, 0});
    const auto middle = [](const std::vector<float>& picture) {
        return double{picture[static_cast<std::size_t>(4 * (kHeight / 2 * kWidth + kWidth / 2) + 1)]};
    };
    const double open = middle(draw(model, 0));
    CHECK(open > 0.1);
    CHECK(middle(draw(model, kSkyShadowsAuto)) == Approx(open));
    // The far wall sees the near ones turn their backs to the sky no more. The camera stands inside.
    model.scene.materials[0].double_sided = true;
    model.camera = looking({0, 0, 0.9f}, {0, 0, -1});
    CHECK(middle(draw(model, kSkyShadowsAuto)) < 0.6 * middle(draw(model, 0)));
}

TEST_CASE("sky shadows: surfaces hide what they cover, as far as they are opaque", "[raster][sky-shadows]") {
    // Light on the floor's middle, below a plate, a grate that covers a fifth of its area, and glass.
    const auto hidden = [](bool grate, float alpha, float transmission) {
        Model model{"a plate", white_scene(uneven_sky()), looking({2, 0.3f, 2}, {0, 0, 0}), {}};
        add(model.scene, make_box({1, 0.05f, 1}), {0, -0.05f, 0});
        model.scene.materials.push_back(model.scene.materials[0]);
        Material& material = model.scene.materials[1];
        if (alpha < 1) material.alpha_mode = AlphaMode::blend, material.base_color.w = alpha;
        material.transmission = transmission;
        const int bars = grate ? 10 : 1;
        for (int k = 0; k < bars; ++k) {
            const float at = bars == 1 ? 0.0f : -0.9f + 0.2f * static_cast<float>(k);
            add(model.scene, make_box({bars == 1 ? 1.0f : 0.02f, 0.02f, 1}), {at, 0.7f, 0});
            model.scene.meshes.back().material = 1;
        }
        const auto middle = static_cast<std::size_t>(4 * (kHeight / 2 * kWidth + kWidth / 2) + 1);
        return 1.0 - double{draw(model, kSkyShadowsAuto)[middle]} / double{draw(model, 0)[middle]};
    };
    const double plate = hidden(false, 1, 0), grate = hidden(true, 1, 0), faint = hidden(false, 0.5f, 0), glass = hidden(false, 1, 1);
    CAPTURE(plate, grate, faint, glass);
    CHECK(plate > 0.3);
    CHECK(grate > 0.05 * plate);
    CHECK(grate < 0.4 * plate);
    CHECK(faint > 0.3 * plate);
    CHECK(faint < 0.7 * plate);
    CHECK(glass > 0.05 * plate);
    CHECK(glass < 0.35 * plate);
}

TEST_CASE("sky shadows: the size of a large ground does not matter to what stands on it", "[raster][sky-shadows]") {
    const auto drawn = [](float half) {
        Model model{"a ball on a ground", white_scene(uneven_sky()), looking({2, 2, 4}, {0, 0.8f, 0}), {}};
        add(model.scene, make_sphere(1.0f, 24, 24), {0, 1, 0});
        add(model.scene, make_plane(half, 1), {0, 0, 0});
        return model;
    };
    const std::vector<float> wide = draw(drawn(100), kSkyShadowsAuto), wider = draw(drawn(3000), kSkyShadowsAuto);
    const Difference edges = between(draw(drawn(100), 0), draw(drawn(3000), 0));
    CHECK(between(wide, wider).far_off <= edges.far_off + 1e-3);
    CHECK(between(wide, draw(drawn(100), 0)).far_off > 0.02);
}

TEST_CASE("sky shadows: the order of instances does not matter to the grid", "[raster][sky-shadows]") {
    Model model = niche(uneven_sky());
    const std::vector<float> picture = draw(model, kSkyShadowsAuto);
    std::reverse(model.scene.instances.begin(), model.scene.instances.end());
    CHECK(between(picture, draw(model, kSkyShadowsAuto)).worst < 0.01);
}

TEST_CASE("sky shadows: convex bodies do not hide light from themselves", "[raster][sky-shadows]") {
    for (const bool studio : {false, true})
        for (const int kind : {0, 1, 2, 3}) {
            const bool double_sided = kind % 2 != 0;
            Model model{"one body", white_scene(studio ? studio_image() : uneven_sky()), looking({1, 2, 3}, {0, 0, 0}), {}};
            model.scene.materials[0].double_sided = double_sided;
            Mesh body = kind < 2 ? make_sphere(1.0f, 48, 48) : make_box({1, 0.8f, 0.9f});
            add(model.scene, std::move(body), {0, 0, 0});
            const Difference difference = between(draw(model, kSkyShadowsAuto), draw(model, 0));
            CAPTURE(studio, double_sided, difference.worst);
            CHECK(difference.worst < 2);
        }
}

TEST_CASE("sky shadows: what nothing hides keeps its bits", "[raster][sky-shadows]") {
    Model model{"a plane", white_scene(uneven_sky()), looking({1, 2, 3}, {0, 0, 0}), {}};
    add(model.scene, make_plane(1.0f, 8), {0, 0, 0});
    for (const int sky_shadows : {kSkyShadowsAuto, 64}) CHECK(draw(model, sky_shadows) == draw(model, 0));
    model.scene.environment = nullptr;
    model.scene.ambient = {{0.5f, 0.6f, 0.7f}, {0.3f, 0.2f, 0.1f}};
    for (const int sky_shadows : {kSkyShadowsAuto, 64}) CHECK(draw(model, sky_shadows) == draw(model, 0));
}

TEST_CASE("sky shadows: a closed room is black inside, with highlights and wrapped light, under a sky and ambient light",
          "[raster][sky-shadows]") {
    for (const bool ambient : {false, true})
        for (const float wrap : {0.0f, 0.5f}) {
            Scene scene = white_scene(uneven_sky());
            if (ambient) scene.environment = nullptr, scene.ambient = {{0.5f, 0.6f, 0.7f}, {0.3f, 0.2f, 0.1f}};
            scene.materials[0].lobe = wrap > 0 ? Lobe::sloan(wrap) : Lobe::lambert();
            scene.materials[0].double_sided = true;
            add(scene, make_box({4, 4, 4}), {0, 0, 0});
            add(scene, make_sphere_of(0.5f, 800), {0, 0, 0});
            Settings settings;
            settings.sky_shadows = 64;
            std::vector<float> linear(static_cast<std::size_t>(4 * kWidth * kHeight));
            REQUIRE(render(scene, looking({0, 1, 3}, {0, 0, 0}), settings, {.width = kWidth, .height = kHeight, .linear = linear.data()}));
            // The ball and the wall behind it; light leaks through the room's edges, by a texel or two of the maps.
            float most = 0;
            for (int y = kHeight / 4; y < 3 * kHeight / 4; ++y)
                for (int x = kWidth / 4; x < 3 * kWidth / 4; ++x)
                    for (int c = 0; c < 3; ++c) most = std::max(most, linear[static_cast<std::size_t>(4 * (y * kWidth + x) + c)]);
            CHECK(most < (wrap > 0 ? 0.05f : 1e-5f));  // a little wrapped light leaks in within the distance of its fading
        }
}

TEST_CASE("sky shadows: the lights of all directions together are the sky's light", "[raster][sky-shadows]") {
    for (const int n : {16, 64, 300}) {
        const EnvironmentImage image = studio_image();
        const auto sky = make_environment(image, {.extract_suns = false}).value();
        double sum = 0;
        Vec3d mean{};
        shading::SkyCells cells;
        for (const Light& light : shading::sky_lights(n, 96, sky.get(), {}, cells)) {
            sum += double{light.color_linear.y};
            mean = mean + to_double(light.direction_ws) * (1.0 / n);
        }
        double expected = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                expected += double{image.rgb[static_cast<std::size_t>(3 * (y * image.width + x) + 1)]} *
                            sh::pixel_solid_angle(image.width, image.height, y) / kPi;
        CHECK(sum == Approx(expected).epsilon(1e-5));
        CHECK(length(mean) < 0.05);
    }
}

TEST_CASE("sky shadows: the same bits by every instruction set, tile size and number of threads, and in a crop", "[raster][sky-shadows]") {
    Model model = niche(studio_image());
    model.scene.materials[0].roughness = 0.4f;
    model.scene.materials[0].lobe = Lobe::sloan(0.4f);
    Settings settings;
    settings.samples = 4;
    const auto picture = [&](const Settings& with, const Execution& execution) {
        std::vector<std::uint8_t> pixels(static_cast<std::size_t>(4 * kWidth * kHeight));
        REQUIRE(render(model.scene, model.camera, with, {.width = kWidth, .height = kHeight, .pixels = pixels.data()}, execution));
        return pixels;
    };
    settings.sky_shadows = GENERATE(as<int>{}, kSkyShadowsAuto, 32);
    const auto expected = picture(settings, {.threads = 1, .isa = Isa::scalar});
    for (const Isa isa : test::available_isas())
        for (const int tile : {16, 64})
            for (const int threads : {1, 3}) CHECK(picture(settings, {.threads = threads, .tile_size = tile, .isa = isa}) == expected);
    Settings crop = settings;
    crop.region = {31, 17, 40, 33};
    const auto part = picture(crop, {});
    for (int y = 17; y < 50; ++y)
        for (int x = 31; x < 71; ++x)
            for (int c = 0; c < 4; ++c) {
                const auto i = static_cast<std::size_t>(4 * (y * kWidth + x) + c);
                if (part[i] != expected[i]) FAIL(x << ", " << y);
            }
}

TEST_CASE("sky shadows: accuracy reference draws the same, and an error budget keeps its promise", "[raster][sky-shadows]") {
    Model model = box_on_plane(studio_image());
    model.scene.materials[0].roughness = 0.5f;
    const int sky_shadows = GENERATE(as<int>{}, kSkyShadowsAuto, 64);
    const auto picture = [&](const ShadingSettings& shading, double* bound) {
        Settings settings;
        settings.sky_shadows = sky_shadows;
        settings.shading = shading;
        std::vector<float> linear(static_cast<std::size_t>(4 * kWidth * kHeight));
        const auto report = render(model.scene, model.camera, settings, {.width = kWidth, .height = kHeight, .linear = linear.data()});
        if (!report) FAIL(report.error().message);
        if (bound != nullptr) *bound = report->error.codes;
        return linear;
    };
    ShadingSettings exact, reference, budget;
    reference.accuracy = Accuracy::reference;
    budget.max_error_codes = 4;
    const auto truth = picture(reference, nullptr);
    double bound = 0;
    const auto apart = [](const std::vector<float>& a, const std::vector<float>& b) {
        double most = 0;
        for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(code(double{a[i]}) - code(double{b[i]})));
        return most;
    };
    const auto full = picture(exact, nullptr), cheap = picture(budget, &bound);
    CHECK(apart(full, truth) < 0.5);
    CHECK(apart(cheap, full) <= bound);
    CHECK(bound > 0);
}
