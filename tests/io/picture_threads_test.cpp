// Pictures of a model that are decoded on several threads, while its meshes are read.
#include "tests/io/gltf_builder.hpp"
#include "tests/io/png_maker.hpp"

#include <algorithm>

using namespace halflit;
using namespace halflit::test;

namespace {

/// A triangle with four textures that are large enough for threads of their own. The views of the pictures follow those of the triangle.
struct TexturedFile : TriangleFile {
    static constexpr std::uint32_t kWidth = 400, kHeight = 340;
    std::size_t picture_at[4] = {};  ///< first byte in `bin`

    TexturedFile() {
        Bytes uv;
        append<float>(uv, {0, 0, 1, 0, 0, 1});
        attributes += ",\"TEXCOORD_0\":" + std::to_string(add(uv, R"("componentType":5126,"count":3,"type":"VEC2")"));
        std::string images, textures;
        for (int i = 0; i < 4; ++i) {
            const Bytes png = make_png(
                {kWidth, kHeight, 8, i == 3 ? 0 : 2, false, {}, {}, {i}, {}},
                [&](std::uint32_t x, std::uint32_t y, int c) { return (x * 7 + y * 3 + static_cast<std::uint32_t>(c + i)) & 255; });
            while (bin.size() % 4 != 0) bin.push_back(std::byte{0});
            picture_at[i] = bin.size();
            views += ",{\"buffer\":0,\"byteOffset\":" + std::to_string(bin.size()) + ",\"byteLength\":" + std::to_string(png.size()) + "}";
            bin.insert(bin.end(), png.begin(), png.end());
            images += (i == 0 ? "" : ",") + (R"({"mimeType":"image/png","bufferView":)" + std::to_string(count + 1 + i) + "}");
            textures += (i == 0 ? "{\"source\":" : ",{\"source\":") + std::to_string(i) + "}";
        }
        primitive = ",\"material\":0";
        rest = ",\"images\":[" + images + "],\"textures\":[" + textures +
               R"(],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":1}},)"
               R"("emissiveTexture":{"index":2},"emissiveFactor":[1,1,1],"occlusionTexture":{"index":3}}])";
    }
    /// Changes a byte in the middle of a picture's pixels.
    void damage(int picture) { bin[picture_at[picture] + 60'000] ^= std::byte{0x55}; }
};

LoadOptions with_threads(int threads, bool tolerant = false) {
    LoadOptions options;
    options.threads = threads;
    options.strict = !tolerant;
    return options;
}

}  // namespace

TEST_CASE("picture threads: the textures are the same from one thread and from several", "[io][gltf]") {
    const Bytes file = TexturedFile().file();
    const LoadedScene one = load_ok(file, with_threads(1));
    REQUIRE(one.scene.textures.size() == 4);
    for (int threads : {2, 4, 9}) {
        const LoadedScene several = load_ok(file, with_threads(threads));
        REQUIRE(several.scene.textures.size() == 4);
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK(several.scene.textures[i].width() == 400);
            CHECK(std::ranges::equal(one.scene.textures[i].data(), several.scene.textures[i].data()));
        }
    }
}

TEST_CASE("picture threads: damaged pictures give the same message and the same warnings", "[io][gltf]") {
    TexturedFile damaged;
    damaged.damage(1);
    damaged.damage(3);
    const Bytes file = damaged.file();
    const auto strict = load(file, with_threads(1));
    REQUIRE(!strict);
    CHECK(strict.error().code == ErrorCode::bad_input);
    CHECK(strict.error().message.find("images[1]") != std::string::npos);
    const LoadedScene tolerant = load_ok(file, with_threads(1, true));
    CHECK(tolerant.warnings.size() == 2);
    for (int round = 0; round < 5; ++round) {
        const auto again = load(file, with_threads(4));
        REQUIRE(!again);
        CHECK(again.error().message == strict.error().message);
        CHECK(load_ok(file, with_threads(4, true)).warnings == tolerant.warnings);
    }
}

TEST_CASE("picture threads: a fault of the mesh beside a damaged picture gives the same message", "[io][gltf]") {
    TexturedFile damaged;
    damaged.damage(2);
    damaged.primitive += ",\"mode\":9";
    const Bytes file = damaged.file();
    const auto one = load(file, with_threads(1));
    REQUIRE(!one);
    for (int round = 0; round < 5; ++round) {
        const auto several = load(file, with_threads(4));
        REQUIRE(!several);
        CHECK(several.error().message == one.error().message);
    }
}

TEST_CASE("picture threads: a negative number is refused", "[io][gltf]") {
    const auto loaded = load(TexturedFile().file(), with_threads(-1));
    REQUIRE(!loaded);
    CHECK(loaded.error().code == ErrorCode::usage);
}
