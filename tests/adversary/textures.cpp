#include "tests/adversary/textures.hpp"

#include "shading/material_properties.hpp"

#include <algorithm>
#include <cmath>
#include <list>

namespace halflit::adversary {
namespace {

enum class Pattern { flat, smooth, checker, noise };

/// Everything that a picture depends on.
struct Recipe {
    int width, height;
    Pattern pattern;
    std::uint64_t seed;
    double low[3], high[3];  ///< by channel
    ColorSpace space;
    bool normals, alpha_read, odd;  ///< odd: z has nothing to do with x and y
    bool operator==(const Recipe&) const = default;
};

double lattice(std::uint64_t seed, int x, int y, int c) {
    return Numbers(seed ^ static_cast<std::uint64_t>(x * 4099 + y * 257 + c) * 0x9E3779B97F4A7C15u).real(0, 1);
}

/// Values in [0, 1] with soft hills, four to a side.
double hills(std::uint64_t seed, double u, double v, int c) {
    constexpr int kHills = 4;
    const double x = u * kHills, y = v * kHills;
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    const auto soft = [](double t) { return t * t * (3 - 2 * t); };
    const double a = soft(x - i), b = soft(y - j);
    const auto at = [&](int p, int q) { return lattice(seed, p % kHills, q % kHills, c); };
    return (at(i, j) * (1 - a) + at(i + 1, j) * a) * (1 - b) + (at(i, j + 1) * (1 - a) + at(i + 1, j + 1) * a) * b;
}

std::shared_ptr<const Picture> paint(const Recipe& r) {
    auto picture = std::make_shared<Picture>();
    picture->width = r.width;
    picture->height = r.height;
    picture->space = r.space;
    picture->rgba8.resize(std::size_t{4} * static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height), 255);
    Numbers noise(r.seed);
    std::size_t at = 0;
    for (int y = 0; y < r.height; ++y)
        for (int x = 0; x < r.width; ++x, at += 4) {
            double value[3];
            for (int c = 0; c < 3; ++c) {
                const double t = r.pattern == Pattern::flat      ? 1.0
                                 : r.pattern == Pattern::smooth  ? hills(r.seed, (x + 0.5) / r.width, (y + 0.5) / r.height, c)
                                 : r.pattern == Pattern::checker ? static_cast<double>((x + y) & 1)
                                                                 : noise.real(0, 1);
                value[c] = r.low[c] + (r.high[c] - r.low[c]) * t;
            }
            if (r.normals && !r.odd)
                value[2] = 0.5 + 0.5 * std::sqrt(std::max(
                                           0.0, 1 - 4 * (value[0] - 0.5) * (value[0] - 0.5) - 4 * (value[1] - 0.5) * (value[1] - 0.5)));
            for (std::size_t c = 0; c < 3; ++c) picture->rgba8[at + c] = static_cast<std::uint8_t>(value[c] * 255.0 + 0.5);
            if (r.alpha_read) picture->rgba8[at + 3] = picture->rgba8[at];
        }
    picture->texture = *Texture::from_rgba8(picture->rgba8, r.width, r.height, picture->space);
    return picture;
}

/// Neighbours of a scene in a search mostly share its pictures, which take longer to make than to draw.
std::shared_ptr<const Picture> painted(const Recipe& recipe) {
    thread_local std::list<std::pair<Recipe, std::shared_ptr<const Picture>>> known;
    for (auto i = known.begin(); i != known.end(); ++i)
        if (i->first == recipe) {
            known.splice(known.begin(), known, i);
            return known.front().second;
        }
    known.emplace_front(recipe, paint(recipe));
    if (known.size() > 12) known.pop_back();
    return known.front().second;
}

}  // namespace

std::shared_ptr<const Picture> some_texture(Genes& genes, TextureSlot slot, AvoidSet avoid, TextureUse& use) {
    const double probability = slot == TextureSlot::base_color ? 0.5 : slot == TextureSlot::occlusion ? 0.1 : 0.25;
    if (!genes.chance(probability)) {
        genes.skip(kTextureGenes - 1);
        return nullptr;
    }
    Recipe r{};
    r.space = shading::info_of(slot).space;
    r.normals = shading::holds_normals(slot);
    r.alpha_read = slot == TextureSlot::specular || slot == TextureSlot::sheen_roughness;
    const double size = genes.octaves(1, 10), shape = genes.next();
    r.width = std::clamp(static_cast<int>(size), 1, 1000);
    r.height = shape < 0.6 ? r.width : std::clamp(static_cast<int>(size * (shape - 0.5) * 4), 1, 1000);
    r.pattern = static_cast<Pattern>(genes.pick(4));
    r.seed = genes.seed();
    // Contrast, tint and level: base colours and roughness from nearly nothing to 1, normals about (1/2, 1/2, 1).
    const bool flat = r.normals && (avoid & kAvoidShortNormals) != 0;
    const double contrast = genes.real(0, flat ? 0.5 : 1.0), level = genes.real(1, 0), tint = genes.real(0, 1);
    for (int c = 0; c < 3; ++c) {
        const double top = level * (c == 0 ? 1.0 : 1.0 - 0.5 * tint * c);
        r.high[c] = r.normals ? 0.5 + 0.5 * contrast * level : top;
        r.low[c] = r.normals ? 1.0 - r.high[c] : top * (1 - contrast);
    }
    r.odd = genes.chance(0.15) && !flat;
    use = {};
    if (genes.chance(0.4)) {
        const double scale = genes.octaves(1.0 / 8, 10);  // up to 128 times
        const Vec3f turn = some_direction(genes);         // its x and y: a rotation if z is 0, a shear otherwise
        use.row_u = {static_cast<float>(scale * turn.y), static_cast<float>(scale * turn.x), static_cast<float>(scale * turn.z)};
        use.row_v = {static_cast<float>(-scale * turn.x), static_cast<float>(scale * turn.y), static_cast<float>(scale)};
    } else {
        genes.skip(4);
    }
    use.uv_set = genes.chance(0.1) ? 1 : 0;
    // The nearest texel and the nearest level have no bound (shading/README.md), so both filters are linear.
    const int sampling = genes.pick(8);
    constexpr TextureWrap kWraps[] = {TextureWrap::repeat, TextureWrap::mirror, TextureWrap::clamp, TextureWrap::repeat};
    use.sampler.wrap_u = kWraps[sampling & 3];
    use.sampler.wrap_v = kWraps[(sampling >> 1) & 3];
    use.sampler.mip = sampling >= 6 ? MipFilter::none : MipFilter::linear;
    return painted(r);
}

}  // namespace halflit::adversary
