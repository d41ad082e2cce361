#include "apps/io/gltf/build/materials.hpp"
#include "tests/io/png_maker.hpp"

#include <fmt/core.h>

#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;
using namespace halflit::test;

namespace {

/// A triangle with the given material members and pictures; textures and images are PNG files in data: URIs.
Bytes with_material(const std::string& material, const std::vector<Bytes>& pictures = {}, const std::string& textures = "",
                    const std::string& rest = "") {
    TriangleFile file = triangle_with_material();
    file.rest = ",\"materials\":[{" + material + "}]" + rest;
    std::string images;
    for (const Bytes& p : pictures)
        images += fmt::format(R"({}{{"uri":"data:image/png;base64,{}"}})", images.empty() ? "" : ",", base64(p));
    if (!pictures.empty())
        file.rest += ",\"images\":[" + images + "],\"textures\":[" + (textures.empty() ? R"({"source":0})" : textures) + "]";
    return file.file();
}

Material material_of(const Bytes& file) { return load_ok(file).scene.materials.at(0); }

Vec2f apply(const TextureUse& use, Vec2f uv) {
    return {use.row_u.x * uv.x + use.row_u.y * uv.y + use.row_u.z, use.row_v.x * uv.x + use.row_v.y * uv.y + use.row_v.z};
}

}  // namespace

TEST_CASE("materials: transmission and absorption are read", "[io]") {
    const Bytes one = plain_png(1, 1, 9, 9, 9),
                file = with_material(
                    R"("extensions":{"KHR_materials_transmission":{"transmissionFactor":0.75,"transmissionTexture":{"index":0}},)"
                    R"("KHR_materials_volume":{"thicknessFactor":0.5,"attenuationDistance":3,"attenuationColor":[0.1,0.2,0.3],)"
                    R"("thicknessTexture":{"index":0,"texCoord":1}}})",
                    {one});
    const Material inside = material_of(file);
    CHECK(inside.transmission == 0.75f);
    CHECK(inside.thickness == Approx(0.5f));
    CHECK(inside.attenuation_distance == 3.0f);
    CHECK(inside.attenuation_color == Vec3f{0.1f, 0.2f, 0.3f});
    CHECK(inside.textures[TextureSlot::transmission].texture == 0);
    CHECK(inside.textures[TextureSlot::thickness].texture == 0);
    CHECK(inside.textures[TextureSlot::thickness].uv_set == 1);
    CHECK(material_of(with_material("")).transmission == 0.0f);
}

constexpr const char* kUsesClearcoat = R"(,"extensionsUsed":["KHR_materials_clearcoat"])";

TEST_CASE("materials: clearcoat is read, and a normal texture of its own gets tangents", "[io]") {
    const Bytes one = plain_png(1, 1, 9, 9, 9),
                file = with_material(R"("extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":0.75,"clearcoatRoughnessFactor":0.25,)"
                                     R"("clearcoatTexture":{"index":0},"clearcoatRoughnessTexture":{"index":0,"texCoord":1},)"
                                     R"("clearcoatNormalTexture":{"index":0,"scale":0.5}}})",
                                     {one}, "", kUsesClearcoat);
    const LoadedScene loaded = load_ok(file);
    const Material coat = loaded.scene.materials.at(0);
    CHECK(coat.clearcoat == 0.75f);
    CHECK(coat.clearcoat_roughness == 0.25f);
    CHECK(coat.clearcoat_normal_scale == 0.5f);
    CHECK(coat.textures[TextureSlot::clearcoat].used());
    CHECK(coat.textures[TextureSlot::clearcoat_roughness].uv_set == 1);
    REQUIRE(coat.textures[TextureSlot::clearcoat_normal].used());
    CHECK(loaded.scene.textures.at(static_cast<std::size_t>(coat.textures[TextureSlot::clearcoat_normal].texture)).rule() ==
          MipRule::normal);
    CHECK(loaded.scene.meshes.at(0).tangents.size() == 3);
    INFO((loaded.warnings.empty() ? "" : loaded.warnings[0]));
    CHECK(loaded.warnings.empty());
    CHECK(material_of(with_material("")).clearcoat == 0.0f);
}

