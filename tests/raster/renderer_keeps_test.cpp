// Single things that a Renderer keeps from frame to frame, each changed in a way that is easily missed.
#include "halflit/renderer.hpp"
#include "raster/detail/raw_buffer.hpp"
#include "shading/environment.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <cstring>
#include <functional>
#include <new>
#include <utility>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

constexpr int kWidth = 96, kHeight = 64;

using Pixels = std::vector<float>;

Pixels draw(Renderer& renderer, const PreparedScene& scene, const Camera& camera, const Settings& settings) {
    Pixels pixels(std::size_t{4} * kWidth * kHeight);
    const auto report = renderer.render(scene, camera, settings, {kWidth, kHeight, nullptr, pixels.data()});
    INFO((report ? "" : report.error().message));
    REQUIRE(report);
    return pixels;
}

Pixels draw_anew(const Scene& scene, const Camera& camera, const Settings& settings) {
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    Renderer renderer;
    return draw(renderer, *prepared, camera, settings);
}

int differing(const Pixels& a, const Pixels& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.size(); i += 4) count += std::memcmp(&a[i], &b[i], 16) != 0;
    return count;
}

Settings small_shadows() {
    Settings settings;
    settings.shadow_size = 128;
    return settings;
}

Environment sky(std::uint64_t seed) {
    halflit::test::Random random(seed);
    std::vector<float> rgb;
    for (int i = 0; i < 3 * 16 * 8; ++i) rgb.push_back(random.real32(0, 0.6));
    return shading::make_environment({16, 8, rgb}, {.extract_suns = false, .keep_light = true});
}

PreparedScene made(const Scene& scene) {
    auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    return std::move(*prepared);
}

const SceneChanges kLights{{}, {}, false, true};

}  // namespace

TEST_CASE("renderer: the shadow of a masked surface follows the texture filter", "[raster][retention]") {
    for (const NamedScene& s : {materials_scene(), layers_scene()}) {
        const PreparedScene prepared = made(s.scene);
        Renderer renderer;
        for (const TextureDetail detail : {TextureDetail::full, TextureDetail::nearest, TextureDetail::bilinear, TextureDetail::full}) {
            Settings settings = small_shadows();
            settings.shading.texture_detail = detail;
            INFO(s.name << ", filter " << static_cast<int>(detail));
            CHECK(differing(draw(renderer, prepared, s.camera, settings), draw_anew(s.scene, s.camera, settings)) == 0);
        }
    }
}

TEST_CASE("renderer: an environment changed in place is used after the update that tells of it", "[raster][retention]") {
    NamedScene s = materials_scene();
    Environment environment = sky(1);
    s.scene.environment = shading::borrowed(environment);
    PreparedScene prepared = made(s.scene);
    Renderer renderer;
    const Pixels before = draw(renderer, prepared, s.camera, small_shadows());
    environment = sky(2);
    REQUIRE(prepared.update(kLights));
    const Pixels expected = draw_anew(s.scene, s.camera, small_shadows());
    CHECK(differing(before, expected) > 1000);
    CHECK(differing(draw(renderer, prepared, s.camera, small_shadows()), expected) == 0);
}

TEST_CASE("renderer: successive scenes whose environments have one address are told apart", "[raster][retention]") {
    Renderer renderer;
    for (const std::uint64_t seed : {1, 2, 3}) {
        const Environment environment = sky(seed);
        NamedScene s = materials_scene();
        s.scene.environment = shading::borrowed(environment);
        INFO("sky " << seed);
        CHECK(differing(draw(renderer, made(s.scene), s.camera, small_shadows()), draw_anew(s.scene, s.camera, small_shadows())) == 0);
    }
}

TEST_CASE("renderer: reference accuracy uses a new environment at the address of a freed one", "[raster][retention]") {
    alignas(Environment) static std::byte place[sizeof(Environment)];
    int alive = 0;
    const auto at_the_place = [&alive](std::uint64_t seed) {
        REQUIRE(alive == 0);
        ++alive;
        return std::shared_ptr<const Environment>(new (place) Environment(sky(seed)), [&alive](const Environment* e) {
            e->~Environment();
            --alive;
        });
    };
    NamedScene s = materials_scene();
    for (Material& material : s.scene.materials) material.lobe = Lobe::lambert();  // one integration for all: 0.5 s
    Settings reference = small_shadows();
    reference.shading.accuracy = Accuracy::reference;
    s.scene.environment = at_the_place(1);
    PreparedScene prepared = made(s.scene);
    Renderer renderer;
    const Pixels before = draw(renderer, prepared, s.camera, reference);

    s.scene.environment = std::make_shared<const Environment>(sky(2));
    REQUIRE(prepared.update(kLights));
    draw(renderer, prepared, s.camera, small_shadows());
    if (alive == 0) s.scene.environment = at_the_place(3);  // otherwise the Renderer holds the first one, and its place is not free
    REQUIRE(prepared.update(kLights));
    const Pixels expected = draw_anew(s.scene, s.camera, reference);
    CHECK(differing(before, expected) > 1000);
    CHECK(differing(draw(renderer, prepared, s.camera, reference), expected) == 0);
}

TEST_CASE("renderer: shading once a vertex does not affect later frames", "[raster][retention]") {
    for (const NamedScene& s : all_scenes()) {
        const PreparedScene prepared = made(s.scene);
        Renderer renderer;
        for (const ShadingRate rate :
             {ShadingRate::gouraud, ShadingRate::pixel, ShadingRate::gouraud, ShadingRate::gouraud, ShadingRate::flat}) {
            Settings settings = small_shadows();
            settings.shading.rate = rate;
            INFO(s.name << ", rate " << static_cast<int>(rate));
            CHECK(differing(draw(renderer, prepared, s.camera, settings), draw_anew(s.scene, s.camera, settings)) == 0);
        }
    }
}

