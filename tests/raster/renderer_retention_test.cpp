// Data that a Renderer keeps from frame to frame must not be visible: whatever changed in between, the next frame equals that of a new
// Renderer with a newly prepared scene.
#include "halflit/mesh.hpp"
#include "halflit/renderer.hpp"
#include "shading/environment.hpp"
#include "tests/raster/random_geometry.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/setup.hpp"

#include "tests/support/catch.hpp"

#include <cstring>
#include <functional>
#include <limits>
#include <optional>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba8;
    std::vector<float> linear;
    Result<RenderReport> report;

    Picture(int w, int h) : width(w), height(h), rgba8(size(), 0xCD), linear(size(), -123.0f) {}
    [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(4 * width * height); }
    [[nodiscard]] Target target() { return {width, height, rgba8.data(), linear.data()}; }
};

int differing_pixels(const Picture& a, const Picture& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.rgba8.size(); i += 4)
        count += std::memcmp(&a.rgba8[i], &b.rgba8[i], 4) != 0 || std::memcmp(&a.linear[i], &b.linear[i], 16) != 0;
    return count;
}

/// Checks that the frame of a Renderer that drew others before equals that of a new one.
void check_same(const Picture& kept, const Picture& fresh) {
    CHECK(differing_pixels(kept, fresh) == 0);
    REQUIRE(kept.report.has_value() == fresh.report.has_value());
    if (!fresh.report) {
        CHECK(kept.report.error().message == fresh.report.error().message);
        return;
    }
    const RenderReport &a = *kept.report, &b = *fresh.report;
    CHECK(a.triangles_submitted == b.triangles_submitted);
    CHECK(a.triangles_drawn == b.triangles_drawn);
    CHECK(a.pixels_visible == b.pixels_visible);
    CHECK(a.fragments_shaded == b.fragments_shaded);
    CHECK(a.nan_pixels == b.nan_pixels);
    CHECK(a.error.codes == b.error.codes);
    CHECK(a.environment.size() == b.environment.size());
    CHECK(a.warnings == b.warnings);
}

std::shared_ptr<const Environment> sky(std::uint64_t seed) {
    constexpr int kWide = 16, kHigh = 8;
    Random random(seed);
    std::vector<float> rgb;
    for (int i = 0; i < 3 * kWide * kHigh; ++i) rgb.push_back(random.real32(0, 0.6));
    return std::make_shared<Environment>(shading::make_environment({kWide, kHigh, rgb}, {.extract_suns = false, .keep_image = true}));
}

Texture noise(Random& random) {
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 4 * 16 * 16; ++i) rgba.push_back(static_cast<std::uint8_t>(random.index(256)));
    return *Texture::from_rgba8(rgba, 16, 16, ColorSpace::srgb);
}

/// A scene that changes, and its prepared scene, which is told of the changes.
struct Stand {
    NamedScene given;
    Scene scene;
    Camera camera;
    std::optional<PreparedScene> prepared;

    explicit Stand(NamedScene s) : given(std::move(s)) { restart(); }
    /// Makes all anew, at the same places in memory.
    void restart() {
        prepared.reset();
        scene = given.scene;
        camera = given.camera;
        prepare();
    }
    void prepare() {
        auto made = PreparedScene::make(scene);
        REQUIRE(made);
        prepared.emplace(std::move(*made));
    }
};

void in_reverse(int count, const std::function<void(int)>& body) {
    for (int i = count - 1; i >= 0; --i) body(i);
}

void deform(Random& random, Mesh& mesh) {
    if (random.chance(0.5)) {
        for (Vec3f& p : mesh.positions) p = p + random_point(random, 0.05);
        return;
    }
    const int material = mesh.material;
    mesh = random.chance(0.5) ? make_sphere_of(0.5f, random.integer(12, 800)) : make_box({0.4f, 0.3f, 0.2f});
    if (random.chance(0.5)) generate_tangents(mesh, 0);
    mesh.material = random.chance(0.5) ? material : -1;
}

