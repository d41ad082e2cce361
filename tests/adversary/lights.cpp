// Lights and environments of the trials.
#include "sh/equirect.hpp"
#include "tests/adversary/trial.hpp"

#include <algorithm>
#include <list>
#include <tuple>

namespace halflit::adversary {
namespace {

/// Direction from the surface to a light: about the normal, anywhere, or where the eye sees the highlight, which may be at a grazing angle.
Vec3f towards_light(Genes& genes, const Aim& aim) {
    const int kind = genes.pick(4);
    const Vec3f any = some_direction(genes);
    const float off = genes.octaves32(0x1p-12, 12);
    if (kind == 0) return normalize_or(aim.normal + any, aim.normal);
    if (kind == 1) return any;
    if (kind == 2) return normalize_or(aim.to_eye * -1.0f + any * off, aim.normal);
    const Vec3f mirrored = aim.normal * (2.0f * dot(aim.normal, aim.to_eye)) - aim.to_eye;
    return normalize_or(mirrored + any * off, aim.normal);
}

void add_light_kind(const Genome& genome, int kind, const Aim& aim, Trial& trial) {
    Genes genes(genome, kLight + kind, trial.read);
    // One light always, others with a half, a quarter..
    if (kind > 0 && !genes.chance(0.5)) return;
    Light light;
    light.type = static_cast<LightType>(genes.pick(3));
    const Vec3f towards = towards_light(genes, aim);
    const float distance = aim.size * genes.octaves32(0x1p-8, 16);
    light.position_ws = aim.point + towards * distance;
    light.direction_ws = towards * -1.0f;
    const bool aside = genes.chance(0.3);
    const Vec3f off_axis = some_direction(genes);
    const float off = genes.real32(0, 1);
    if (aside) light.direction_ws = normalize_or(light.direction_ws + off_axis * off, {0, -1, 0});
    const bool odd_length = genes.chance(0.1);
    const float axis_length = genes.octaves32(0x1p-8, 16);
    if (odd_length) light.direction_ws = light.direction_ws * axis_length;
    light.range = genes.chance(0.4) ? distance * genes.octaves32(0.5, 4) : 0.0f;
    if (light.range == 0) genes.skip(1);
    light.source_radius = genes.chance(0.4) ? distance * genes.octaves32(0x1p-6, 8) : 0.0f;
    if (light.source_radius == 0) genes.skip(1);
    light.outer_cone_rad = std::min(1.57f, genes.octaves32(1.57 / 4096, 12));
    light.inner_cone_rad = light.outer_cone_rad * genes.real32(0, 0.9999);
    light.cone_power = genes.chance(0.25) ? genes.octaves32(0.25, 14) : 0.0f;
    if (light.cone_power == 0) genes.skip(1);
    const float brightness = genes.chance(0.6) ? genes.octaves32(0x1p-6, 8) : genes.octaves32(1.0 / 4096, 20);
    const Vec3f color = some_color(genes);
    const int copies = genes.chance(0.12) ? std::max(2, static_cast<int>(genes.octaves(2, 5.5))) : 1;
    Numbers numbers(genes.seed());
    const float falloff = light.type == LightType::directional ? 1.0f : distance * distance;
    light.color_linear = color * (brightness * falloff / static_cast<float>(copies));
    for (int i = 0; i < copies; ++i) {
        Light one = light;
        if (i > 0) {
            const auto some = [&] { return static_cast<float>(numbers.real(-0.5, 0.5)); };
            const Vec3f turn{some(), some(), some()};
            one.position_ws = light.position_ws + turn * distance;
            one.direction_ws = light.direction_ws + turn * length(light.direction_ws);
        }
        trial.scene.lights.push_back(one);
    }
}

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

/// Leaves out what whole_sky_applies() refuses.
void make_plain(Trial& trial) {
    trial.settings.shading.specular = SpecularModel::none;
    trial.settings.shadows = ShadowMode::off;
    trial.settings.samples = 1;
    for (Mesh& mesh : trial.scene.meshes) mesh.colors.clear();
    for (Material& m : trial.scene.materials) {
        m.base_color_texture = m.occlusion_texture = m.normal_texture = {};
        m.alpha_mode = AlphaMode::opaque;
        m.unlit = false;
    }
}

struct Sky {
    EnvironmentImage image;
    EnvironmentOptions options;
    std::shared_ptr<const Environment> environment;
};

/// The reference takes most of a second for a new environment, so that a search keeps them.
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

void add_lights(const Genome& genome, const Aim& aim, Trial& trial) {
    for (int kind = 0; kind < kLightKinds; ++kind) add_light_kind(genome, kind, aim, trial);
}

void add_sky(const Genome& genome, AvoidSet avoid, Trial& trial) {
    Genes genes(genome, kSky, trial.read);
    const bool ambient = genes.chance(0.5), sky = genes.chance(0.06);
    const float level = genes.octaves32(1.0 / 1024, 11);
    const Vec3f above = some_color(genes), below = some_color(genes);
    if (sky) {
        SkyRecipe recipe{};
        recipe.kind = genes.pick(3);
        recipe.width = 16 << genes.pick(5);
        recipe.level = about_exp2(std::floor(genes.real(-5, 2)));
        recipe.suns = genes.pick(4);
        recipe.contrast = genes.octaves(1, 14);
        recipe.sun_rad = genes.octaves(1.0 / 128, 4);
        recipe.turn = genes.chance(0.3) ? 1.0 : 0.0;
        recipe.seed = genes.seed() >> 14;
        recipe.extract = genes.chance(0.7) && (avoid & kAvoidSuns) == 0;
        const bool alone = genes.chance(0.5);
        if (!genes.chance(0.15)) make_plain(trial);
        const Sky& made = prepared_sky(recipe);
        trial.sky = made.image;
        trial.sky_options = made.options;
        if (alone) trial.scene.lights.clear();
        set_environment(trial.scene, made.environment);
        trial.width = 32, trial.height = 24;  // sums over images take long
        // One lobe, because the reference takes most of a second for each.
        for (Material& m : trial.scene.materials) m.lobe = trial.scene.materials[0].lobe;
    } else if (ambient) {
        trial.scene.ambient = {above * level, below * (0.5f * level)};
    }
}

Trial make_trial(const Genome& genome, AvoidSet avoid) {
    Trial trial;
    Genes genes(genome, kFrame, trial.read);
    Settings& s = trial.settings;
    s.background_linear = {0, 0, 0, 1};
    s.shading.max_error_codes = genes.octaves(0.05, 7.3);
    s.exposure = genes.chance(0.3) ? genes.octaves32(0x1p-6, 12) : 1.0f;
    genes.skip(s.exposure == 1.0f ? 1 : 0);
    constexpr SpecularModel kModels[] = {SpecularModel::none, SpecularModel::phong, SpecularModel::blinn};
    s.shading.specular = kModels[genes.pick(3)];
    s.shading.normalize_specular = !genes.chance(0.2);
    s.shading.environment_bands = genes.chance(0.05) ? 3 : 0;
    constexpr ShadowMode kModes[] = {ShadowMode::off, ShadowMode::off, ShadowMode::off, ShadowMode::hard, ShadowMode::soft_split, ShadowMode::soft_split};
    s.shadows = kModes[genes.pick(6)];
    if (s.shadows == ShadowMode::soft_split && (avoid & kAvoidSoftSplit) != 0) s.shadows = ShadowMode::off;
    s.shadow_size = 64 << genes.pick(3);
    const float fade = genes.chance(0.3) ? genes.octaves32(0x1p-6, 10) : 0.0f;
    s.shadow_terminator_offset = genes.chance(0.3);
    constexpr int kSamples[] = {1, 1, 1, 1, 1, 1, 1, 1, 4, 8};
    s.samples = kSamples[genes.pick(10)];

    add_materials(genome, avoid, trial);
    Aim aim = add_bodies(genome, avoid, trial);
    place_camera(genome, aim, trial);
    add_lights(genome, aim, trial);
    add_sky(genome, avoid, trial);
    s.shadow_fade = fade * aim.size;
    return trial;
}

}  // namespace halflit::adversary