TEST_CASE("materials: hostile values of clearcoat are refused, or held in range with a warning", "[io]") {
    const auto coated = [](const std::string& members) {
        return with_material(R"("extensions":{"KHR_materials_clearcoat":{)" + members + "}}", {}, "", kUsesClearcoat);
    };
    for (const char* wrong : {R"("clearcoatFactor":"1")", R"("clearcoatFactor":null)", R"("clearcoatTexture":{"index":7})",
                              R"("clearcoatTexture":5)", R"("clearcoatNormalTexture":{"index":-1})"}) {
        INFO(wrong);
        CHECK(!load(coated(wrong)));
    }
    for (const char* odd :
         {R"("clearcoatFactor":-3)", R"("clearcoatFactor":1e30)", R"("clearcoatFactor":1,"clearcoatRoughnessFactor":9)"}) {
        const LoadedScene loaded = load_ok(coated(odd));
        const Material coat = loaded.scene.materials.at(0);
        INFO(odd);
        CHECK(!loaded.warnings.empty());
        CHECK((coat.clearcoat >= 0.0f && coat.clearcoat <= 1.0f && coat.clearcoat_roughness >= 0.0f && coat.clearcoat_roughness <= 1.0f));
    }
}

TEST_CASE("materials: sheen is read, and its hostile values are refused or held in range with a warning", "[io]") {
    const auto sheen = [](const std::string& members) {
        return with_material(R"("extensions":{"KHR_materials_sheen":{)" + members + "}}", {plain_png(1, 1, 9, 9, 9)}, "",
                             R"(,"extensionsUsed":["KHR_materials_sheen"])");
    };
    const LoadedScene loaded =
        load_ok(sheen(R"("sheenColorFactor":[0.25,0.5,1],"sheenRoughnessFactor":0.75,"sheenColorTexture":{"index":0},)"
                      R"("sheenRoughnessTexture":{"index":0,"texCoord":1})"));
    CHECK(loaded.warnings.empty());
    const Material s = loaded.scene.materials.at(0);
    CHECK(s.sheen_color == Vec3f{0.25f, 0.5f, 1});
    CHECK(s.sheen_roughness == 0.75f);
    REQUIRE((s.textures[TextureSlot::sheen_color].used() && s.textures[TextureSlot::sheen_roughness].used()));
    CHECK(s.textures[TextureSlot::sheen_color].texture != s.textures[TextureSlot::sheen_roughness].texture);  // sRGB, and linear
    CHECK(s.textures[TextureSlot::sheen_roughness].uv_set == 1);
    CHECK(!material_of(with_material("")).has_sheen());
    for (const char* wrong : {R"("sheenColorFactor":1)", R"("sheenColorFactor":[1,1])", R"("sheenRoughnessFactor":"1")",
                              R"("sheenColorTexture":{"index":7})"}) {
        INFO(wrong);
        CHECK(!load(sheen(wrong)));
    }
    for (const char* odd : {R"("sheenColorFactor":[-1,2,1e30])", R"("sheenColorFactor":[1,1,1],"sheenRoughnessFactor":-9)"}) {
        const LoadedScene held = load_ok(sheen(odd));
        const Material got = held.scene.materials.at(0);
        INFO(odd);
        CHECK(!held.warnings.empty());
        CHECK((got.sheen_color.x >= 0.0f && got.sheen_color.y <= 1.0f && got.sheen_color.z <= 1.0f && got.sheen_roughness >= 0.0f));
    }
}

TEST_CASE("materials: thickness is taken to world space by the scale of the first instance", "[io]") {
    io::detail::file::File file;
    file.materials.resize(2);
    for (auto& material : file.materials) material.numbers[shading::kFirstFloats[shading::number_row("thickness")]] = 0.5;
    Scene scene;
    scene.materials.resize(2);
    for (Material& material : scene.materials) material.thickness = 0.5f;
    scene.meshes.resize(3);
    scene.meshes[0].material = 1, scene.meshes[1].material = 1;
    Instance first{0, {}}, second{1, {}};
    first.world_from_object.c[0].x = -2, first.world_from_object.c[1].y = 4, first.world_from_object.c[2].z = 8;  // mirrored, mean 4
    scene.instances = {first, second, {2, {}}};
    std::vector<Mat4> places;
    for (const Instance& instance : scene.instances) places.push_back(instance.world_from_object);
    CHECK(io::detail::set_thickness(file, scene, places));
    CHECK(!io::detail::set_thickness(file, scene, places));
    CHECK(scene.materials[0].thickness == 0.5f);
    CHECK(scene.materials[1].thickness == Approx(2.0f));
}

