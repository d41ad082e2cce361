// Planes of the visible surface: positions, shading normals, base colours, lights and coverage, against closed forms.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "halflit/target.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstring>

using namespace halflit;
using halflit::raster::test::NamedScene;
using halflit::test::available_isas;
using halflit::test::camera_flat;

namespace {

constexpr int kSide = 64;

/// Planes of a picture. What is not drawn keeps the value 77.
struct Planes {
    int width, height;
    std::vector<std::uint8_t> codes;
    std::vector<float> normal, albedo, position, coverage, linear;
    std::vector<std::uint32_t> lights;
    RenderReport report;

    explicit Planes(int w = kSide, int h = kSide)
        : width(w),
          height(h),
          codes(4 * pixels()),
          normal(3 * pixels(), 77),
          albedo(3 * pixels(), 77),
          position(3 * pixels(), 77),
          coverage(pixels(), 77),
          linear(4 * pixels(), 77),
          lights(pixels(), 77) {}
    [[nodiscard]] std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    [[nodiscard]] Target target() {
        return {.width = width,
                .height = height,
                .pixels = codes.data(),
                .linear = linear.data(),
                .shading_normal = normal.data(),
                .albedo = albedo.data(),
                .position = position.data(),
                .lights = lights.data(),
                .coverage = coverage.data()};
    }
    void draw(const Scene& scene, const Camera& camera, const Settings& settings = {}, const Execution& execution = {}) {
        const auto drawn = render(scene, camera, settings, target(), execution);
        INFO((drawn ? std::string() : drawn.error().message));
        REQUIRE(drawn);
        report = *drawn;
    }
    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    [[nodiscard]] static Vec3d of(const std::vector<float>& plane, std::size_t i) {
        return {plane[3 * i], plane[3 * i + 1], plane[3 * i + 2]};
    }
    bool operator==(const Planes& o) const {
        const auto same = [](const auto& a, const auto& b) {
            return a.size() == b.size() && std::memcmp(a.data(), b.data(), 4 * a.size()) == 0;
        };
        return same(normal, o.normal) && same(albedo, o.albedo) && same(position, o.position) && same(coverage, o.coverage) &&
               same(lights, o.lights);
    }
};

/// World x or -y of a pixel's centre under camera_flat(1).
double world(int pixel, int side = kSide) { return 2.0 * (pixel + 0.5) / side - 1.0; }

Material& add(Scene& scene, Mesh mesh) {
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.emplace_back();
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, {}});
    return scene.materials.back();
}

/// The square |x|, |y| <= half in the plane z = slope x.
Mesh square(float half, float slope = 0.0f) {
    Mesh m;
    m.positions = {{-half, -half, -half * slope}, {half, -half, half * slope}, {half, half, half * slope}, {-half, half, -half * slope}};
    m.normals.assign(4, {-slope, 0, 1});
    m.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    m.indices = {0, 1, 2, 0, 2, 3};
    return m;
}

int add_texture(Scene& scene, const std::vector<std::uint8_t>& rgba, int width, int height, ColorSpace space = ColorSpace::linear) {
    scene.textures.push_back(Texture::from_rgba8(rgba, width, height, space).value());
    return static_cast<int>(scene.textures.size()) - 1;
}

double apart(Vec3d a, Vec3d b) { return length(a - b); }

}  // namespace

TEST_CASE("surface planes: a tilted square has its plane's positions, normal and colour, and nothing is 0", "[raster][planes]") {
    Scene scene;
    add(scene, square(0.5f, 2.0f)).base_color = {0.25f, 0.5f, 0.75f, 1};
    Planes p;
    p.draw(scene, camera_flat());
    const Vec3d normal = Vec3d{-2, 0, 1} * (1 / std::sqrt(5.0));
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const std::size_t i = p.at(x, y);
            const double wx = world(x), wy = -world(y);
            const bool inside = std::abs(wx) < 0.5 && std::abs(wy) < 0.5;
            REQUIRE(p.coverage[i] == (inside ? 1.0f : 0.0f));
            REQUIRE(apart(p.of(p.position, i), inside ? Vec3d{wx, wy, 2 * wx} : Vec3d{}) < 1e-6);
            REQUIRE(apart(p.of(p.normal, i), inside ? normal : Vec3d{}) < 1e-6);
            REQUIRE(p.of(p.albedo, i) == (inside ? Vec3d{0.25, 0.5, 0.75} : Vec3d{}));
            REQUIRE(p.lights[i] == 0);
        }
}

