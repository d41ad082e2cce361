// Ambient light and environments of the trials.
#include "sh/equirect.hpp"
#include "tests/adversary/trial.hpp"

#include <algorithm>
#include <list>

namespace halflit::adversary {
namespace {

struct SkyRecipe {
    int kind, width;
    double level, contrast, sun_rad, turn;
    std::uint64_t seed;
    int suns;
    bool extract;
    bool operator==(const SkyRecipe&) const = default;
};

EnvironmentImage paint_sky(const SkyRecipe& r) {
    EnvironmentImage image;
    image.width = r.width;
    image.height = r.width / 2;
    Numbers numbers(r.seed);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double up = 1.0 - (y + 0.5) / image.height;
            const double t = r.kind == 0 ? 1.0 : r.kind == 1 ? up : numbers.real(0, 1);
            for (int c = 0; c < 3; ++c) image.rgb.push_back(static_cast<float>(r.level * t * (1.0 - 0.2 * c * up)));
        }
    // Discs that are brightest in their middle: those under 4 degrees may be taken out as suns.
    for (int i = 0; i < r.suns; ++i) {
        const Vec3d middle = sh::equirect_direction(numbers.real(0, 1), numbers.real(0.1, 0.9));
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                const Vec3d d = sh::equirect_direction((x + 0.5) / image.width, (y + 0.5) / image.height);
                const double inside = 1.0 - 2.0 * (1.0 - dot(d, middle)) / (r.sun_rad * r.sun_rad);  // about 1 - (angle / radius)^2
                const auto at = static_cast<std::size_t>(3 * (y * image.width + x));
                for (std::size_t c = 0; c < 3 && inside > 0; ++c) image.rgb[at + c] += static_cast<float>(r.level * r.contrast * inside);
            }
    }
    return image;
}

struct Sky {
    EnvironmentImage image;
    EnvironmentOptions options;
    std::shared_ptr<const Environment> environment;
};

/// A new environment takes milliseconds, so that a search keeps them.
const Sky& prepared_sky(const SkyRecipe& recipe) {
    thread_local std::list<std::pair<SkyRecipe, Sky>> known;
    for (auto i = known.begin(); i != known.end(); ++i)
        if (i->first == recipe) {
            known.splice(known.begin(), known, i);
            return known.front().second;
        }
    Sky sky;
    sky.image = paint_sky(recipe);
    sky.options = {recipe.extract, recipe.turn, false, true};
    sky.environment = *make_environment(sky.image, sky.options);
    known.emplace_front(recipe, std::move(sky));
    if (known.size() > 4) known.pop_back();
    return known.front().second;
}

}  // namespace

void add_sky(const Genome& genome, AvoidSet avoid, Trial& trial) {
    Genes genes(genome, kSky, trial.read);
    const bool ambient = genes.chance(0.5), sky = genes.chance(0.06);
    const float level = genes.octaves32(1.0 / 1024, 11);
    const Vec3f above = some_color(genes), below = some_color(genes);
    if (sky) {
        SkyRecipe recipe{};
        recipe.kind = genes.pick(3);
        recipe.width = 8 << genes.pick(5);
        recipe.level = about_exp2(std::floor(genes.real(-5, 2)));
        recipe.suns = genes.pick(4);
        recipe.contrast = genes.octaves(1, 14);
        recipe.sun_rad = genes.octaves(1.0 / 128, 4);
        recipe.turn = genes.chance(0.3) ? 1.0 : 0.0;
        recipe.seed = genes.seed() >> 14;
        recipe.extract = genes.chance(0.7) && (avoid & kAvoidSuns) == 0;
        const bool alone = genes.chance(0.5);
        genes.skip(1);
        const Sky& made = prepared_sky(recipe);
        trial.sky = made.image;
        trial.sky_options = made.options;
        if (alone) trial.scene.lights.clear();
        trial.scene.environment = made.environment;
    } else if (ambient) {
        trial.scene.ambient = {above * level, below * (0.5f * level)};
    }
}

}  // namespace halflit::adversary
