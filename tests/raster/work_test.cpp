// Counts of a frame's shading work. A square that fills the picture has as many fragments as the picture has pixels, so every count has a
// closed form.
#include "halflit/mesh.hpp"
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "shading/environment.hpp"
#include "shading/fragment_block.hpp"
#include "shading/material_properties.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/setup.hpp"

#include "tests/support/catch.hpp"

#include <vector>

using namespace halflit;
using namespace halflit::raster;
using halflit::test::camera_flat;

namespace {

constexpr int kSide = 64;
constexpr std::uint64_t kPixels = kSide * kSide;

/// The square from -1 to 1 that faces the camera, with the vertex data that its material asks for.
Mesh full_square(int material) {
    Mesh m;
    m.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    m.normals.assign(4, {0, 0, 1});
    m.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    m.indices = {0, 1, 2, 0, 2, 3};
    m.material = material;
    return m;
}

struct Square {
    Scene scene;
    halflit::test::Setup settings;

    explicit Square(Material material = {}) {
        scene.materials.push_back(std::move(material));
        scene.meshes.push_back(full_square(0));
        scene.instances.push_back({0, {}});
        settings.shadows = ShadowMode::off;
    }
    Light& add_light(LightType type) {
        Light light;
        light.type = type;
        light.direction_ws = {0, 0, -1};
        light.position_ws = {0, 0, 2};
        light.outer_cone_rad = 1.2f;
        scene.lights.push_back(light);
        return scene.lights.back();
    }
    /// Out of the picture. Without one, nothing casts a shadow, and there are no maps.
    void add_caster() {
        scene.meshes.push_back(make_sphere(0.1f, 8, 4));
        scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, translation({3, 0, 0})});
    }
    void add_texture() {
        scene.textures.push_back(Texture::from_rgba8(std::vector<std::uint8_t>(4 * 16, 200), 4, 4, ColorSpace::linear).value());
    }
    [[nodiscard]] RenderReport draw() const {
        std::vector<std::uint8_t> rgba8(4 * kPixels);
        const auto report = render(scene, camera_flat(), settings, {kSide, kSide, rgba8.data(), nullptr}, settings.execution);
        INFO((report ? std::string() : report.error().message));
        REQUIRE(report);
        return *report;
    }
    [[nodiscard]] WorkCounts work() const { return draw().work; }
};

std::uint64_t pairs(const WorkCounts& work, LightType type) { return work.light_lanes[static_cast<std::size_t>(type)]; }

/// Checks that the stages in `expected` ran on `lanes` lanes, and no other stage on any.
void check_stages(const WorkCounts& work, std::uint32_t expected, std::uint64_t lanes = kPixels) {
    for (std::size_t bit = 0; bit < work.stage_lanes.size(); ++bit) {
        INFO("stage bit " << bit);
        CHECK(work.stage_lanes[bit] == ((expected >> bit & 1u) != 0 ? lanes : 0u));
    }
}

}  // namespace

TEST_CASE("work: an unlit material runs no light, no shadow look-up and no stage but its own", "[raster][work]") {
    Material material;
    material.unlit = true;
    Square square(material);
    for (const LightType type : {LightType::directional, LightType::point, LightType::spot}) square.add_light(type);
    square.settings.shadows = ShadowMode::soft_split;
    const WorkCounts work = square.work();
    check_stages(work, kStageUnlit);
    CHECK(work.light_lanes == std::array<std::uint64_t, 3>{0, 0, 0});
    CHECK(work.shadow_lookup_lanes == 0);
    CHECK(work.alpha_test_lanes == 0);
}

TEST_CASE("work: each light is evaluated once a fragment, and only the kinds that there are", "[raster][work]") {
    Square square;
    square.settings.shading.specular = SpecularModel::none;
    square.add_light(LightType::directional);
    square.add_light(LightType::directional);
    WorkCounts work = square.work();
    check_stages(work, kStageLights);
    CHECK(work.light_lanes == std::array<std::uint64_t, 3>{2 * kPixels, 0, 0});
    square.add_light(LightType::point);  // no range: it reaches everything
    CHECK(square.work().light_lanes == std::array<std::uint64_t, 3>{2 * kPixels, kPixels, 0});
    square.add_light(LightType::spot);
    CHECK(square.work().light_lanes == std::array<std::uint64_t, 3>{2 * kPixels, kPixels, kPixels});
    square.scene.lights.clear();
    square.scene.ambient.sky_linear = {1, 1, 1};
    check_stages(square.work(), kStageAmbient);
}