TEST_CASE("surface planes: a fine sphere has the positions and normals of its formula", "[raster][planes]") {
    Scene scene;
    add(scene, make_sphere(0.8f, 256, 128));
    Planes p;
    p.draw(scene, camera_flat());
    int seen = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double wx = world(x), wy = -world(y), z2 = 0.64 - wx * wx - wy * wy;
            if (z2 < 0.05) continue;  // towards the rim, chords of 1/256 of the circle change z more and more
            ++seen;
            const Vec3d wanted{wx, wy, std::sqrt(z2)};
            REQUIRE(apart(p.of(p.position, p.at(x, y)), wanted) < 1e-3);
            REQUIRE(apart(p.of(p.normal, p.at(x, y)), wanted * (1 / 0.8)) < 1e-3);
        }
    CHECK(seen > 1000);
}

TEST_CASE("surface planes: the shading normal follows the normal map, with any light or none, and turns on backs", "[raster][planes]") {
    // The texel 191, 128, 220 of a map with tangent +x: (2 c - 1) scaled, then made unit.
    const Vec3d texel{2 * 191 / 255.0 - 1, 2 * 128 / 255.0 - 1, 2 * 220 / 255.0 - 1};
    for (const bool lit : {false, true})
        for (const bool back : {false, true}) {
            CAPTURE(lit, back);
            Scene scene;
            Mesh mesh = square(0.5f);
            mesh.tangents.assign(4, {1, 0, 0, 1});
            Material& material = add(scene, std::move(mesh));
            material.double_sided = true;
            material.normal_scale = 0.5f;
            material.textures[TextureSlot::normal].texture = add_texture(scene, {191, 128, 220, 255}, 1, 1);
            if (lit) scene.lights.push_back({});
            Camera camera = camera_flat();
            if (back) camera.world_from_camera = {{{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 0}, {0, 0, -10, 1}}};
            Planes p;
            p.draw(scene, camera);
            const Vec3d mapped{0.5 * texel.x, 0.5 * texel.y, texel.z};
            const Vec3d wanted = mapped * ((back ? -1 : 1) / length(mapped));
            REQUIRE(apart(p.of(p.normal, p.at(kSide / 2, kSide / 2)), wanted) < 1e-4);  // texels are kept in 16 bits
        }
}

TEST_CASE("surface planes: the albedo is factor times texture times vertex colour, of lit, dark, unlit and masked surfaces",
          "[raster][planes]") {
    for (const bool unlit : {false, true})
        for (const bool lit : {false, true})
            for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::mask}) {
                CAPTURE(unlit, lit, mode);
                Scene scene;
                Mesh mesh = square(0.5f);
                mesh.colors.assign(4, {0.5f, 1, 0.25f, 1});
                Material& material = add(scene, std::move(mesh));
                material.unlit = unlit;
                material.alpha_mode = mode;
                material.base_color = {1, 0.5f, 0.5f, 1};
                material.metallic = 1;  // the base colour, not the diffuse part of it
                // The left half is masked away.
                material.textures[TextureSlot::base_color].texture = add_texture(scene, {255, 0, 0, 0, 0, 255, 51, 255}, 2, 1);
                material.textures[TextureSlot::base_color].sampler = {.mag = TextureFilter::nearest, .min = TextureFilter::nearest};
                if (lit) scene.lights.push_back({});
                Planes p;
                p.draw(scene, camera_flat());
                const std::size_t left = p.at(kSide / 2 - 8, kSide / 2), right = p.at(kSide / 2 + 8, kSide / 2);
                CHECK(apart(p.of(p.albedo, right), {0, 0.5, 0.2 * 0.125}) < 1e-6);
                CHECK(apart(p.of(p.albedo, left), mode == AlphaMode::mask ? Vec3d{} : Vec3d{0.5, 0, 0}) < 1e-6);
                CHECK(p.coverage[left] == (mode == AlphaMode::mask ? 0.0f : 1.0f));
            }
}

