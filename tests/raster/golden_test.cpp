// Hashes of small scenes made in code, in many variants, against one committed table for every instruction set, compiler and machine.
// HALFLIT_UPDATE_GOLDEN=1 rewrites the table; look at the pictures first.
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
    }

    if (std::getenv("HALFLIT_UPDATE_GOLDEN") != nullptr) {
        std::ofstream out(kTable);
        out << "# scene/variant, hash of the 8-bit picture, hash of the linear one; made by HALFLIT_UPDATE_GOLDEN=1 "
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