TEST_CASE("work: shadow look-ups are those of the lights that have a map, none without shadows or casters", "[raster][work]") {
    Square square;
    for (const LightType type : {LightType::directional, LightType::point, LightType::spot}) square.add_light(type);
    CHECK(square.work().shadow_lookup_lanes == 0);
    square.settings.shadow_size = 64;
    square.settings.shadows = ShadowMode::hard;
    CHECK(square.work().shadow_lookup_lanes == 0);
    square.add_caster();
    CHECK(square.work().shadow_lookup_lanes == 3 * kPixels);
    square.settings.shadows = ShadowMode::soft_split;
    CHECK(square.work().shadow_lookup_lanes == 3 * kPixels);
}

TEST_CASE("work: each texture is a stage of its own, and runs only where the material has it", "[raster][work]") {
    const std::uint32_t always = kStageLights | kStageSpecular | kStageAmbient;
    for (const TextureSlot slot : shading::kAllTextureSlots) {
        const Stage stage = shading::info_of(slot).stage;
        if (stage >= kStageTransmission) continue;  // a layer's textures belong to its stage
        Material material;
        material.emissive = {1, 1, 1};
        material.textures[slot].texture = 0;
        material.textures[slot].sampler.mip = MipFilter::none;  // no gradients
        Square square(material);
        square.add_texture();
        square.add_light(LightType::directional);
        square.scene.ambient.sky_linear = {1, 1, 1};
        generate_tangents(square.scene.meshes[0], 0);
        check_stages(square.work(), always | stage);
        square.scene.materials[0].textures[slot].sampler.mip = MipFilter::linear;
        check_stages(square.work(), always | stage | kStageGradients);
        square.scene.meshes[0].colors.assign(4, {1, 1, 1, 1});
        check_stages(square.work(), always | stage | kStageGradients | kStageVertexColor);
    }
}

TEST_CASE("work: an environment is a stage of ambient light", "[raster][work]") {
    Square square;
    const std::vector<float> rgb(3 * 8 * 4, 0.5f);
    square.scene.environment = std::make_shared<Environment>(shading::make_environment({8, 4, rgb}, {}));
    square.settings.shading.specular = SpecularModel::none;
    check_stages(square.work(), kStageAmbient | kStageEnvironment);
}

TEST_CASE("work: Gouraud lights the vertices, flat shading the triangles, both leave fragments alone", "[raster][work]") {
    Square square;
    square.settings.shading.specular = SpecularModel::none;
    square.settings.shadow_size = 64;
    square.settings.shadows = ShadowMode::hard;
    square.add_caster();
    square.add_light(LightType::point);
    square.settings.shading.rate = ShadingRate::gouraud;
    WorkCounts work = square.work();
    CHECK(work.lanes(kStageLights) == 4);
    CHECK(pairs(work, LightType::point) == 4);
    CHECK(work.shadow_lookup_lanes == 4);
    CHECK(work.lanes(kStagePrelit) == kPixels);
    // A triangle is lit once for each run of its fragments in a block.
    square.settings.shading.rate = ShadingRate::flat;
    work = square.work();
    CHECK(work.lanes(kStageLights) >= 2);
    CHECK(work.lanes(kStageLights) <= 2 * kPixels / shading::kBlockSize * 2);
    CHECK(pairs(work, LightType::point) == work.lanes(kStageLights));
    CHECK(work.lanes(kStagePrelit) == kPixels);
}

TEST_CASE("work: a mask reads its texture twice, once to decide and once to shade what is left", "[raster][work]") {
    Material material;
    material.alpha_mode = AlphaMode::mask;
    material.unlit = true;
    Square square(material);
    square.scene.meshes[0].colors = {{1, 1, 1, 0}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 0}};  // 0.5 between the columns 31 and 32
    const WorkCounts work = square.work();
    CHECK(work.alpha_test_lanes == kPixels);
    CHECK(work.lanes(kStageVertexColor) == kPixels + kPixels / 2);
    CHECK(work.lanes(kStageUnlit) == kPixels / 2);
}