void change_material(Random& random, Scene& scene) {
    Material& m = scene.materials[static_cast<std::size_t>(random.index(static_cast<int>(scene.materials.size())))];
    const std::function<void()> changes[] = {
        [&] {
            m.base_color = {random.real32(0, 1), random.real32(0, 1), random.real32(0, 1), random.real32(0.2, 1)};
        },
        [&] { m.double_sided = !m.double_sided; },
        [&] { m.alpha_mode = static_cast<AlphaMode>(random.index(3)); },
        [&] { m.lobe = Lobe::sloan(random.real32(0, 1)); },
        [&] { m.unlit = !m.unlit; },
        [&] { m.textures[TextureSlot::base_color].texture = m.textures[TextureSlot::base_color].used() ? -1 : 0; },
        [&] { m.roughness = random.real32(0, 1); },
        [&] { m.alpha_cutoff = random.real32(0.2, 0.8); },
        [&] { scene.textures[static_cast<std::size_t>(random.index(static_cast<int>(scene.textures.size())))] = noise(random); },
    };
    changes[random.index(std::size(changes))]();
}

void change_lights(Random& random, Scene& scene) {
    static const std::shared_ptr<const Environment> kSkies[] = {nullptr, sky(1), sky(2)};
    Light light;
    light.type = static_cast<LightType>(random.index(3));
    light.position_ws = random_point(random, 3);
    light.range = random.chance(0.5) ? 0.0f : random.real32(1, 8);
    light.color_linear = {random.real32(0, 3), random.real32(0, 3), random.real32(0, 3)};
    const int which = random.index(5);
    if (which == 0) scene.ambient.sky_linear = light.color_linear * 0.1f;
    if (which == 1) scene.environment = kSkies[random.index(3)];
    if (which == 2 && scene.lights.size() < 5) scene.lights.push_back(light);
    if (which == 3 && !scene.lights.empty()) scene.lights.erase(scene.lights.begin());
    if (which == 4 && !scene.lights.empty()) scene.lights.back() = light;
}

void change_scene(Random& random, Stand& stage) {
    Scene& scene = stage.scene;
    SceneChanges told;
    switch (random.index(6)) {
        case 0:
        case 1: {
            const auto i = static_cast<std::size_t>(random.index(static_cast<int>(scene.instances.size())));
            scene.instances[i].world_from_object = scene.instances[i].world_from_object * random_place(random, 0.2);
            told.changed_instances = {i};
            break;
        }
        case 2: {
            const auto i = static_cast<std::size_t>(random.index(static_cast<int>(scene.meshes.size())));
            deform(random, scene.meshes[i]);
            told.deformed_meshes = {i};
            break;
        }
        case 3:
            change_material(random, scene);
            told.materials = true;
            break;
        default:
            change_lights(random, scene);
            told.lights = true;
            break;
    }
    REQUIRE(stage.prepared->update(told));
}

struct Frame {
    halflit::test::Setup settings;
    int width = 96, height = 64;
};

/// Changes one setting to one of two or three values, so that kept data fits again now and then.
void change_frame(Random& random, Frame& frame) {
    halflit::test::Setup& s = frame.settings;
    ShadingSettings& options = s.shading;
    const bool coin = random.chance(0.5);
    const int die = random.index(3);
    const std::function<void()> changes[] = {
        [&] { s.samples = coin       ? 1
                          : die == 0 ? 4
                                     : 8; },
        [&] { frame.width = coin ? 96 : 61; },
        [&] { s.shadows = static_cast<ShadowMode>(die); },
        [&] { s.shadow_size = coin ? 64 : 128; },
        [&] { s.shadow_memory_limit = std::size_t{1} << (coin ? 20 : 28); },
        [&] { s.shadow_fade = coin ? 0.0f : 0.3f; },
        [&] { s.shadow_terminator_offset = coin; },
        [&] {
            s.region = coin ? Region{} : Region{20, 11, 33, 40};
        },
        [&] { s.exposure = coin ? 1.0f : 0.4f; },
        [&] { s.background_environment = coin; },
        [&] { options.max_error_codes = coin ? 0.0 : 2.0; },
        [&] { options.lobe.reset(); },
        [&] { options.lobe = coin ? Lobe::valve() : Lobe::green(0.3f); },
        [&] { options.accuracy = coin || die != 0 ? Accuracy::exact : Accuracy::reference; },
        [&] { options.rate = coin       ? ShadingRate::pixel
                             : die == 0 ? ShadingRate::flat
                                        : ShadingRate::gouraud; },
        [&] { options.texture_detail = coin ? TextureDetail::full : TextureDetail::nearest; },
        [&] { options.specular = static_cast<SpecularModel>(die); },
        [&] { options.environment_bands = coin ? 0 : 3; },
        [&] { s.execution.isa = halflit::test::available_isas()[coin ? 0 : halflit::test::available_isas().size() - 1]; },
        [&] { s.execution.threads = coin ? 1 : 2; },
        [&] { s.execution.tile_size = 16 << die; },
        [&] { s.execution.parallel_for = coin ? ParallelFor{} : in_reverse; },
    };
    changes[random.index(std::size(changes))]();
}

