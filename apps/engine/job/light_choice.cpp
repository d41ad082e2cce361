#include "apps/engine/job/job_steps.hpp"

#include "apps/io/models/scaled_lengths.hpp"
#include "raster/choice/completed_light.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"
#include "shading/environment.hpp"

#include <algorithm>
#include <utility>

namespace halflit::engine {
namespace {

/// Replaces the ambient light by the environment.
Result<void> add_environment(Lighting& light, const LightRequest& request, const Settings& settings) {
    auto image = find_environment(request.environment);
    if (!image) return fail(image.error().code, "--env: " + image.error().message);
    const auto environment =
        make_environment(std::move(*image),
                         {request.environment_sun, static_cast<double>(request.environment_rotate_deg) * (kPi / 180.0),
                          settings.background_environment, request.may_want_reference || settings.shading.accuracy == Accuracy::reference});
    if (!environment) return tl::unexpected(environment.error());
    light.ambient = {};
    light.environment = *environment;
    return {};
}

/// The flags' coordinates are the file's; the scene may be drawn turned, elsewhere, and larger or smaller.
Light drawn(const GivenLight& given, const Placement& place) {
    Light light = given.light;
    light.direction_ws = to_float(turned_upright(to_double(light.direction_ws), place.up));
    if (kind_of(light.type).placed) light.position_ws = to_float(drawn_at(given.position, place));
    io::scale_lengths(light, place.scale);
    return light;
}

}  // namespace

void soften(Light& light, const Film& film) {
    if (light.shadow_radius > 0.0f) return;
    light.shadow_radius = kind_of(light.type).placed ? film.lamp_radius : film.sun_radius;
}

Result<void> begin_light(RenderJob& job, const LightRequest& request) {
    AutoOptions choice;
    Lighting light;
    if (request.scene_lights)
        light = job.scene();
    else
        choice.add_lights = !request.ambient_linear;
    if (!request.environment.empty())
        if (const auto added = add_environment(light, request, job.settings); !added) return added;
    choice.ambient_linear = request.ambient_linear;
    choice.exposure = request.exposure;
    choice.exposure_compensation_ev = request.exposure_compensation_ev;
    choice.studio = request.studio;
    if (choice.studio == StudioUse::for_dark && !request.lights.empty()) choice.studio = StudioUse::under_lights;
    if (request.ambient_linear && request.studio == StudioUse::for_dark) choice.studio = StudioUse::never;
    choice.studio_turn_rad = static_cast<double>(request.environment_rotate_deg) * (kPi / 180.0);
    const Placement& place = job.source.placement;
    for (const GivenLight& given : request.lights) light.lights.push_back(drawn(given, place));
    Film& film = job.film;
    film.scene_lights = request.scene_lights;
    film.sun_radius = light.sun_shadow_radius_rad = static_cast<float>(static_cast<double>(request.sun_size_deg) * (kPi / 180.0));
    film.lamp_radius = io::scaled(request.lamp_size, place.scale);
    for (Light& one : light.lights) soften(one, film);
    choice.light = std::move(light);
    film.choice = std::move(choice);
    return {};
}

bool relight(RenderJob& job, const Camera& camera) {
    const Film& film = job.film;
    Lighting& drawn = job.light;
    if (drawn.environment == film.choice.light->environment && drawn.lights.size() == film.choice.light->lights.size()) return false;
    const Lighting lit = raster::completed_light(job.scene(), film.bounds, camera, film.choice).light;
    drawn.ambient = lit.ambient;
    drawn.environment = lit.environment;
    for (std::size_t i = film.choice.light->lights.size(); i < lit.lights.size() && i < drawn.lights.size(); ++i) {
        drawn.lights[i] = lit.lights[i];
        soften(drawn.lights[i], film);
    }
    return true;
}

void follow_lights(RenderJob& job) {
    if (!job.film.scene_lights) return;
    const std::vector<Light>& lights = job.scene().lights;
    for (std::size_t i = 0; i < std::min(lights.size(), job.light.lights.size()); ++i) {
        job.light.lights[i] = lights[i];
        soften(job.light.lights[i], job.film);
    }
}

}  // namespace halflit::engine
