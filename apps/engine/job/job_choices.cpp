#include "apps/engine/job/job_steps.hpp"

#include "apps/engine/request/camera_file.hpp"
#include "apps/io/files/text.hpp"
#include "raster/scene/prepared_data.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace halflit::engine {
namespace {

std::string_view reason_text(ViewReason reason) {
    constexpr std::pair<ViewReason, std::string_view> kTexts[] = {{ViewReason::flat, ", as it is flat"},
                                                                  {ViewReason::hollow, ", as it is open at the top"},
                                                                  {ViewReason::thin, ", as it is upright and thin"},
                                                                  {ViewReason::backs, ", as the usual side shows backs alone"}};
    for (const auto& [of, text] : kTexts)
        if (of == reason) return text;
    return "";
}

std::string camera_choice(const RenderJob& job, const RenderOptions& given) {
    const std::vector<Camera>& cameras = job.scene().cameras;
    if (job.film.file_camera >= 0) {
        const std::string& name = cameras[static_cast<std::size_t>(job.film.file_camera)].name;
        return "camera: the file's" + (name.empty() ? "" : ", " + name);
    }
    if (given.cameras) {
        const CameraFile& file = *given.cameras;
        const bool all = given.camera == kAllCameras;
        const std::string& name = all ? "" : file.cameras[find_camera(file, given.camera.value_or("")).value_or(0)].name;
        return "camera: " + (all ? "all" : name.empty() ? "one" : io::printable(name)) + " of " + file.path;
    }
    if (given.camera_orbit) return "camera: in the orbit " + given.camera_orbit->text;
    if (given.camera_position)
        return fmt::format("camera: at {},{},{}", given.camera_position->x, given.camera_position->y, given.camera_position->z);
    if (!given.film.views.empty()) return fmt::format("camera: the whole scene, {}, all sides at one scale", given.film.views.front().name);
    const ViewSettings view = job.film.view.value_or(front_view(job.scene(), given.view));
    const bool replaces = !cameras.empty() && !given.asks_for_frame();
    return fmt::format("camera: a view of the whole scene, azimuth {}, elevation {}{}{}", view.azimuth_deg, view.elevation_deg,
                       reason_text(job.film.reason),
                       replaces ? "; the file's shows the scene small or not at all (--camera 0: by it)" : "");
}

/// Grounds are not named: they are seen to be cut off.
void warn_of_left_out(RenderJob& job) {
    constexpr std::size_t kMostNamed = 5;
    const NameOfInstance name_of = names_of(job.source.parts);
    std::vector<std::string> named;
    std::set<std::pair<int, raster::LeftOutFor>> noted;
    const raster::FramedPart& framed = job.prepared->data().framed_part();
    const auto is_told = [](raster::LeftOutFor reason) { return reason == raster::LeftOutFor::far || reason == raster::LeftOutFor::shell; };
    const auto part_of = [&](int instance) { return job.source.parts->of_instance(static_cast<std::size_t>(instance)); };
    std::set<int> told, seen;  // parts; those of them of which a piece is framed
    for (const raster::LeftOut& one : framed.left_out)
        if (is_told(one.reason)) told.insert(part_of(one.instance));
    if (told.empty()) return;
    for (const int instance : framed.instances)
        if (told.count(part_of(instance)) > 0) seen.insert(part_of(instance));
    for (const auto& [instance, reason, partly] : framed.left_out) {
        if (!is_told(reason)) continue;
        const int part = part_of(instance);
        if (part >= 0 && !noted.emplace(part, reason).second) continue;
        const std::string name = name_of(static_cast<std::size_t>(instance));
        named.push_back(fmt::format("{}{}, {}", partly || seen.count(part) > 0 ? "a piece of " : "",
                                    name.empty() ? fmt::format("part {}", part + 1) : "'" + io::printable(name) + "'",
                                    reason == raster::LeftOutFor::far ? "far from all else" : "around all else"));
    }
    if (named.empty()) return;
    const std::size_t more = named.size() - std::min(named.size(), kMostNamed);
    named.resize(named.size() - more);
    std::string warning = "the view of the whole leaves out: " + joined(named, "; ") + (more > 0 ? fmt::format("; and {} more", more) : "");
    if (std::find(job.warnings.begin(), job.warnings.end(), warning) == job.warnings.end()) job.warnings.push_back(std::move(warning));
}

}  // namespace

void tell_choices(RenderJob& job, const RenderOptions& given) {
    if (job.film.framed && !given.kept_view) warn_of_left_out(job);
    job.choices.push_back(camera_choice(job, given));
    const std::size_t lights = job.light.all_lights().size(), added = job.light.lights.size() - job.film.choice.light->lights.size();
    job.choices.push_back(fmt::format("lights: {}{}{}{}", lights,
                                      added == 0        ? ""
                                      : added == lights ? ", added by default"
                                                        : fmt::format(", {} of them added by default", added),
                                      job.light.environment == nullptr ? ""
                                      : given.environment.empty()      ? ", and the environment studio"
                                                                       : ", and the environment " + given.environment,
                                      job.light.ambient.sky_linear == Vec3f{} ? "" : ", and ambient light"));
    job.choices.push_back(fmt::format("exposure: {}, {:+.2f} stops{}", job.settings.exposure, std::log2(double{job.settings.exposure}),
                                      given.exposure ? "" : ", chosen"));
    if (!given.background_linear && !given.settings.background_environment)
        job.choices.push_back(fmt::format("background: {}", job.settings.background_linear == usual_settings().background_linear
                                                                ? "dark grey"
                                                                : "light grey, as surfaces are dark"));
}

}  // namespace halflit::engine
