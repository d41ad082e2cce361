#include "apps/viewer/controls.hpp"

#include "apps/engine/request/setting_flags.hpp"
#include "halflit/scene.hpp"
#include "sh/arc.hpp"
#include "sh/trig.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace halflit::viewer {
namespace {

constexpr double kDegree = kPi / 180.0;

float power_of(const NamedLobe& model, float wrap) { return model.power + model.power_per_wrap * wrap; }

/// The model that has these parameters, or one that takes any.
int model_of(const Lobe& lobe) {
    const int count = static_cast<int>(std::size(kNamedLobes));
    for (int i = 0; i < count; ++i) {
        const NamedLobe& model = kNamedLobes[i];
        const float wrap = model.takes_wrap ? lobe.wrap : model.wrap;
        if (lobe == Lobe{wrap, power_of(model, wrap), model.normalize}) return i;
    }
    return count - 1;
}

}  // namespace

std::vector<LightControl> light_controls(const std::vector<Light>& lights) {
    std::vector<LightControl> controls;
    for (const Light& light : lights) {
        const Vec3d from = to_double(light.direction_ws) * -1.0;
        controls.push_back({light.type, true, 1.0f, static_cast<float>(angle_of(from.x, from.z) / kDegree),
                            static_cast<float>(angle_of(from.y, std::sqrt(from.x * from.x + from.z * from.z)) / kDegree)});
    }
    return controls;
}

Controls controls_of(const engine::RenderJob& job, const engine::RenderOptions& options) {
    const Settings& settings = job.settings;
    Controls controls;
    controls.own_lobes = !settings.shading.lobe;
    if (settings.shading.lobe)
        controls.lobe = *settings.shading.lobe;
    else if (!job.scene().materials.empty())
        controls.lobe = job.scene().materials[0].lobe;
    controls.model = model_of(controls.lobe);
    controls.specular = settings.shading.specular;
    controls.normalize_specular = settings.shading.normalize_specular;
    controls.shadows = settings.shadows;
    controls.sky_shadows = settings.sky_shadows;
    controls.sh_order = settings.shading.environment_bands;
    controls.sky.rotate_deg = options.environment_rotate_deg;
    controls.over_own_lobes = !options.own_lobes;
    controls.tone_curve = settings.tone_curve;
    controls.samples = settings.samples;
    controls.max_error_codes = static_cast<float>(settings.shading.max_error_codes);
    controls.lights = light_controls(job.light.lights);
    return controls;
}

void choose_model(Controls& controls, int model) {
    const NamedLobe& named = kNamedLobes[model];
    Lobe& lobe = controls.lobe;
    const bool took_wrap = kNamedLobes[controls.model].takes_wrap;
    controls.own_lobes = false;
    controls.model = model;
    lobe.wrap = !named.takes_wrap ? named.wrap : took_wrap ? lobe.wrap : kUsualWrap;
    lobe.power = power_of(named, lobe.wrap);
    lobe.normalize = named.normalize;
}

void choose_wrap(Controls& controls, float wrap) {
    const NamedLobe& model = kNamedLobes[controls.model];
    Lobe& lobe = controls.lobe;
    controls.own_lobes = false;
    if (model.power_per_wrap != 0.0f && lobe.power == power_of(model, lobe.wrap)) lobe.power = power_of(model, wrap);
    lobe.wrap = wrap;
}

Settings settings_of(const Controls& controls, const Settings& started) {
    Settings settings = started;
    settings.shading.lobe = controls.own_lobes ? std::nullopt : std::optional<Lobe>(controls.lobe);
    settings.shading.specular = controls.specular;
    settings.shading.normalize_specular = controls.normalize_specular;
    settings.shading.environment_bands = controls.sh_order;
    settings.shading.max_error_codes = static_cast<double>(controls.max_error_codes);
    settings.shadows = controls.shadows;
    settings.sky_shadows = controls.sky_shadows;
    settings.tone_curve = controls.tone_curve;
    settings.samples = controls.samples;
    if (controls.exposure_ev != 0.0f) settings.exposure *= exposure_factor(controls.exposure_ev);
    return settings;
}

std::vector<Light> lights_of(const Controls& controls, const std::vector<Light>& started) {
    std::vector<Light> lights = started;
    const std::vector<LightControl> untouched = light_controls(started);
    for (std::size_t i = 0; i < std::min(lights.size(), controls.lights.size()); ++i) {
        const LightControl& control = controls.lights[i];
        lights[i].color_linear = lights[i].color_linear * (control.on ? control.intensity : 0.0f);
        const bool turned = control.azimuth_deg != untouched[i].azimuth_deg || control.elevation_deg != untouched[i].elevation_deg;
        if (!turned || kind_of(lights[i].type).placed) continue;
        const SinCos az = sin_cos(static_cast<double>(control.azimuth_deg) * kDegree);
        const SinCos el = sin_cos(static_cast<double>(control.elevation_deg) * kDegree);
        lights[i].direction_ws = to_float(Vec3d{az.sin * el.cos, el.sin, az.cos * el.cos} * -1.0);
    }
    return lights;
}

engine::LightRequest with_sky(engine::LightRequest light, const SkyControls& sky) {
    light.environment_rotate_deg = sky.rotate_deg;
    if (sky.sky == Sky::as_started) return light;
    light.environment = sky.sky == Sky::sky ? "sky" : "";
    light.studio = sky.sky == Sky::studio ? StudioUse::always : sky.sky == Sky::none ? StudioUse::never : StudioUse::for_dark;
    return light;
}

std::string as_flags(const Controls& now, const Controls& started, float exposure) {
    std::string flags;
    const auto add = [&](std::string_view flag, const auto& value) { flags += fmt::format(" {} {}", flag, value); };
    if (!now.own_lobes && (started.own_lobes || now.lobe != started.lobe)) {
        add("--wrap", now.lobe.wrap);
        add("--power", now.lobe.power);
        if (now.lobe.normalize) flags += " --normalize";
    }
    if (!now.own_lobes && now.over_own_lobes && !started.over_own_lobes) add("--own-lobes", "off");
    flags += engine::differing_flags(settings_of(now, {}), settings_of(started, {}));
    if (now.sky.sky != Sky::as_started) add("--env", kSkyNames[static_cast<std::size_t>(now.sky.sky)]);
    if (now.sky.rotate_deg != started.sky.rotate_deg) add("--env-rotate", now.sky.rotate_deg);
    if (now.exposure_ev != 0.0f) add("--exposure", std::log2(static_cast<double>(exposure)) + static_cast<double>(now.exposure_ev));
    return flags.empty() ? flags : flags.substr(1);
}

}  // namespace halflit::viewer