TEST_CASE("surface planes: the number of lights is that of the ranges and cones around each point", "[raster][planes]") {
    Scene scene;
    add(scene, square(1.0f));
    const double kAngle = 0.4;
    scene.lights.push_back({.type = LightType::directional, .direction_ws = {0, 0, 1}});  // from behind counts too
    scene.lights.push_back({.type = LightType::directional, .color_linear = {0, 0, 0}});  // black: none
    scene.lights.push_back({.type = LightType::point, .position_ws = {0, 0, 5}});
    for (int i = 0; i < 40; ++i)
        scene.lights.push_back({.type = LightType::point,
                                .position_ws = {0.9f * std::cos(0.7f * static_cast<float>(i)), -1 + 0.05f * static_cast<float>(i), 0.1f},
                                .range = 0.15f + 0.01f * static_cast<float>(i)});
    for (int i = 0; i < 8; ++i)
        scene.lights.push_back({.type = LightType::spot,
                                .position_ws = {0.2f * static_cast<float>(i) - 0.8f, 0.1f, 1.0f},
                                .direction_ws = {0, 0, -1},
                                .outer_cone_rad = static_cast<float>(kAngle)});
    for (const int tile : {16, 64}) {
        Planes p;
        p.draw(scene, camera_flat(), {}, {.tile_size = tile});
        int compared = 0;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const Vec3d at{world(x), -world(y), 0};
                std::uint32_t wanted = 0;
                bool at_an_edge = false;
                for (const Light& light : scene.lights) {
                    if (light.color_linear == Vec3f{}) continue;
                    const Vec3d to = at - Vec3d{light.position_ws.x, light.position_ws.y, light.position_ws.z};
                    const double distance = length(to);
                    bool reaches = true;
                    if (light.type == LightType::point && light.range > 0) {
                        reaches = distance < static_cast<double>(light.range);
                        // Near its end, the window's share rounds to 0.
                        at_an_edge |= std::abs(distance - static_cast<double>(light.range)) < 1e-4;
                    } else if (light.type == LightType::spot) {
                        const double angle = std::acos(-to.z / distance);
                        reaches = angle < kAngle;
                        at_an_edge |= std::abs(angle - kAngle) < 1e-3;
                    }
                    wanted += reaches ? 1 : 0;
                }
                if (at_an_edge) continue;
                ++compared;
                REQUIRE(p.lights[p.at(x, y)] == wanted);
            }
        CHECK(compared > kSide * kSide * 9 / 10);
    }
    scene.materials[0].unlit = true;
    Planes unlit;
    unlit.draw(scene, camera_flat());
    CHECK(unlit.lights == std::vector<std::uint32_t>(unlit.pixels(), 0));
}

TEST_CASE("surface planes: coverage is the alpha of opaque surfaces over nothing, and blended ones do not count", "[raster][planes]") {
    for (const int samples : {1, 4, 8}) {
        CAPTURE(samples);
        Scene scene;
        add(scene, make_torus(0.6f, 0.2f, 40, 20)).unlit = true;
        Settings settings;
        settings.samples = samples;
        Camera camera = camera_flat();
        camera.world_from_camera = {{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 10, 0, 1}}};
        Planes p;
        p.draw(scene, camera, settings);
        std::vector<float> alpha;
        for (std::size_t i = 0; i < p.pixels(); ++i) alpha.push_back(p.linear[4 * i + 3]);
        CHECK(p.coverage == alpha);
        int partial = 0;
        for (const float share : p.coverage) partial += share > 0 && share < 1 ? 1 : 0;
        CHECK((partial > 50) == (samples > 1));
        scene.materials[0].alpha_mode = AlphaMode::blend;
        p.draw(scene, camera, settings);
        CHECK(p.coverage == std::vector<float>(p.pixels(), 0.0f));
        CHECK(p.albedo == std::vector<float>(3 * p.pixels(), 0.0f));
    }
}