TEST_CASE("materials: factors, alpha mode and sides are read", "[io]") {
    const Material plain = material_of(with_material(""));
    CHECK(plain.base_color == Vec4f{1, 1, 1, 1});
    CHECK(plain.metallic == 1.0f);
    CHECK(plain.roughness == 1.0f);
    CHECK(plain.alpha_mode == AlphaMode::opaque);
    CHECK(!plain.has_own_lobe);
    const Material m = material_of(with_material(
        R"("name":"m","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.5,"roughnessFactor":0.25},)"
        R"("emissiveFactor":[1,0.5,0],"alphaMode":"MASK","alphaCutoff":0.75,"doubleSided":true,)"
        R"("extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4},"KHR_materials_unlit":{}})"));
    CHECK(m.name == "m");
    CHECK(m.base_color == Vec4f{0.1f, 0.2f, 0.3f, 0.4f});
    CHECK(m.metallic == 0.5f);
    CHECK(m.roughness == 0.25f);
    CHECK(m.emissive == Vec3f{4, 2, 0});
    CHECK(m.alpha_mode == AlphaMode::mask);
    CHECK(m.alpha_cutoff == 0.75f);
    CHECK(m.double_sided);
    CHECK(m.unlit);
    CHECK(material_of(with_material(R"("alphaMode":"BLEND")")).alpha_mode == AlphaMode::blend);
}

TEST_CASE("materials: an index of refraction gives the reflectance of Fresnel's formulas straight on", "[io]") {
    const auto reflectance = [](const char* ior) {
        return material_of(with_material(fmt::format(R"("extensions":{{"KHR_materials_ior":{{"ior":{}}}}})", ior))).dielectric_reflectance;
    };
    CHECK(material_of(with_material("")).dielectric_reflectance == 0.04f);
    CHECK(reflectance("1.5") == 0.04f);
    CHECK(reflectance("1") == 0.0f);
    CHECK(reflectance("3") == 0.25f);
    CHECK(reflectance("0") == 1.0f);  // the extension's own meaning of 0
}

TEST_CASE("materials: one texture for each picture and colour space", "[io]") {
    const Bytes red = plain_png(2, 2, 255, 0, 0), grey = plain_png(4, 2, 128, 128, 128);
    const std::string textures = R"({"source":0},{"source":1},{"source":0,"sampler":0})";
    const LoadedScene loaded = load_ok(with_material(
        R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1},"metallicRoughnessTexture":{"index":2}},)"
        R"("emissiveTexture":{"index":2},"occlusionTexture":{"index":1,"strength":0.5},"normalTexture":{"index":1,"scale":2})",
        {red, grey}, textures, R"(,"samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728,"minFilter":9985}])"));
    const Material& m = loaded.scene.materials[0];
    CHECK(loaded.scene.textures.size() == 4);  // that of normals has levels of its own
    CHECK(m.textures[TextureSlot::base_color].texture == m.textures[TextureSlot::emissive].texture);
    CHECK(m.textures[TextureSlot::base_color].texture != m.textures[TextureSlot::metallic_roughness].texture);
    CHECK(m.textures[TextureSlot::occlusion].texture != m.textures[TextureSlot::normal].texture);
    CHECK(m.textures[TextureSlot::base_color].uv_set == 1);
    CHECK(m.occlusion_strength == 0.5f);
    CHECK(m.normal_scale == 2.0f);
    CHECK(m.textures[TextureSlot::base_color].sampler == Sampler{});
    CHECK(m.textures[TextureSlot::emissive].sampler ==
          Sampler{TextureWrap::clamp, TextureWrap::mirror, TextureFilter::nearest, TextureFilter::linear, MipFilter::nearest});
    const Texture& texture = loaded.scene.textures[static_cast<std::size_t>(m.textures[TextureSlot::occlusion].texture)];
    CHECK(texture.width() == 4);
    CHECK(texture.height() == 2);
    CHECK(texture.data()[0] == 128 * 257);               // linear: 8 bits widened to 16
    CHECK(loaded.scene.meshes[0].tangents.size() == 3);  // made for the normal map
}

