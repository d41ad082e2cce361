// Hashes of small scenes made in code, in many variants, against one committed table for every instruction set, compiler and machine.
// HALFLIT_UPDATE_GOLDEN=1 rewrites the table; look at the pictures first.
#include "halflit/fixed_function.hpp"
#include "halflit/renderer.hpp"
#include "halflit/target.hpp"
#include "shading/environment.hpp"
#include "tests/raster/test_scenes.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

namespace halflit::raster {
namespace {

constexpr int kWidth = 160, kHeight = 90;
const char* const kTable = HALFLIT_SOURCE_DIR "/tests/golden/hashes.txt";

struct Variant {
    const char* name;
    Settings settings;
    bool environment = false;
    bool studio = false;  ///< instead of the scene's lights
    bool ground = false;
};

std::vector<Variant> variants() {
    std::vector<Variant> all;
    const auto add = [&](const char* name) -> Settings& {
        all.push_back({name, {}});
        all.back().settings.background_linear = {0.05f, 0.06f, 0.08f, 1.0f};
        return all.back().settings;
    };
    add("plain");
    add("four-samples").samples = 4;
    add("eight-samples-transparent").samples = 8;
    all.back().settings.background_linear = {0, 0, 0, 0};
    add("sixteen-samples").samples = 16;
    add("gouraud").shading.rate = ShadingRate::gouraud;
    add("flat").shading.rate = ShadingRate::flat;
    add("unshadowed").shadows = ShadowMode::off;
    add("shadow-terminator").shadow_terminator_offset = true;
    add("hard-shadows-wrapped").shadows = ShadowMode::hard;
    all.back().settings.shading.lobe = Lobe::sloan(0.3f);
    add("matte").shading.specular = SpecularModel::none;
    add("within-two-codes").shading.max_error_codes = 2.0;
    all.back().settings.shading.lobe = Lobe::sloan(0.3f);
    add("reinhard-four-samples").samples = 4;
    all.back().settings.tone_curve = ToneCurve::reinhard;
    add("aces-transparent").tone_curve = ToneCurve::aces;
    all.back().settings.background_linear = {0, 0, 0, 0};
    add("neutral-four-samples").samples = 4;
    all.back().settings.tone_curve = ToneCurve::neutral;
    add("environment");
    all.back().environment = true;
    add("studio").samples = 4;
    all.back().settings.tone_curve = ToneCurve::neutral;
    all.back().studio = true;
    add("sky-shadows").sky_shadows = 32;
    all.back().environment = true;
    add("ground").sky_shadows = 16;
    all.back().settings.background_linear = {0, 0, 0, 0};
    all.back().studio = true;
    all.back().ground = true;
    return all;
}

/// A sky brighter above, with a small hot spot: soft bands and a sun.
std::shared_ptr<const Environment> small_sky() {
    constexpr int kSkyWidth = 64, kSkyHeight = 32;
    std::vector<float> rgb;
    for (int y = 0; y < kSkyHeight; ++y)
        for (int x = 0; x < kSkyWidth; ++x) {
            const float up = 1.0f - static_cast<float>(y) / kSkyHeight;
            const float hot = x == 40 && y == 8 ? 200.0f : 0.0f;
            rgb.insert(rgb.end(), {0.2f + 0.3f * up + hot, 0.2f + 0.4f * up + hot, 0.25f + 0.6f * up + hot * 0.8f});
        }
    return std::make_shared<Environment>(shading::make_environment({kSkyWidth, kSkyHeight, rgb}));
}

std::string hex(std::uint64_t value) {
    std::ostringstream text;
    text << std::hex << value;
    return text.str();
}

/// The floats' bytes, the lowest first, on every machine.
std::vector<std::uint8_t> little_endian(const std::vector<float>& values) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(values.size() * sizeof(float));
    for (const float value : values)
        for (int byte = 0; byte < 4; ++byte) bytes.push_back(static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(value) >> (8 * byte)));
    return bytes;
}

/// "rgba8 linear": the 8-bit picture, and the linear one as bytes.
std::string hashes(const test::NamedScene& named, const Variant& variant) {
    Scene scene = named.scene;
    if (variant.environment) scene.environment = small_sky();
    if (variant.studio) {
        scene.lights.clear();
        add_studio(scene, named.camera);
    }
    if (variant.ground) add_ground(scene, scene_bounds(scene));
    std::vector<std::uint8_t> rgba8(std::size_t{4} * kWidth * kHeight);
    std::vector<float> linear(rgba8.size());
    Settings settings = variant.settings;
    settings.shadow_size = 256;
    const auto report = render(scene, named.camera, settings, {kWidth, kHeight, rgba8.data(), linear.data()});
    if (!report) return report.error().message;
    return hex(pixel_hash(rgba8)) + " " + hex(pixel_hash(little_endian(linear)));
}