TEST_CASE("work: a light whose range ends before the picture does is left out of blocks that it does not reach", "[raster][work]") {
    Square square;
    Light& lamp = square.add_light(LightType::point);
    lamp.position_ws = {-0.75f, 0.75f, 0.1f};
    lamp.range = 0.2f;
    square.settings.execution.tile_size = 16;  // 16 tiles, each 0.5 wide: the light stands in the middle of the first
    const WorkCounts work = square.work();
    CHECK(work.lanes(kStageLights) == kPixels);
    CHECK(pairs(work, LightType::point) > 0);
    CHECK(pairs(work, LightType::point) <= kPixels / 16);
    square.scene.lights[0].position_ws.z = 5;  // out of reach altogether
    CHECK(pairs(square.work(), LightType::point) == 0);
}

TEST_CASE("work: counts do not depend on threads or instruction set, nor those of stages on tiles", "[raster][work]") {
    for (const auto& named : raster::test::all_scenes()) {
        const auto counts = [&](const halflit::test::Setup& settings) {
            constexpr int kWidth = 120, kHeight = 90;
            std::vector<std::uint8_t> rgba8(4 * kWidth * kHeight);
            const auto report = render(named.scene, named.camera, settings, {kWidth, kHeight, rgba8.data(), nullptr}, settings.execution);
            REQUIRE(report);
            return report->work;
        };
        halflit::test::Setup settings;
        settings.shadow_size = 64;
        const WorkCounts expected = counts(settings);
        INFO(named.name);
        for (const Isa isa : halflit::test::available_isas()) {
            settings.execution.isa = isa;
            settings.execution.threads = 1 + static_cast<int>(isa) % 3;
            CHECK(counts(settings) == expected);
        }
        settings.execution.tile_size = 16;
        const WorkCounts other = counts(settings);
        CHECK(other.stage_lanes == expected.stage_lanes);
        CHECK(other.alpha_test_lanes == expected.alpha_test_lanes);
    }
}

TEST_CASE("renderer: a lobe out of range is refused with the reason, a power below 1 gives a warning", "[raster][lobe]") {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const std::pair<Lobe, std::string> refused[] = {
        {{-0.1f, 1.0f, false}, "wrap: expected a number from 0 to 1, found -0.1"},
        {{1.5f, 1.0f, false},
         "wrap: expected a number from 0 to 1, found 1.5: above 1 every normal is lit, and the norm has another formula"},
        {{nan, 1.0f, false}, "wrap: expected a number from 0 to 1, found nan"},
        {{0.5f, -1.0f, false}, "power: expected a number from 0 to 10000, found -1: below 0 the lobe grows without bound at its boundary"},
        {{0.5f, nan, true}, "power: expected a number from 0 to 10000, found nan"},
        {{0.5f, infinity, true}, "power: expected a number from 0 to 10000, found inf"}};
    std::vector<std::uint8_t> rgba8(4 * kPixels);
    const Target target{kSide, kSide, rgba8.data(), nullptr};
    for (const auto& [lobe, message] : refused) {
        Square square;
        square.add_light(LightType::directional);
        square.scene.materials[0].lobe = lobe;
        const auto by_material = render(square.scene, camera_flat(), square.settings, target, square.settings.execution);
        REQUIRE(!by_material);
        CHECK(by_material.error().code == ErrorCode::bad_input);
        CHECK(by_material.error().message == "material 0: lobe: " + message);
        square.scene.materials[0].lobe = {};
        square.settings.shading.lobe = lobe;
        const auto by_setting = render(square.scene, camera_flat(), square.settings, target, square.settings.execution);
        REQUIRE(!by_setting);
        CHECK(by_setting.error().code == ErrorCode::usage);
        CHECK(by_setting.error().message == "lobe: " + message);
    }
    Square square;
    square.add_light(LightType::directional);
    CHECK(square.draw().warnings.empty());
    square.scene.materials[0].lobe.power = 0.5f;
    CHECK(square.draw().warnings == std::vector<std::string>{"power 0.5: below 1 the curve has an infinite slope at its boundary"});
    square.scene.materials[0].lobe.power = 0.0f;
    CHECK(square.draw().warnings == std::vector<std::string>{"power 0: below 1 the curve jumps at its boundary"});
    square.scene.materials[0].unlit = true;  // an unlit material does not use its lobe
    CHECK(square.draw().warnings.empty());
}
