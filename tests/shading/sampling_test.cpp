// Texture sampling through the kernel, with an unlit material: texel centres, wrap modes, filters, levels.
#include "floats.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/planner.hpp"
#include "shading/reference/reference.hpp"

#include "tests/support/catch.hpp"

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

Texture random_texture(int width, int height, std::uint32_t seed) {
    FloatMaker make(seed);
    std::vector<std::uint16_t> texels;
    for (int i = 0; i < width * height * 4; ++i) texels.push_back(static_cast<std::uint16_t>(make.below(65536)));
    return Texture::from_rgba16(texels, width, height).value();
}

struct Point {
    float u, v, texels_per_pixel = 0.25f;
};

/// Colours at up to 64 points, on the widest set there is (the sets agree: kernel_agreement_test).
std::vector<reference::Rgba> sample_all(const Texture& texture, const TextureUse& asked, const std::vector<Point>& points) {
    TextureUse use = asked;
    use.texture = 0;
    Material material;
    material.unlit = true;
    material.alpha_mode = AlphaMode::blend;
    material.textures[TextureSlot::base_color] = use;
    const std::vector<SlotMask> available{3u, 3u};
    const ShadingPlan plan = plan_shading({std::span(&material, 1), std::span(&texture, 1), available, {}, {}, {}});
    FragmentBlock block{};
    for (std::size_t i = 0; i < points.size(); ++i) {
        block.lane[kU0][i] = points[i].u;
        block.lane[kV0][i] = points[i].v;
        block.lane[kDu0Dx][i] = points[i].texels_per_pixel / static_cast<float>(texture.width());
    }
    shade_kernels(default_isa().value()).shade(plan, plan.materials[0], all_lights(plan), block, static_cast<int>(points.size()));
    std::vector<reference::Rgba> colors;
    for (std::size_t i = 0; i < points.size(); ++i) colors.push_back({block.red[i], block.green[i], block.blue[i], block.alpha[i]});
    return colors;
}

double unorm(const Texture& texture, std::size_t level, int x, int y, int channel) {
    const TextureLevel& l = texture.levels()[level];
    return texture.data()[static_cast<std::size_t>(4 * (l.offset + y * l.width + x) + channel)] / 65535.0;
}

double distance(const reference::Rgba& a, const reference::Rgba& b) {
    return std::max({std::fabs(a.r - b.r), std::fabs(a.g - b.g), std::fabs(a.b - b.b), std::fabs(a.a - b.a)});
}

}  // namespace

TEST_CASE("sampling: a texel's centre gives the texel, with either filter", "[shading][sampling]") {
    const Texture texture = random_texture(8, 8, 1);
    for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::linear}) {
        TextureUse use;
        use.sampler.mag = use.sampler.min = filter;
        std::vector<Point> centres;
        for (int i = 0; i < 64; ++i) centres.push_back({(static_cast<float>(i % 8) + 0.5f) / 8, (static_cast<float>(i / 8) + 0.5f) / 8});
        const auto colors = sample_all(texture, use, centres);
        for (int i = 0; i < 64; ++i) {
            // The value itself, up to the one rounding of v / 65535 to float32.
            CHECK(colors[static_cast<std::size_t>(i)].r == Approx(unorm(texture, 0, i % 8, i / 8, 0)).epsilon(1.2e-7));
            CHECK(colors[static_cast<std::size_t>(i)].a == Approx(unorm(texture, 0, i % 8, i / 8, 3)).epsilon(1.2e-7));
        }
    }
}

TEST_CASE("sampling: white stays exactly 1 and black exactly 0", "[shading][sampling]") {
    std::vector<std::uint8_t> picture;
    for (int i = 0; i < 9; ++i) picture.insert(picture.end(), {255, 0, 255, 255});
    const Texture texture = Texture::from_rgba8(picture, 3, 3, ColorSpace::srgb).value();
    std::vector<Point> points;
    for (int i = 0; i < 64; ++i)
        points.push_back({static_cast<float>(i) * 0.137f - 3.0f, static_cast<float>(i) * 0.071f, 0.3f * static_cast<float>(i % 8)});
    for (const auto& color : sample_all(texture, {}, points)) {
        CHECK(color.r == 1.0);
        CHECK(color.g == 0.0);
        CHECK(color.a == 1.0);
    }
}

