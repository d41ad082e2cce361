// Pictures of MTL files: formats that glTF does not have, and several pictures that become one texture.
#include "halflit/image.hpp"
#include "halflit/target.hpp"
#include "tests/io/model_maker.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/system.hpp"

#include <array>
#include <cstdlib>
#include <fstream>

using namespace halflit;
using namespace halflit::test;

namespace {

using Texel = std::array<std::uint8_t, 4>;

void write_picture(const std::string& path, int width, const std::vector<Texel>& texels) {
    Image image{width, static_cast<int>(texels.size()) / width, {}, {}};
    for (const Texel& texel : texels) image.rgba8.insert(image.rgba8.end(), texel.begin(), texel.end());
    REQUIRE(write_image(path, image));
}

std::array<std::uint16_t, 4> texel_at(const Scene& scene, const TextureUse& use, int x) {
    REQUIRE(use.used());
    const std::uint16_t* const texel = scene.textures.at(static_cast<std::size_t>(use.texture)).data().data() + 4 * x;
    return {texel[0], texel[1], texel[2], texel[3]};
}

}  // namespace

TEST_CASE("MTL: masks, roughness and metalness in pictures of their own are drawn, and BMP and TGA are read", "[io]") {
    const TemporaryFolder files;
    const std::string folder = files.path();
    write_picture(folder + "/color.tga", 2, {{255, 0, 0, 255}, {0, 255, 0, 255}});
    write_picture(folder + "/mask.bmp", 1, {{51, 51, 51, 255}});
    write_picture(folder + "/mask.png", 2, {{255, 255, 255, 102}, {255, 255, 255, 204}});
    write_picture(folder + "/rough.png", 2, {{51, 51, 51, 255}, {102, 102, 102, 255}});
    write_picture(folder + "/metal.png", 2, {{0, 0, 0, 255}, {255, 255, 255, 255}});
    std::ofstream(folder + "/m.mtl") << "newmtl grey\nKd 0 0 0\nmap_Kd -s 2 2 color.tga\nmap_d -s 2 2 mask.bmp\n"
                                        "newmtl clear\nKd 0.5 0.5 0.5\nmap_d mask.png\n"
                                        "newmtl metal\nmap_Pr rough.png\nmap_Pm metal.png\n"
                                        "newmtl rough\nPr 0.5\nmap_Pr -s 2 2 rough.png\nmap_Pm metal.png\n"
                                        "newmtl tinted\nKs 0.5 0.5 0.5\nmap_Ks color.tga\n"
                                        "newmtl lost\nmap_Kd color.tga\nmap_d lost.png\n";
    const std::string points = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
    const auto load_with = [&](std::initializer_list<const char*> names, const LoadOptions& options = {}) {
        std::string text = points;
        for (const char* name : names) text += std::string("usemtl ") + name + "\nf 1/1 2/1 3/1\n";
        return load_any(to_bytes(text), options, folder);
    };
    const auto loaded = load_with({"grey", "clear", "metal", "rough", "tinted"});
    const auto refused = load_with({"lost"}, strictly());
    const auto lost = load_with({"lost"});
    REQUIRE(loaded);
    const Scene& scene = loaded->scene;
    REQUIRE(scene.materials.size() == 5);
    constexpr std::uint16_t kCode = 257;  // 8 bits as 16
    const Material& grey = scene.materials[0];
    CHECK(grey.alpha_mode == AlphaMode::blend);
    CHECK(texel_at(scene, grey.textures[TextureSlot::base_color], 0)[3] == 51 * kCode);
    CHECK(texel_at(scene, grey.textures[TextureSlot::base_color], 1)[3] == 51 * kCode);
    CHECK(grey.textures[TextureSlot::base_color].row_u == Vec3f{2, 0, 0});
    const Material& clear = scene.materials[1];
    CHECK(clear.alpha_mode == AlphaMode::blend);
    CHECK(clear.base_color.x == 0.5f);
    CHECK(texel_at(scene, clear.textures[TextureSlot::base_color], 0) == std::array<std::uint16_t, 4>{65535, 65535, 65535, 102 * kCode});
    CHECK(texel_at(scene, clear.textures[TextureSlot::base_color], 1)[3] == 204 * kCode);
    const Material& metal = scene.materials[2];
    CHECK(metal.roughness == 1.0f);
    CHECK(metal.metallic == 1.0f);
    CHECK(texel_at(scene, metal.textures[TextureSlot::metallic_roughness], 0)[1] == 51 * kCode);
    CHECK(texel_at(scene, metal.textures[TextureSlot::metallic_roughness], 0)[2] == 0);
    CHECK(texel_at(scene, metal.textures[TextureSlot::metallic_roughness], 1)[1] == 102 * kCode);
    CHECK(texel_at(scene, metal.textures[TextureSlot::metallic_roughness], 1)[2] == 65535);
    CHECK(scene.materials[3].roughness == 0.5f);
    CHECK(scene.materials[3].textures[TextureSlot::metallic_roughness].texture == metal.textures[TextureSlot::metallic_roughness].texture);
    CHECK(scene.materials[4].textures[TextureSlot::specular_color].used());
    REQUIRE(loaded->warnings.size() == 1);
    CHECK(loaded->warnings[0] == "material \"rough\": map_Pr and map_Pm lie differently; drawn as the first");
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message.find("material \"lost\": map_d lost.png") != std::string::npos);
    REQUIRE(lost);
    CHECK(lost->warnings.at(0).find("material \"lost\": map_d lost.png") != std::string::npos);
    CHECK(lost->scene.materials.at(0).alpha_mode == AlphaMode::opaque);
}
