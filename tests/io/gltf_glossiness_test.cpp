// KHR_materials_pbrSpecularGlossiness, converted to metal and roughness.
#include "apps/io/gltf/build/glossiness.hpp"
#include "tests/io/gltf_builder.hpp"
#include "tests/io/png_maker.hpp"
#include "tests/support/random.hpp"

#include <fmt/core.h>

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::io::detail;
using namespace halflit::test;

namespace {

/// A triangle whose material has the extension with these members.
Bytes glossy(const std::string& members, const std::vector<Bytes>& pictures = {}) {
    TriangleFile file = triangle_with_material();
    file.rest = R"(,"materials":[{"extensions":{"KHR_materials_pbrSpecularGlossiness":{)" + members + "}}}]";
    std::string images, textures;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        images += fmt::format(R"({}{{"uri":"data:image/png;base64,{}"}})", i == 0 ? "" : ",", base64(pictures[i]));
        textures += fmt::format(R"({}{{"source":{}}})", i == 0 ? "" : ",", i);
    }
    if (!pictures.empty()) file.rest += ",\"images\":[" + images + "],\"textures\":[" + textures + "]";
    return file.file();
}

double srgb_to_linear(double code) {
    const double x = code / 255;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

/// A texel of level 0, linear.
std::vector<double> texel(const Texture& texture, int x, int y) {
    std::vector<double> out;
    for (int c = 0; c < 4; ++c) out.push_back(texture.data()[static_cast<std::size_t>(4 * (y * texture.width() + x) + c)] / 65535.0);
    return out;
}

}  // namespace

TEST_CASE("glossiness: a metal and a dielectric, given by their colours, come back", "[io]") {
    // Forward: diffuse = base (1 - metallic) 0.96 / (1 - max specular), specular = 0.04 (1 - metallic) + base metallic.
    Random random(12);
    for (int round = 0; round < 500; ++round) {
        const bool metal = round % 2 == 0;
        GlossySurface s;
        double base[3];
        for (double& c : base) c = random.real(0.2, 0.95);
        for (int c = 0; c < 3; ++c) s.specular[c] = metal ? base[c] : 0.04, s.diffuse[c] = metal ? 0 : base[c];
        s.glossiness = random.real(0, 1);
        const MetalSurface got = to_metal(s);
        CHECK(got.metallic == Approx(metal ? 1.0 : 0.0).margin(1e-9));
        CHECK(got.roughness == Approx(1 - s.glossiness));
        for (int c = 0; c < 3; ++c) CHECK(got.base_color[c] == Approx(base[c]).epsilon(1e-9));
    }
}

TEST_CASE("glossiness: the metallic value keeps F0 and the diffuse light of grey surfaces", "[io]") {
    // Of a grey surface both are numbers, and the equation has one root: F0 = 0.04 (1 - m) + base m, diffuse = base (1 - m) 0.96.
    for (const double diffuse : {0.05, 0.3, 0.8})
        for (const double specular : {0.04, 0.1, 0.3, 0.6}) {
            GlossySurface s;
            for (int c = 0; c < 3; ++c) s.diffuse[c] = diffuse, s.specular[c] = specular;
            const double matt = diffuse * (1 - specular);
            double low = 0, high = 1;  // bisection, the base colour taken from the diffuse light
            for (int i = 0; i < 200; ++i) {
                const double m = 0.5 * (low + high), base = matt / (0.96 * (1 - m));
                (0.04 * (1 - m) + base * m < specular ? low : high) = m;
            }
            INFO("diffuse " << diffuse << ", specular " << specular);
            CHECK(to_metal(s).metallic == Approx(low).margin(1e-9));
        }
}

TEST_CASE("glossiness: the conversion stays finite and in range for any colours", "[io]") {
    Random random(13);
    for (int round = 0; round < 20000; ++round) {
        GlossySurface s;
        const auto value = [&] {
            const int kind = random.index(4);
            return kind == 0 ? 0.0 : kind == 1 ? 1.0 : kind == 2 ? 0.04 : random.real(0, 1);
        };
        for (int c = 0; c < 3; ++c) s.diffuse[c] = value(), s.specular[c] = value();
        s.glossiness = value();
        const MetalSurface m = to_metal(s);
        REQUIRE(m.metallic >= 0.0);
        REQUIRE(m.metallic <= 1.0);
        for (const double c : m.base_color) REQUIRE((c >= 0.0 && c <= 1.0));
    }
}