/// The same of a scene as fixed function draws it: codes, and reversed depths. effects: transparency, a mirror, fog, four samples.
std::string fixed_hashes(const test::NamedScene& named, bool effects) {
    FixedFrame frame;
    const Vec4f &back = named.camera.world_from_camera.c[2], &up = named.camera.world_from_camera.c[1],
                &eye = named.camera.world_from_camera.c[3];
    frame.camera = {
        {eye.x, eye.y, eye.z}, {-back.x, -back.y, -back.z}, {up.x, up.y, up.z}, false, -0.8f, 0.8f, -0.45f, 0.45f, 1.0f, 100.0f};
    frame.eye_ws = frame.camera.position_ws;
    CodeTexture picture{7, 4, false, false, {}}, cube{4, 4, true, false, {}};
    for (int i = 0; i < 3 * 28; ++i) picture.rgb.push_back(static_cast<std::uint8_t>(37 * i * i + 11));
    for (int i = 0; i < 3 * 96; ++i) cube.rgb.push_back(static_cast<std::uint8_t>(53 * i * i + 5));
    std::vector<Mesh> meshes;
    for (const Mesh& mesh : named.scene.meshes)
        if (mesh.splats == nullptr) meshes.push_back(mesh);
    for (const Instance& instance : named.scene.instances) {
        if (named.scene.meshes[static_cast<std::size_t>(instance.mesh)].splats != nullptr) return "none none";
        FixedItem item;
        const auto number = frame.items.size();
        item.mesh = instance.mesh;
        item.world_from_object = instance.world_from_object;
        item.id = static_cast<std::uint32_t>(number + 1);
        item.material.color = {0.9f, 0.5f + 0.1f * static_cast<float>(number % 4), 0.6f, 1.0f};
        item.material.specular = 0.5f, item.material.shininess = 20.0f;
        item.material.texture = static_cast<int>(number % 3) - 1;
        item.material.generated = true;
        for (std::size_t k = 0; k < 3; ++k)
            item.material.planes[k] = {k == 0 ? 1.0f : 0.2f, k == 1 ? 1.0f : 0.1f, k == 2 ? 1.0f : -0.1f, 0.3f};
        if (effects && number % 4 == 3) item.stage = FixedStage::transparent, item.material.color.w = 0.4f;
        item.mirrors = effects && number == 0;
        frame.items.push_back(item);
    }
    std::stable_partition(frame.items.begin(), frame.items.end(), [](const FixedItem& item) { return item.stage == FixedStage::solid; });
    for (int i = 0; i < 2; ++i) {
        FixedLight light;
        light.position_ws = {i == 0 ? 3.0f : -4.0f, 6, 5};
        light.direction_ws = light.position_ws * -1.0f;
        light.directional = i == 1;
        light.ambient = {0.1f, 0.1f, 0.1f}, light.diffuse = {0.5f, 0.4f, 0.3f}, light.specular = {0.3f, 0.3f, 0.4f};
        light.cutoff_deg = 45, light.exponent = 4, light.attenuation[1] = 0.05f;
        light.shadow_size = 300, light.shadow_half_width = 4;
        frame.lights.push_back(light);
    }
    frame.has_mirror = effects;
    frame.mirror = {{0, -0.5f, 0}, {0, 1, 0}, 0.5f};
    if (effects) frame.fog_start = 3, frame.fog_end = 12, frame.fog_color = {0.5f, 0.6f, 0.7f};
    std::vector<std::uint8_t> rgb(std::size_t{3} * kWidth * kHeight);
    std::vector<float> depth(std::size_t{kWidth} * kHeight);
    FixedTarget target{kWidth, kHeight, effects ? 4 : 1};
    target.rgb = rgb.data(), target.depth = depth.data();
    auto renderer = FixedFunctionRenderer::make(meshes, {picture, cube});
    if (!renderer) return renderer.error().message;
    if (auto ok = renderer->render(frame, target); !ok) return ok.error().message;
    return hex(pixel_hash(rgb)) + " " + hex(pixel_hash(little_endian(depth)));
}

}  // namespace

TEST_CASE("golden: every scene in every variant has the committed pixels", "[raster][golden]") {
    if (const char* set = std::getenv("HALFLIT_KERNEL"))
        for (const Isa isa : built_isas())
            if (isa_name(isa) == set && !isa_available(isa)) HALFLIT_SKIP("this processor does not run " + std::string(set));
    std::map<std::string, std::string> found;
    for (const test::NamedScene& scene : test::all_scenes()) {
        std::string name = scene.name;
        std::replace(name.begin(), name.end(), ' ', '-');
        for (const Variant& variant : variants()) found[name + "/" + variant.name] = hashes(scene, variant);
        found[name + "/fixed-function"] = fixed_hashes(scene, false);
        found[name + "/fixed-function-effects"] = fixed_hashes(scene, true);
    }

    if (std::getenv("HALFLIT_UPDATE_GOLDEN") != nullptr) {
        std::ofstream out(kTable);
        out << "# scene/variant, hash of the 8-bit picture, hash of the linear one (fixed function: of depths); made by "
               "HALFLIT_UPDATE_GOLDEN=1 "
               "(tests/raster/golden_test.cpp)\n";
        for (const auto& [name, hash] : found) out << name << " " << hash << "\n";
        out.close();
        CHECK(out.good());
        WARN("the table of golden hashes was written anew");
        return;
    }
    std::map<std::string, std::string> expected;
    std::ifstream in(kTable);
    for (std::string line; std::getline(in, line);)
        if (!line.empty() && line[0] != '#') expected[line.substr(0, line.find(' '))] = line.substr(line.find(' ') + 1);
    REQUIRE(found.size() >= 50);
    CHECK(expected.size() == found.size());
    for (const auto& [name, hash] : found) {
        INFO(name);
        CHECK(expected[name] == hash);
    }
}

}  // namespace halflit::raster