TEST_CASE("materials: every minification filter of glTF is understood", "[io]") {
    const std::pair<int, std::pair<TextureFilter, MipFilter>> kinds[] = {
        {9728, {TextureFilter::nearest, MipFilter::none}},    {9729, {TextureFilter::linear, MipFilter::none}},
        {9984, {TextureFilter::nearest, MipFilter::nearest}}, {9985, {TextureFilter::linear, MipFilter::nearest}},
        {9986, {TextureFilter::nearest, MipFilter::linear}},  {9987, {TextureFilter::linear, MipFilter::linear}}};
    for (const auto& [code, wanted] : kinds) {
        const Bytes file = with_material(R"("emissiveTexture":{"index":0})", {plain_png(1, 1, 0, 0, 0)}, R"({"source":0,"sampler":0})",
                                         ",\"samplers\":[{\"minFilter\":" + std::to_string(code) + "}]");
        const Sampler sampler = material_of(file).textures[TextureSlot::emissive].sampler;
        CHECK(sampler.min == wanted.first);
        CHECK(sampler.mip == wanted.second);
        CHECK(sampler.mag == TextureFilter::linear);
    }
}

TEST_CASE("materials: a texture transform turns, scales and shifts as its test model says", "[io]") {
    const auto use = [](const std::string& members) {
        return material_of(with_material(R"("emissiveTexture":{"index":0,"extensions":{"KHR_texture_transform":{)" + members + "}}}",
                                         {plain_png(1, 1, 0, 0, 0)}))
            .textures[TextureSlot::emissive];
    };
    const TextureUse shifted = use(R"("offset":[0.5,-0.25],"scale":[2,3],"texCoord":1)");
    CHECK(apply(shifted, {1, 1}) == Vec2f{2.5f, 2.75f});
    CHECK(shifted.uv_set == 1);
    // Khronos' TextureTransformTest: on its quads u = x + 1/2, v = 1/2 - y. The arrow's tip is seen at (0.2778, -0.2778) untransformed
    // and has to be seen at (-0.0790, -0.5163) with a rotation of 22.5 degrees, at (0.0185, -0.0185) with a scale of 1.5.
    const Vec2f tip{0.7778174593f, 0.7778174593f};
    const Vec2f turned = apply(use(R"("rotation":0.39269908169872414)"), {0.5f - 0.07904822439f, 0.5f + 0.51626748576f});
    CHECK(turned.x == Approx(tip.x).margin(1e-6));
    CHECK(turned.y == Approx(tip.y).margin(1e-6));
    const Vec2f scaled = apply(use(R"("scale":[1.5,1.5])"), {0.51854497287f, 0.51854497287f});
    CHECK(scaled.x == Approx(tip.x).margin(1e-6));
    CHECK(scaled.y == Approx(tip.y).margin(1e-6));
    // Scale before rotation before offset: (u, v) = (1, 0) scaled by (2, 3) and turned by 90 degrees is (0, -2).
    const Vec2f all = apply(use(R"("offset":[10,20],"rotation":1.5707963267948966,"scale":[2,3])"), {1, 0});
    CHECK(all.x == Approx(10.0));
    CHECK(all.y == Approx(18.0));
}

TEST_CASE("materials: extras.halflit sets the lobe, and mistakes in it are errors", "[io]") {
    const auto with = [](const std::string& extras) { return with_material(R"("extras":{"other":1,"halflit":)" + extras + "}"); };
    const auto lobe = [&](const std::string& extras) {
        const Material m = material_of(with(extras));
        CHECK(m.has_own_lobe);
        return m.lobe;
    };
    CHECK(lobe(R"({"lobe":"lambert"})") == Lobe::lambert());
    CHECK(lobe(R"({"lobe":"half-lambert"})") == Lobe::half_lambert());
    CHECK(lobe(R"({"lobe":"valve","normalize":true})") == Lobe{1, 2, true});
    CHECK(lobe(R"({"lobe":"green","wrap":0.25})") == Lobe::green(0.25f));
    CHECK(lobe(R"({"lobe":"sloan","wrap":0.25})") == Lobe::sloan(0.25f));
    CHECK(lobe(R"({"lobe":"sloan","wrap":0.5,"power":1.5,"normalize":true})") == Lobe{0.5f, 1.5f, true});
    CHECK(lobe(R"({"lobe":"mcauley","wrap":0.75,"power":3})") == Lobe::mcauley(0.75f, 3.0f));
    for (const char* bad : {R"({"lobe":"phong"})", R"({"wrap":0.5})", R"({"lobe":"sloan","wrap":1.5})", R"({"lobe":"sloan","wrap":-0.1})",
                            R"({"lobe":"mcauley","power":-1})", R"({"lobe":"sloan","wrap":"0.5"})", R"({"lobe":3})",
                            R"({"lobe":"sloan","warp":0.5})", R"({"lobe":"sloan","normalize":1})", R"(3)", R"("sloan")"}) {
        INFO(bad);
        const auto loaded = load(with(bad));
        REQUIRE(!loaded);
        CHECK(loaded.error().code == ErrorCode::bad_input);
        CHECK(loaded.error().message.find("materials[0].extras.halflit") != std::string::npos);
    }
}