/// Renders a frame that cannot be drawn: refused at once, when shadows are planned, for the camera, or stopped half way.
void fail_once(Random& random, Renderer& renderer, const Stand& stage, Frame frame) {
    Camera camera = stage.camera;
    halflit::test::Setup& s = frame.settings;
    int asked = 0;
    const std::function<bool()> stop = [&asked] { return ++asked > 2; };
    const std::function<void()> faults[] = {
        [&] { s.samples = 3; },
        [&] { s.shadow_size = 100; },
        [&] {
            s.region = {90, 60, 50, 50};
        },
        [&] { s.shading.lobe = Lobe::green(2); },
        [&] { camera.world_from_camera.c[3].x = std::numeric_limits<float>::quiet_NaN(); },
        [&] { s.execution.cancelled = stop, s.execution.parallel_for = in_reverse, s.execution.tile_size = 16, s.region = {}; },
    };
    faults[random.index(std::size(faults))]();
    Picture picture(frame.width, frame.height);
    CHECK_FALSE(renderer.render(*stage.prepared, camera, s, picture.target(), s.execution));
}

}  // namespace

TEST_CASE("renderer: after many random changes every frame equals that of a new Renderer", "[raster][retention]") {
    int drawn = 0, refused = 0;
    for (const std::uint64_t seed : {1, 2, 3}) {
        Random random(seed);
        Stand stages[] = {Stand(materials_scene()), Stand(layers_scene())};
        Renderer renderer;
        Frame frame;
        frame.settings.shadow_size = 64;
        int stage_index = 0;
        for (int step = 0; step < 150; ++step) {
            if (random.chance(0.15)) stage_index = 1 - stage_index;
            Stand& stage = stages[stage_index];
            if (random.chance(0.4)) change_scene(random, stage);
            if (random.chance(0.4)) change_frame(random, frame);
            if (random.chance(0.2)) {
                const Vec3f step_aside = random_point(random, random.chance(0.5) ? 0.0 : 0.3);
                stage.camera.world_from_camera = translation(step_aside) * stage.given.camera.world_from_camera;
            }
            if (random.chance(0.05)) stage.camera.orthographic = !stage.camera.orthographic;
            if (random.chance(0.08)) fail_once(random, renderer, stage, frame);
            if (random.chance(0.03)) renderer.forget_frames();
            if (random.chance(0.03)) renderer = Renderer(std::move(renderer));
            if (random.chance(0.03)) stage.prepare();
            if (random.chance(0.03)) stage.restart();
            Picture kept(frame.width, frame.height), fresh(frame.width, frame.height);
            kept.report = renderer.render(*stage.prepared, stage.camera, frame.settings, kept.target(), frame.settings.execution);
            fresh.report = render(stage.scene, stage.camera, frame.settings, fresh.target(), frame.settings.execution);
            INFO("seed " << seed << ", step " << step);
            check_same(kept, fresh);
            (fresh.report ? drawn : refused) += 1;
        }
    }
    CHECK(drawn > 250);
    CHECK(refused < 200);  // a budget with a setting that excludes budgets; the environment behind a scene that has none
}