TEST_CASE("surface planes: the first sample's surface is shown, and the mean of its neighbours is not", "[raster][planes]") {
    // Two squares that share an edge inside pixels: every pixel has one of the two colours.
    Scene scene;
    Mesh left = square(1.0f), right = square(1.0f);
    for (Vec3f& v : left.positions) v.x = v.x < 0 ? -1.0f : 0.011f;
    for (Vec3f& v : right.positions) v.x = v.x < 0 ? 0.011f : 1.0f;
    add(scene, std::move(left)).base_color = {1, 0, 0, 1};
    add(scene, std::move(right)).base_color = {0, 1, 0, 1};
    Settings settings;
    settings.samples = 8;
    Planes p;
    std::vector<std::uint32_t> instance(p.pixels());
    Target target = p.target();
    target.instance = instance.data();
    REQUIRE(render(scene, camera_flat(), settings, target));
    for (std::size_t i = 0; i < p.pixels(); ++i)
        REQUIRE(p.of(p.albedo, i) == (instance[i] == 1 ? Vec3d{1, 0, 0} : instance[i] == 2 ? Vec3d{0, 1, 0} : Vec3d{}));
}

TEST_CASE("surface planes: every instruction set, tile size, number of threads and crop gives the same bits, and the picture stays",
          "[raster][planes]") {
    for (const NamedScene& s : raster::test::all_scenes()) {
        INFO(s.name);
        for (const double budget : {0.0, 1.0}) {
            Settings settings;
            settings.shadow_size = 64;
            settings.samples = 4;
            settings.shading.max_error_codes = budget;
            Planes first(90, 60);
            first.draw(s.scene, s.camera, settings, {.threads = 1, .tile_size = 64, .isa = Isa::scalar});
            std::vector<std::uint8_t> codes(4 * first.pixels());
            const auto bare = render(s.scene, s.camera, settings, {.width = 90, .height = 60, .pixels = codes.data()}, {.tile_size = 64});
            REQUIRE(bare);
            CHECK(codes == first.codes);
            CHECK(bare->work == first.report.work);
            int tile = 16, threads = 1;
            for (const Isa isa : available_isas()) {
                INFO(isa_name(isa) << ", tile " << tile << ", threads " << threads);
                Planes p(90, 60);
                p.draw(s.scene, s.camera, settings, {.threads = threads, .tile_size = tile, .isa = isa});
                CHECK(p == first);
                tile = tile == 64 ? 16 : 2 * tile;
                threads = threads % 3 + 1;
            }
            settings.region = {17, 11, 40, 30};
            Planes part(90, 60);
            part.draw(s.scene, s.camera, settings);
            int wrong = 0;
            for (int y = 0; y < 60; ++y)
                for (int x = 0; x < 90; ++x) {
                    const std::size_t i = part.at(x, y);
                    const bool inside = x >= 17 && x < 57 && y >= 11 && y < 41;
                    wrong += part.lights[i] != (inside ? first.lights[i] : 77u);
                    wrong += part.coverage[i] != (inside ? first.coverage[i] : 77.0f);
                    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
                        wrong += part.normal[k] != (inside ? first.normal[k] : 77.0f);
                        wrong += part.albedo[k] != (inside ? first.albedo[k] : 77.0f);
                        wrong += part.position[k] != (inside ? first.position[k] : 77.0f);
                    }
                }
            CHECK(wrong == 0);
        }
    }
}
