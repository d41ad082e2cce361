// Ranges of a texture's channels, and the error of filtering them in float32, which never exceeds its bound.
#include "shading/budget/texture_bounds.hpp"
#include "shading/planner.hpp"

#include "floats.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/reference/reference.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

/// Texture of `periods` waves across the picture, with noise added: `noise` is its share of the range.
Texture wavy(int width, int height, double periods, double noise, FloatMaker& make) {
    std::vector<std::uint16_t> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 4; ++c) {
                const double wave = std::sin(2.0 * kPi * periods * (static_cast<double>(x) / width + static_cast<double>(y) / height) + c);
                const double rough = static_cast<double>(make.ordinary(-1, 1));
                texels.push_back(static_cast<std::uint16_t>(65535.0 * (0.5 + 0.5 * ((1.0 - noise) * 0.9 * wave + noise * rough))));
            }
    return Texture::from_rgba16(texels, width, height).value();
}

}  // namespace

TEST_CASE("texture bounds: ranges and steps are those of all levels, across the edges too", "[shading][texture]") {
    FloatMaker make(8);
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 6}, {7, 1}, {2, 2}, {16, 8}, {13, 9}}) {
        const Texture texture = wavy(width, height, 1.0, 0.5, make);
        for (std::size_t c = 0; c < 4; ++c) {
            int least = 65535, most = 0, step = 0;
            for (const TextureLevel& level : texture.levels()) {
                const auto at = [&](int x, int y) {
                    const int texel = level.offset + (y % level.height) * level.width + x % level.width;
                    return static_cast<int>(texture.data()[static_cast<std::size_t>(4 * texel) + c]);
                };
                for (int y = 0; y < level.height; ++y)
                    for (int x = 0; x < level.width; ++x) {
                        least = std::min(least, at(x, y)), most = std::max(most, at(x, y));
                        step = std::max({step, std::abs(at(x, y) - at(x + 1, y)), std::abs(at(x, y) - at(x, y + 1))});
                    }
            }
            INFO(width << " x " << height << ", channel " << c);
            CHECK(texture.range().least[c] == least);
            CHECK(texture.range().most[c] == most);
            CHECK(texture.range().step[c] == step);
        }
    }
}

TEST_CASE("texture bounds: stored texels differ from unrounded ones by no more than their range says", "[shading][texture]") {
    FloatMaker make(12);
    for (const auto& [width, height] : {std::pair{1, 1}, {256, 1}, {64, 64}, {129, 37}, {512, 256}})
        for (const ColorSpace space : {ColorSpace::srgb, ColorSpace::linear}) {
            std::vector<std::uint8_t> rgba(static_cast<std::size_t>(4 * width * height));
            for (std::uint8_t& code : rgba) code = static_cast<std::uint8_t>(make.below(make.below(4) == 0 ? 256 : 20));
            const Texture texture = Texture::from_rgba8(rgba, width, height, space).value();
            double worst[4] = {0, 0, 0, 0};
            std::vector<double> exact, above;  // one level; box filters with weights that are lengths of overlap
            for (std::size_t i = 0; i < rgba.size(); ++i) {
                const double c = rgba[i] / 255.0;
                exact.push_back(space == ColorSpace::linear || i % 4 == 3 ? c
                                : c <= 0.04045                            ? c / 12.92
                                                                          : std::pow((c + 0.055) / 1.055, 2.4));
            }
            for (std::size_t l = 0; l < texture.levels().size(); ++l) {
                const TextureLevel level = texture.levels()[l];
                if (l > 0) {
                    const TextureLevel large = texture.levels()[l - 1];
                    above.swap(exact);
                    exact.assign(static_cast<std::size_t>(4 * level.width * level.height), 0.0);
                    const double wide = static_cast<double>(large.width) / level.width,
                                 tall = static_cast<double>(large.height) / level.height;
                    const auto overlap = [](int texel, int at, double size) {
                        return std::max(0.0, std::min(texel + 1.0, (at + 1) * size) - std::max(static_cast<double>(texel), at * size));
                    };
                    for (int y = 0; y < level.height; ++y)
                        for (int x = 0; x < level.width; ++x)
                            for (int j = static_cast<int>(y * tall); j < std::min(large.height, static_cast<int>((y + 1) * tall) + 1); ++j)
                                for (int i = static_cast<int>(x * wide); i < std::min(large.width, static_cast<int>((x + 1) * wide) + 1);
                                     ++i)
                                    for (int c = 0; c < 4; ++c)
                                        exact[static_cast<std::size_t>(4 * (y * level.width + x) + c)] +=
                                            above[static_cast<std::size_t>(4 * (j * large.width + i) + c)] * overlap(i, x, wide) *
                                            overlap(j, y, tall) / (wide * tall);
                }
                for (std::size_t i = 0; i < exact.size(); ++i) {
                    const double stored = texture.data()[4 * static_cast<std::size_t>(level.offset) + i];
                    worst[i % 4] = std::max(worst[i % 4], std::fabs(stored - 65535.0 * exact[i]));
                }
            }
            CHECK(static_cast<double>(texture.storage_error()) <= *std::max_element(std::begin(worst), std::end(worst)) + 0.6);
            for (std::size_t c = 0; c < 4; ++c) {
                const auto said = static_cast<double>(texture.storage_error());
                INFO(width << " x " << height << ", channel " << c << ": off by " << worst[c] << ", said " << said);
                CHECK(worst[c] <= said);
            }
        }
}

