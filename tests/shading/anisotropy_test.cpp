// Anisotropic filters: against float64 within the bound of budgets, alike on every instruction set, and off where they do not apply.
#include "floats.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/planner.hpp"
#include "shading/reference/reference.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

Texture noise(FloatMaker& make, int width, int height, bool smooth) {
    std::vector<std::uint16_t> texels;
    for (int i = 0; i < 4 * width * height; ++i)
        texels.push_back(static_cast<std::uint16_t>(smooth ? 30000 + make.below(2000) : make.below(65536)));
    return Texture::from_rgba16(texels, width, height).value();
}

/// Footprints of any shape and direction, from magnified to longer than the texture.
void fill(FloatMaker& make, FragmentBlock& block, int width, int height) {
    for (int lane = 0; lane < kBlockSize; ++lane) {
        block.lane[kU0][lane] = make.ordinary(-2.5f, 2.5f);
        block.lane[kV0][lane] = make.ordinary(-2.5f, 2.5f);
        const float turn = make.ordinary(-1, 1), longer = std::exp2(make.ordinary(-2, 8)),
                    shorter = longer * std::exp2(make.ordinary(-7, 0));
        const float across = make.ordinary(-1, 1);
        block.lane[kDu0Dx][lane] = longer / static_cast<float>(width);
        block.lane[kDv0Dx][lane] = longer * turn / static_cast<float>(height);
        block.lane[kDu0Dy][lane] = shorter * across / static_cast<float>(width);
        block.lane[kDv0Dy][lane] = shorter / static_cast<float>(height);
    }
}

struct Unlit {
    Material material;
    ShadingPlan plan;
};
Unlit unlit(const Texture& texture, int anisotropy, const TextureUse& use = {}) {
    Unlit out;
    out.material.unlit = true;
    out.material.textures[TextureSlot::base_color] = use;
    out.material.textures[TextureSlot::base_color].texture = 0;
    const std::vector<SlotMask> available{3u, 3u};
    ShadingSettings options;
    options.anisotropy = anisotropy;
    out.plan = plan_shading({std::span(&out.material, 1), std::span(&texture, 1), available, {}, {}, options});
    return out;
}

void draw(const Unlit& unlit, FragmentBlock& block, Isa isa) {
    shade_kernels(isa).shade(unlit.plan, unlit.plan.materials[0], all_lights(unlit.plan), block, kBlockSize);
}

}  // namespace

TEST_CASE("anisotropy: filtered channels are near those of float64, and the same bits on every set", "[shading][texture][sampling]") {
    FloatMaker make(5);
    double closest = 0;
    for (const auto& [width, height] : {std::pair{64, 64}, {256, 32}, {300, 77}, {5, 3}})
        for (const bool smooth : {true, false}) {
            const Texture texture = noise(make, width, height, smooth);
            for (int mode = 0; mode < 6; ++mode) {
                TextureUse use;
                use.sampler.wrap_u = use.sampler.wrap_v = static_cast<TextureWrap>(mode % 3);
                if (mode / 3 == 1) use.row_u = {0.7f, 1.9f, 0.3f}, use.row_v = {-1.9f, 0.7f, -0.1f};
                for (const int anisotropy : {2, 3, 16}) {
                    const Unlit surface = unlit(texture, anisotropy, use);
                    REQUIRE(surface.plan.materials[0].textures[TextureSlot::base_color].anisotropy == anisotropy);
                    ShadingSettings options;
                    options.anisotropy = anisotropy;
                    const reference::FrameInputs frame{std::span(&texture, 1), {}, {}, options};
                    for (int round = 0; round < 4; ++round) {
                        FragmentBlock block{};
                        fill(make, block, width, height);
                        draw(surface, block, Isa::scalar);
                        for (const Isa isa : built_isas()) {
                            if (!isa_available(isa)) continue;
                            FragmentBlock other = block;
                            draw(surface, other, isa);
                            CHECK(std::memcmp(&other, &block, sizeof block) == 0);
                        }
                        for (int lane = 0; lane < kBlockSize; ++lane) {
                            const reference::Rgba want = reference::shade(frame, surface.material, 3u, block, lane);
                            constexpr double bound = 2e-4;  // of float32: coordinates are off by up to 1e-4 texels, steps are up to 1
                            const double error = std::fabs(static_cast<double>(block.green[lane]) - want.g);
                            closest = std::max(closest, error / bound);
                            if (error > bound)
                                FAIL(width << " x " << height << ", lane " << lane << ": off by " << error << ", bound " << bound);
                        }
                    }
                }
            }
        }
    INFO("closest to its bound: " << closest);
    CHECK(closest > 0.01);
}

TEST_CASE("anisotropy: a row of stripes along the footprint averages out, stripes across it stay", "[shading][texture][sampling]") {
    // Stripes of one texel. The footprint is 8 texels long and one wide.
    for (const bool along_u : {true, false}) {
        std::vector<std::uint8_t> rgba;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) rgba.insert(rgba.end(), 4, static_cast<std::uint8_t>((along_u ? x : y) % 2 == 0 ? 255 : 0));
        const Texture texture = Texture::from_rgba8(rgba, 64, 64, ColorSpace::linear).value();
        FragmentBlock block{};
        for (int lane = 0; lane < kBlockSize; ++lane) {
            block.lane[kU0][lane] = (static_cast<float>(lane % 8) + 20.5f) / 64.0f;
            block.lane[kV0][lane] = (static_cast<float>(lane / 8) + 20.5f) / 64.0f;
            block.lane[kDu0Dx][lane] = 8.0f / 64.0f;
            block.lane[kDv0Dy][lane] = 1.0f / 64.0f;
        }
        FragmentBlock one = block;
        draw(unlit(texture, 16), block, Isa::scalar);
        draw(unlit(texture, 1), one, Isa::scalar);
        for (int lane = 0; lane < kBlockSize; ++lane) {
            CHECK(std::fabs(one.red[lane] - 0.5f) < 1e-4f);  // a level of 8 x 8 texels each
            const float stripe = (along_u ? lane : lane / 8) % 2 == 0 ? 1.0f : 0.0f;
            if (along_u)
                CHECK(std::fabs(block.red[lane] - 0.5f) < 0.07f);  // 8 probes, all weights the same but the last half
            else
                CHECK(std::fabs(block.red[lane] - stripe) < 1e-4f);
        }
    }
}

TEST_CASE("anisotropy: magnified textures and samplers without linear levels have the bits of 1", "[shading][texture][sampling]") {
    FloatMaker make(6);
    const Texture texture = noise(make, 64, 64, false);
    for (int mode = 0; mode < 4; ++mode) {
        TextureUse use;
        if (mode == 1) use.sampler.mip = MipFilter::nearest;
        if (mode == 2) use.sampler.mip = MipFilter::none;
        if (mode == 3) use.sampler.min = TextureFilter::nearest;
        FragmentBlock block{};
        fill(make, block, 64, 64);
        if (mode == 0)
            for (int row = kDu0Dx; row <= kDv0Dy; ++row)
                for (float& x : block.lane[row]) x *= 1e-3f;
        FragmentBlock one = block;
        draw(unlit(texture, 16, use), block, Isa::scalar);
        draw(unlit(texture, 1, use), one, Isa::scalar);
        CHECK(std::memcmp(&one, &block, sizeof block) == 0);
    }
}