TEST_CASE("materials: a broken picture is left out with a warning, or refused by the strict rules", "[io]") {
    Bytes broken = plain_png(8, 8, 1, 2, 3);
    broken.resize(40);  // its header, and nothing of its pixels
    for (const Bytes& picture : {broken, to_bytes("not a picture"), Bytes{}}) {
        const Bytes file = with_material(R"("emissiveTexture":{"index":0},"emissiveFactor":[1,1,1],"normalTexture":{"index":0},
            "pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0}})",
                                         {picture});
        const auto refused = load(file);
        REQUIRE(!refused);
        CHECK(refused.error().code == ErrorCode::bad_input);
        CHECK(refused.error().message.find("images[0]") != std::string::npos);
        const LoadedScene loaded = load_ok(file);
        CHECK(loaded.warnings.at(0).find("drawn without the picture") != std::string::npos);
        const Material& material = loaded.scene.materials.at(0);
        for (std::size_t slot = 0; slot < kTextureSlots; ++slot) CHECK(material.textures[static_cast<TextureSlot>(slot)].texture < 0);
        CHECK(material.metallic == 0.0f);  // neither a mirror nor a light without its map
        CHECK(material.emissive == Vec3f{});
    }
    const Bytes unused = with_material("", {broken});
    CHECK(load_ok(unused).scene.textures.empty());  // unused images are not read
}

TEST_CASE("materials: textures have limits, each and together", "[io]") {
    const Bytes file = with_material(R"("emissiveTexture":{"index":0},"normalTexture":{"index":1})",
                                     {plain_png(64, 64, 0, 0, 0), plain_png(64, 64, 1, 1, 1)}, R"({"source":0},{"source":1})");
    LoadOptions options;
    CHECK(load(file, options));
    options.limits.max_texture_side = 63;
    CHECK(load(file, options).error().code == ErrorCode::limit);
    options = {};
    options.limits.max_texture_pixels = 64 * 64 - 1;
    CHECK(load(file, options).error().code == ErrorCode::limit);
    options = {};
    options.limits.max_texture_bytes = 2 * 64 * 64 * 32 / 3 - 10;
    options.strict = true;
    CHECK(load(file, options).error().code == ErrorCode::limit);
    options.strict = false;
    options.limits.max_texture_bytes = 20;  // less than two textures of one texel
    CHECK(load(file, options).error().code == ErrorCode::limit);
}

TEST_CASE("materials: textures that would exceed their memory are kept smaller, the largest first, as their levels are", "[io]") {
    const Bytes picture = make_png({100, 60, 8, 6, false, {}, {}}, [](std::uint32_t x, std::uint32_t y, int c) {
        return (7 * x + 13 * y * x + 50u * static_cast<unsigned>(c)) % 251;
    });
    for (const char* use : {R"("emissiveTexture":{"index":0},"normalTexture":{"index":1})",
                            R"("alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"normalTexture":{"index":1})"}) {
        const Bytes file = with_material(use, {picture, plain_png(16, 16, 9, 8, 7)}, R"({"source":0},{"source":1})");
        LoadOptions options;
        const LoadedScene whole = load_ok(file, options);
        options.limits.max_texture_bytes = 10'000;  // 100 x 60: 64,000 bytes; 25 x 15: 4,000; 16 x 16: 2,730
        const LoadedScene fitted = load_ok(file, options);
        REQUIRE(fitted.warnings.size() == whole.warnings.size() + 1);
        CHECK(fitted.warnings.back().find("the limit (max_texture_bytes) is 0.01 MB: 1 of 2 are kept at 1/4") != std::string::npos);
        REQUIRE(fitted.scene.textures.size() == 2);
        const std::size_t at = whole.scene.textures[0].width() == 100 ? 0 : 1;
        const Texture &large = whole.scene.textures[at], &small = fitted.scene.textures[at];
        CHECK(small.width() == 25);
        CHECK(small.height() == 15);
        CHECK(std::equal(small.data().begin(), small.data().end(), large.data().end() - static_cast<std::ptrdiff_t>(small.data().size())));
        CHECK(fitted.scene.textures[1 - at].width() == 16);
    }
}
