#include "bench/kernel_rows.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/planner.hpp"
#include "tests/support/random.hpp"

#include <cmath>
#include <map>
#include <memory>

namespace halflit::bench {
namespace {

using shading::FragmentBlock;
using test::Random;

constexpr int kRowPixels = 512;  // pixels of a row of the picture

/// Order in which texels are read.
enum class Walk { rows_of_a_picture, anywhere };

const std::vector<Texture>& textures_of(int side) {
    static std::map<int, std::vector<Texture>> made;
    std::vector<Texture>& textures = made[side];
    if (!textures.empty()) return textures;
    Random random(4);
    for (int i = 0; i < 2; ++i) {
        std::vector<std::uint8_t> rgba8(static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * 4);
        for (std::uint8_t& byte : rgba8) byte = static_cast<std::uint8_t>(random.integer(0, 255));
        textures.push_back(Texture::from_rgba8(rgba8, side, side, ColorSpace::linear).value());
    }
    return textures;
}

/// Blocks of fragments with a material of two textures and a constant ambient light.
struct Textured {
    shading::ShadingPlan frame;
    std::vector<FragmentBlock> blocks;

    Textured(int side, int block_count, Walk walk, bool alike) : blocks(static_cast<std::size_t>(block_count)) {
        Material material;
        material.textures[TextureSlot::base_color].texture = 0;
        material.textures[TextureSlot::emissive].texture = 1;
        if (!alike) material.textures[TextureSlot::emissive].sampler.wrap_u = TextureWrap::mirror;
        material.emissive = {1, 1, 1};
        const shading::SlotMask slots[] = {shading::kBaseSlots, shading::kBaseSlots};
        ShadingSettings options;
        options.specular = SpecularModel::none;
        frame = shading::plan_shading({{&material, 1}, textures_of(side), slots, {}, {{1, 1, 1}, {1, 1, 1}}, options});
        fill(side, walk);
    }

private:
    /// Steps of 1.4 texels from pixel to pixel: halfway between two levels.
    void fill(int side, Walk walk) {
        Random random(5);
        const float step = 1.4f / static_cast<float>(side);
        int pixel = 0;
        for (FragmentBlock& block : blocks)
            for (int l = 0; l < shading::kBlockSize; ++l, ++pixel) {
                const bool rows = walk == Walk::rows_of_a_picture;
                const int x = pixel % kRowPixels, y = pixel / kRowPixels;
                block.lane[shading::kNormalY][l] = 1;
                block.lane[shading::kU0][l] = rows ? 0.013f + step * static_cast<float>(x) : random.real32(0, 1);
                block.lane[shading::kV0][l] = rows ? 0.017f + step * static_cast<float>(y) : random.real32(0, 1);
                block.lane[shading::kDu0Dx][l] = block.lane[shading::kDv0Dy][l] = step;
            }
    }
};

KernelRow texture_row(const char* name, int side, int blocks, Walk walk, bool alike) {
    return {name, "pixel", static_cast<double>(blocks * shading::kBlockSize), [=](Isa isa) -> std::function<void()> {
                const auto data = std::make_shared<Textured>(side, blocks, walk, alike);
                return [data, &kernels = shading::shade_kernels(isa)] {
                    for (FragmentBlock& block : data->blocks)
                        kernels.shade(data->frame, data->frame.materials[0], {}, block, shading::kBlockSize);
                };
            }};
}

}  // namespace

std::vector<KernelRow> texture_rows() {
    return {texture_row("two textures of 32 x 32, hot", 32, 8, Walk::rows_of_a_picture, true),
            texture_row("the same, with wraps that differ", 32, 8, Walk::rows_of_a_picture, false),
            texture_row("two textures of 1024 x 1024, in rows", 1024, 512, Walk::rows_of_a_picture, true),
            texture_row("two textures of 2048 x 2048, anywhere: cold", 2048, 512, Walk::anywhere, true)};
}

}  // namespace halflit::bench