TEST_CASE("renderer: vertex attributes that only light needs are present when a light is added", "[raster][retention]") {
    for (NamedScene s : all_scenes()) {
        const Scene lit = s.scene;
        s.scene.lights.clear();
        s.scene.ambient = {};
        s.scene.environment = nullptr;
        PreparedScene prepared = made(s.scene);
        Renderer renderer;
        Settings settings = small_shadows();
        settings.shadows = ShadowMode::off;
        INFO(s.name);
        const Pixels dark = draw(renderer, prepared, s.camera, settings);
        CHECK(differing(dark, draw_anew(s.scene, s.camera, settings)) == 0);
        s.scene.lights = lit.lights;
        REQUIRE(prepared.update(kLights));
        const Pixels light = draw(renderer, prepared, s.camera, settings);
        CHECK(differing(light, draw_anew(s.scene, s.camera, settings)) == 0);
        s.scene.lights.clear();
        REQUIRE(prepared.update(kLights));
        CHECK(differing(draw(renderer, prepared, s.camera, settings), dark) == 0);
    }
}

TEST_CASE("renderer: meshes that moved in memory are found again", "[raster][retention]") {
    NamedScene s = materials_scene();
    const PreparedScene prepared = made(s.scene);
    Renderer renderer;
    draw(renderer, prepared, s.camera, small_shadows());
    s.scene.meshes.reserve(4 * s.scene.meshes.capacity() + 100);
    for (Mesh& mesh : s.scene.meshes) mesh.positions.reserve(4 * mesh.positions.capacity());
    Settings settings = small_shadows();
    settings.shading.rate = ShadingRate::gouraud;
    CHECK(differing(draw(renderer, prepared, s.camera, settings), draw_anew(s.scene, s.camera, settings)) == 0);
}

TEST_CASE("renderer: settings are checked although the plan is kept", "[raster][retention]") {
    const NamedScene s = materials_scene();
    const PreparedScene prepared = made(s.scene);
    Renderer renderer;
    const Pixels first = draw(renderer, prepared, s.camera, small_shadows());
    Pixels pixels(first.size());
    const auto report = renderer.render(prepared, s.camera, small_shadows(), {kWidth, kHeight, nullptr, pixels.data()}, {.tile_size = 17});
    REQUIRE_FALSE(report);
    CHECK(report.error().message == "tile size: 17, expected 16, 32 or 64");
    CHECK(differing(draw(renderer, prepared, s.camera, small_shadows()), first) == 0);
}

TEST_CASE("renderer: an exception of the host becomes an error, and the next frame is right", "[raster][retention]") {
    const NamedScene s = materials_scene();
    const PreparedScene prepared = made(s.scene);
    Renderer renderer;
    const Execution execution{.threads = 1, .cancelled = []() -> bool { throw 42; }};
    Pixels pixels(std::size_t{4} * kWidth * kHeight);
    const auto report = renderer.render(prepared, s.camera, small_shadows(), {kWidth, kHeight, nullptr, pixels.data()}, execution);
    REQUIRE_FALSE(report);
    CHECK(report.error().code == ErrorCode::internal);
    CHECK(differing(draw(renderer, prepared, s.camera, small_shadows()), draw_anew(s.scene, s.camera, small_shadows())) == 0);
}

TEST_CASE("renderer: working memory that could not grow is empty, not lost", "[raster][retention]") {
    RawBuffer<double> buffer;
    REQUIRE(buffer.reserve(4) != nullptr);
    CHECK_THROWS_AS(buffer.reserve(std::size_t{1} << 61), std::bad_alloc);  // a size that overflows: no allocator is asked
    CHECK(buffer.capacity() == 0);
    CHECK(buffer.reserve(2) != nullptr);
}

TEST_CASE("renderer: no frame after a failed update until one succeeds, which redoes what was told before", "[raster][retention]") {
    NamedScene s = materials_scene();
    PreparedScene prepared = made(s.scene);
    Renderer renderer;
    draw(renderer, prepared, s.camera, small_shadows());
    const auto drawn = [&] {
        Pixels pixels(std::size_t{4} * kWidth * kHeight);
        return renderer.render(prepared, s.camera, small_shadows(), {kWidth, kHeight, nullptr, pixels.data()}).has_value();
    };
    const auto is_new = [&] {
        return differing(draw(renderer, prepared, s.camera, small_shadows()), draw_anew(s.scene, s.camera, small_shadows())) == 0;
    };

    s.scene.instances[1].world_from_object = s.scene.instances[1].world_from_object * translation({0.2f, 0.1f, 0});
    REQUIRE_FALSE(prepared.update({.changed_instances = {1, 999}}));
    CHECK_FALSE(drawn());
    REQUIRE(prepared.update(kLights));
    CHECK(is_new());

    Mesh& mesh = s.scene.meshes[0];
    for (Vec3f& p : mesh.positions) p.y *= 1.1f;
    const std::uint32_t index = std::exchange(s.scene.meshes[1].indices[0], 1u << 30);
    REQUIRE_FALSE(prepared.update({.deformed_meshes = {0, 1}}));
    CHECK_FALSE(drawn());
    s.scene.meshes[1].indices[0] = index;
    REQUIRE(prepared.update({.deformed_meshes = {1}}));
    CHECK(is_new());

    const Texture texture = s.scene.textures.back();
    s.scene.textures.pop_back();
    CHECK_FALSE(prepared.update({.materials = true}));
    s.scene.textures.push_back(texture);
    REQUIRE(prepared.update({}));
    CHECK(is_new());
}