TEST_CASE("sampling: wrap modes, filters and levels agree with a brute-force sampler", "[shading][sampling]") {
    FloatMaker make(77);
    double worst = 0;
    int compared = 0;
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 2}, {8, 4}, {5, 7}, {13, 1}, {33, 20}}) {
        const Texture texture = random_texture(width, height, static_cast<std::uint32_t>(width));
        for (int mode = 0; mode < 3 * 3 * 2 * 2 * 3; ++mode) {
            TextureUse use;
            use.sampler = {static_cast<TextureWrap>(mode % 3), static_cast<TextureWrap>(mode / 3 % 3),
                           static_cast<TextureFilter>(mode / 9 % 2), static_cast<TextureFilter>(mode / 18 % 2),
                           static_cast<MipFilter>(mode / 36)};
            std::vector<Point> points;
            while (points.size() < 64) {
                Point p{make.ordinary(-3.5f, 3.5f), make.ordinary(-3.5f, 3.5f), std::exp2(make.ordinary(-2.0f, 6.0f))};
                const double lod = std::log2(static_cast<double>(p.texels_per_pixel));
                // Points where a value jumps are left out: the border between nearest texels, between nearest levels, and between the two
                // filters.
                const auto near_border = [](double x) { return std::fabs(x - std::nearbyint(x)) < 1e-3; };
                bool jumps = std::fabs(lod) < 1e-3 || near_border(lod - 0.5);
                for (const TextureLevel& level : texture.levels())
                    jumps = jumps || near_border(static_cast<double>(p.u) * level.width) ||
                            near_border(static_cast<double>(p.v) * level.height);
                if (!jumps) points.push_back(p);
            }
            const auto colors = sample_all(texture, use, points);
            for (std::size_t i = 0; i < points.size(); ++i) {
                const double lod = std::log2(static_cast<double>(points[i].texels_per_pixel));
                const reference::Rgba want = reference::sample(texture, use.sampler, points[i].u, points[i].v, lod);
                const double error = distance(colors[i], want);
                INFO(width << " x " << height << ", mode " << mode << ", u " << points[i].u << ", v " << points[i].v << ", lod " << lod);
                if (!(error <= 3e-5)) CHECK(colors[i].r == Approx(want.r));
                worst = std::max(worst, error), ++compared;
            }
        }
    }
    // The largest errors come from the level of detail (4e-6) and from a coordinate (2e-7 * size) between texels a full range apart.
    INFO("worst " << worst);
    CHECK(worst > 0);
    CHECK(compared == 6 * 108 * 64);
}

TEST_CASE("sampling: at a whole level of detail trilinear gives that level's texels", "[shading][sampling]") {
    const Texture texture = random_texture(16, 16, 3);
    for (std::size_t level = 0; level < 5; ++level) {
        const int size = 16 >> level;
        std::vector<Point> points;
        for (int i = 0; i < size && i < 8; ++i)
            points.push_back({(static_cast<float>(i) + 0.5f) / static_cast<float>(size), 0.5f / static_cast<float>(size),
                              static_cast<float>(1 << level)});
        const auto colors = sample_all(texture, {}, points);
        for (int i = 0; i < static_cast<int>(points.size()); ++i) {
            INFO("level " << level << ", texel " << i);
            CHECK(colors[static_cast<std::size_t>(i)].g == Approx(unorm(texture, level, i, 0, 1)).epsilon(1.2e-7));
        }
    }
}

TEST_CASE("sampling: a footprint beyond the picture gives its mean", "[shading][sampling]") {
    const Texture texture = random_texture(16, 16, 4);
    const auto colors = sample_all(texture, {}, {{0.1f, 0.7f, 16.0f}, {0.9f, 0.2f, 1e6f}, {0.3f, 0.3f, 3e38f}});
    for (const auto& color : colors) CHECK(color.b == Approx(unorm(texture, 4, 0, 0, 2)).epsilon(1.2e-7));
}

TEST_CASE("sampling: coordinates that are NaN, infinite or huge read as (0, 0)", "[shading][sampling]") {
    const Texture texture = random_texture(4, 4, 5);
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::mirror, TextureWrap::clamp}) {
        TextureUse use;
        use.sampler = {wrap, wrap, TextureFilter::linear, TextureFilter::linear, MipFilter::linear};
        const auto colors = sample_all(texture, use, {{0.0f, 0.0f}, {kNan, kNan}, {-kInf, -3.4e38f}, {0.0f, -kInf}});
        for (const auto& color : colors) CHECK(distance(color, colors[0]) == 0.0);
    }
}

TEST_CASE("sampling: a texture transform moves coordinates and footprint alike", "[shading][sampling]") {
    const Texture texture = random_texture(16, 16, 6);
    TextureUse use;
    use.row_u = {0.0f, 2.0f, 0.25f};  // quarter turn, twice as many repeats
    use.row_v = {-2.0f, 0.0f, 0.5f};
    const std::vector<Point> points{{0.13f, 0.77f, 1.0f}, {0.6f, 0.2f, 2.0f}, {0.45f, 0.9f, 0.3f}};
    const auto colors = sample_all(texture, use, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double u = 2.0 * static_cast<double>(points[i].v) + 0.25, v = -2.0 * static_cast<double>(points[i].u) + 0.5;
        const reference::Rgba want =
            reference::sample(texture, use.sampler, u, v, std::log2(2.0 * static_cast<double>(points[i].texels_per_pixel)));
        CHECK(distance(colors[i], want) <= 3e-5);
    }
}

TEST_CASE("sampling: just below zero a repeated picture shows its last texel", "[shading][sampling]") {
    for (const int size : {1, 2, 3, 7, 16}) {
        const Texture texture = random_texture(size, size, 8);
        for (const TextureFilter mag : {TextureFilter::nearest, TextureFilter::linear}) {
            TextureUse use;
            use.sampler.mag = mag;
            use.sampler.min = TextureFilter::nearest;
            use.sampler.mip = MipFilter::none;
            // Minified, so that the filter is nearest. With a linear mag filter the lanes take the code path for both filters.
            const auto colors = sample_all(texture, use, {{-1e-9f, -1e-20f, 2.0f}, {-1e-45f, -6e-8f, 2.0f}});
            for (const auto& color : colors) {
                INFO("size " << size);
                CHECK(color.r == Approx(unorm(texture, 0, size - 1, size - 1, 0)).epsilon(1.2e-7));
            }
        }
    }
}