TEST_CASE("glossiness: factors without textures give factors", "[io]") {
    const LoadedScene loaded =
        load_ok(glossy(R"("diffuseFactor":[0.5,0.25,0.1,0.75],"specularFactor":[0.04,0.04,0.04],"glossinessFactor":0.7)"));
    const Material& m = loaded.scene.materials.at(0);
    CHECK(m.metallic == Approx(0.0).margin(1e-6));
    CHECK(m.roughness == Approx(0.3));
    CHECK(m.base_color.x == Approx(0.5));
    CHECK(m.base_color.y == Approx(0.25));
    CHECK(m.base_color.w == 0.75f);
    CHECK(loaded.scene.textures.empty());
}

TEST_CASE("glossiness: textures of two sizes are converted texel by texel, and the originals are dropped", "[io]") {
    const auto random_png = [](std::uint32_t side, std::uint32_t seed) {
        return make_png({side, side, 8, 6, false, {}, {}}, [=](std::uint32_t x, std::uint32_t y, int c) {
            return (x * 97 + y * 57 + static_cast<std::uint32_t>(c) * 31 + seed) % 256;
        });
    };
    const auto code = [](int x, int y, int c, int seed) { return (x * 97 + y * 57 + c * 31 + seed) % 256; };
    const LoadedScene loaded = load_ok(
        glossy(R"("diffuseTexture":{"index":0},"specularGlossinessTexture":{"index":1},"diffuseFactor":[1,0.5,1,1],"glossinessFactor":0.5)",
               {random_png(4, 7), random_png(2, 90)}));
    REQUIRE(loaded.scene.textures.size() == 2);
    const Material& m = loaded.scene.materials.at(0);
    const Texture& base = loaded.scene.textures[static_cast<std::size_t>(m.textures[TextureSlot::base_color].texture)];
    const Texture& rough = loaded.scene.textures[static_cast<std::size_t>(m.textures[TextureSlot::metallic_roughness].texture)];
    REQUIRE(base.width() == 4);
    REQUIRE(rough.width() == 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            GlossySurface s;
            for (int c = 0; c < 3; ++c) {
                s.diffuse[c] = srgb_to_linear(code(x, y, c, 7)) * (c == 1 ? 0.5 : 1.0);
                s.specular[c] = srgb_to_linear(code(x / 2, y / 2, c, 90));
            }
            s.glossiness = 0.5 * code(x / 2, y / 2, 3, 90) / 255.0;
            const MetalSurface want = to_metal(s);
            const auto color = texel(base, x, y), parameters = texel(rough, x, y);
            INFO("texel " << x << ", " << y);
            for (std::size_t c = 0; c < 3; ++c) CHECK(color[c] == Approx(want.base_color[c]).margin(2e-3));
            CHECK(color[3] == Approx(code(x, y, 3, 7) / 255.0).margin(2e-5));
            CHECK(parameters[1] == Approx(want.roughness).margin(2e-5));
            CHECK(parameters[2] == Approx(want.metallic).margin(2e-3));
        }
}

TEST_CASE("glossiness: textures that lie differently are each converted with the mean of the other, with a warning", "[io]") {
    const LoadedScene loaded = load_ok(glossy(R"("diffuseTexture":{"index":0},"specularGlossinessTexture":{"index":1,"texCoord":1})",
                                              {plain_png(1, 1, 200, 100, 50), plain_png(1, 1, 60, 60, 60)}));
    CHECK(loaded.scene.materials.at(0).textures[TextureSlot::metallic_roughness].uv_set == 1);
    CHECK(std::any_of(loaded.warnings.begin(), loaded.warnings.end(),
                      [](const std::string& text) { return text.find("lie differently") != std::string::npos; }));
}

TEST_CASE("specular: factor, colour and textures of KHR_materials_specular are read", "[io]") {
    TriangleFile file;
    file.primitive = ",\"material\":0";
    file.rest = R"(,"materials":[{"extensions":{"KHR_materials_specular":{"specularFactor":0.25,"specularColorFactor":[0,1,7]}}}])";
    const Material m = load_ok(file.file()).scene.materials.at(0);
    CHECK(m.specular == 0.25f);
    CHECK(m.specular_color == Vec3f{0, 1, 7});
    CHECK(m.has_specular_color());
    CHECK(!Material{}.has_specular_color());
}