TEST_CASE("texture bounds: no filtered channel is off by more than its bound", "[shading][texture][sampling]") {
    FloatMaker make(99);
    double closest = 0;
    for (const auto& [width, height] : {std::pair{64, 64}, {1024, 256}, {300, 77}, {5, 3}})
        for (const double noise : {0.0, 1.0}) {
            const Texture texture = wavy(width, height, 2.0, noise, make);
            for (int mode = 0; mode < 3 * 2 * 2; ++mode) {
                Material material;
                material.unlit = true;
                material.alpha_mode = AlphaMode::blend;
                TextureUse& use = material.textures[TextureSlot::base_color];
                use.texture = 0;
                use.sampler.wrap_u = use.sampler.wrap_v = static_cast<TextureWrap>(mode % 3);
                use.sampler.mip = mode / 3 % 2 == 0 ? MipFilter::none : MipFilter::linear;
                if (mode / 6 == 1) use.row_u = {0.7f, 1.9f, 0.3f}, use.row_v = {-1.9f, 0.7f, -0.1f};
                const std::vector<SlotMask> available{3u, 3u};
                const ShadingPlan plan = plan_shading({std::span(&material, 1), std::span(&texture, 1), available, {}, {}, {}});
                const TexturePlan& planned = plan.materials[0].textures[TextureSlot::base_color];
                constexpr float kLargest = 2.5f;
                for (int round = 0; round < 20; ++round) {
                    FragmentBlock block{};
                    for (int lane = 0; lane < kBlockSize; ++lane) {
                        block.lane[kU0][lane] = make.ordinary(-kLargest, kLargest);
                        block.lane[kV0][lane] = make.ordinary(-kLargest, kLargest);
                        block.lane[kDu0Dx][lane] = std::exp2(make.ordinary(-2.0f, 6.0f)) / static_cast<float>(width);
                    }
                    shade_kernels(default_isa().value()).shade(plan, plan.materials[0], all_lights(plan), block, kBlockSize);
                    for (int lane = 0; lane < kBlockSize; ++lane) {
                        const double u = block.lane[kU0][lane], v = block.lane[kV0][lane], du = block.lane[kDu0Dx][lane];
                        const auto moved = [](Vec3f row, double a, double b) { return double{row.x} * a + double{row.y} * b; };
                        const double right = moved(use.row_u, du, 0) * width, down = moved(use.row_v, du, 0) * height;
                        const reference::Rgba want =
                            reference::sample(texture, use.sampler, moved(use.row_u, u, v) + double{use.row_u.z},
                                              moved(use.row_v, u, v) + double{use.row_v.z}, 0.5 * std::log2(right * right + down * down));
                        const double errors[] = {std::fabs(static_cast<double>(block.red[lane]) - want.r),
                                                 std::fabs(static_cast<double>(block.green[lane]) - want.g),
                                                 std::fabs(static_cast<double>(block.blue[lane]) - want.b)};
                        for (int c = 0; c < 3; ++c) {
                            const double bound = filter_error(planned, c, {TexelFacts::Measured::all, kLargest});
                            const double by_ranges = filter_error(planned, c, {TexelFacts::Measured::ranges, kLargest});
                            if (bound > by_ranges || by_ranges > filter_error(planned, c, {TexelFacts::Measured::nothing, kLargest}))
                                FAIL("less is known than measured");
                            closest = std::max(closest, errors[c] / bound);
                            if (errors[c] > bound)
                                FAIL(width << " x " << height << ", noise " << noise << ", mode " << mode << ", u " << u << ", v " << v
                                           << ": off by " << errors[c] << ", bound " << bound);
                        }
                    }
                }
            }
        }
    INFO("closest to its bound: " << closest);
    CHECK(closest > 0.2);
    CHECK(closest <= 1.0);
}
