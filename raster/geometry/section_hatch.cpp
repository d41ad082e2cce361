#include "raster/geometry/section_hatch.hpp"

#include "raster/scene/instance_material.hpp"
#include "raster/scene/mean_color.hpp"
#include "shading/model/numbers.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace halflit::raster {
namespace {

constexpr int kHatchTexels = 64;
constexpr double kRootHalf = 0.70710678118654752;  // 1 / sqrt(2)
constexpr double kLineShare = 0.14;                // width of a line, of the distance between lines
constexpr double kLineLevel = 0.3;                 // light of a line, linear
/// Lines are seen on black material too, because the cap has at least this reflectance.
constexpr float kLeastColor = 0.1f;

/// One line from corner to corner, which goes on where the texture repeats. falls: it falls to the right, otherwise it rises.
Result<Texture> make_hatch(bool falls) {
    std::vector<std::uint16_t> texels;
    for (int y = 0; y < kHatchTexels; ++y) {
        for (int x = 0; x < kHatchTexels; ++x) {
            const int along = (falls ? x - y + kHatchTexels : x + y + 1) % kHatchTexels;  // v points down; whole texels from the line
            const int off = std::min(along, kHatchTexels - along);
            // Coverage falls from 1 to 0 within a texel, in the direction of x.
            const double covered = std::clamp(kLineShare * 0.5 * kHatchTexels - off + 0.5, 0.0, 1.0);
            const auto level = static_cast<std::uint16_t>((1.0 - (1.0 - kLineLevel) * covered) * 65535.0 + 0.5);
            texels.insert(texels.end(), {level, level, level, std::uint16_t{65535}});
        }
    }
    return Texture::from_rgba16(texels, kHatchTexels, kHatchTexels);
}

}  // namespace

double hatch_scale(double spacing, int part) {
    constexpr double kSpacings[] = {1.0, 0.7, 1.4};  // pairs of parts, which differ in direction
    return kRootHalf / (spacing * kSpacings[(part / 2) % 3]);
}

int CapMaterials::texture(bool falls) {
    int& index = textures_[falls ? 1 : 0];
    if (index < 0) {
        auto made = make_hatch(falls);
        if (!made) return -1;  // drawn without lines
        scene_.textures.push_back(std::move(*made));
        index = static_cast<int>(scene_.textures.size()) - 1;
    }
    return index;
}

int CapMaterials::add(const Instance& instance, Vec3f color, int part) {
    Material cap;
    cap.metallic = 0.0f;
    cap.roughness = 0.9f;
    cap.double_sided = true;
    const auto factor = [](float x) { return shading::clamp_or_low(x, 0.0f, 1.0f); };
    Vec3f base{factor(instance.color.x * color.x), factor(instance.color.y * color.y), factor(instance.color.z * color.z)};
    if (const Material* const source = material_of(scene_, instance)) {
        const Vec3f mean = mean_color(scene_, source->textures[TextureSlot::base_color]);
        base = base * Vec3f{source->base_color.x, source->base_color.y, source->base_color.z} * mean;
        cap.name = source->name.empty() ? "section" : "section of " + source->name;
        cap.unlit = source->unlit;
        cap.lobe = source->lobe;
        cap.has_own_lobe = source->has_own_lobe;
    } else {
        cap.name = "section";
    }
    const auto lifted = [](float x) { return kLeastColor + (1.0f - kLeastColor) * shading::clamp_or_low(x, 0.0f, 1.0f); };
    cap.base_color = {lifted(base.x), lifted(base.y), lifted(base.z), 1.0f};
    const auto [found, is_new] = made_.try_emplace(
        {raster::material_index(scene_, instance), part % 2 != 0, cap.base_color.x, cap.base_color.y, cap.base_color.z}, -1);
    if (!is_new) return found->second;
    if (hatch_) cap.textures[TextureSlot::base_color].texture = texture(part % 2 != 0);
    scene_.materials.push_back(std::move(cap));
    return found->second = static_cast<int>(scene_.materials.size()) - 1;
}

}  // namespace halflit::raster
