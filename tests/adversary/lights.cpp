// Lights of the trials, and the whole of one.
#include "tests/adversary/trial.hpp"

#include <algorithm>

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

/// (s + 8) / 8 for the first material, s = 2 / alpha^2 - 2.
float highlight_peak(const Trial& trial) {
    const float roughness = std::max(trial.scene.materials[0].roughness, 0.07f), alpha = roughness * roughness;
    return trial.settings.shading.normalize_specular ? (2.0f / (alpha * alpha) + 6.0f) * 0.125f : 1.0f;
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
    // Usual light; light from nearly none to far too much; or as much as makes the highlight usual, which is brighter by (s + 8) / 8.
    const double level = genes.next();
    float brightness = level < 0.3 || level > 0.7 ? genes.octaves32(0x1p-6, 8) : genes.octaves32(1.0 / 4096, 20);
    if (level > 0.7) brightness /= highlight_peak(trial);
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

}  // namespace

void add_lights(const Genome& genome, const Aim& aim, Trial& trial) {
    for (int kind = 0; kind < kLightKinds; ++kind) add_light_kind(genome, kind, aim, trial);
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
    constexpr ShadowMode kModes[] = {ShadowMode::off,  ShadowMode::off,        ShadowMode::off,
                                     ShadowMode::hard, ShadowMode::soft_split, ShadowMode::soft_split};
    s.shadows = kModes[genes.pick(6)];
    if (s.shadows == ShadowMode::soft_split && (avoid & kAvoidSoftSplit) != 0) s.shadows = ShadowMode::off;
    s.shadow_size = 64 << genes.pick(3);
    const float fade = genes.chance(0.3) ? genes.octaves32(0x1p-6, 10) : 0.0f;
    s.shadow_terminator_offset = genes.chance(0.3);
    constexpr int kSamples[] = {1, 1, 1, 1, 1, 1, 1, 1, 4, 8};
    s.samples = kSamples[genes.pick(10)];
    s.sky_shadows = genes.chance(0.08) ? 32 : 0;
    const float softness = genes.chance(0.12) ? genes.real32(0.01, 0.2) : 0.0f;
    s.soft_shadow_maps = 4;
    s.shading.normal_scale = genes.chance(0.12) ? genes.octaves32(0.25, 4) : 1.0f;

    add_materials(genome, avoid, trial);
    Aim aim = add_bodies(genome, avoid, trial);
    place_camera(genome, aim, trial);
    add_lights(genome, aim, trial);
    add_sky(genome, avoid, trial);
    for (Light& light : trial.scene.lights) light.shadow_radius = softness * (light.type == LightType::directional ? 1.0f : aim.size);
    if (genes.chance(0.12)) trial.scene.instances[0].color = {genes.real32(0, 1), genes.real32(0, 1), genes.real32(0, 1), 1};
    s.shadow_fade = fade * aim.size;
    return trial;
}

}  // namespace halflit::adversary
