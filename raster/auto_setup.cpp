#include "halflit/auto_setup.hpp"

#include "raster/view/projection.hpp"
#include "shading/environment.hpp"
#include "shading/model/srgb.hpp"

#include <algorithm>

namespace halflit {
namespace {

constexpr double kLeastShare = 0.05;

/// Share of the camera's picture that the box around the scene fills; 1 if the box reaches behind the camera.
double share_of_picture(const Camera& camera, const Bounds& bounds) {
    const float aspect = camera.aspect > 0.0f ? camera.aspect : 1.0f;
    const Mat4 clip_from_world = raster::clip_from_world(camera, aspect);
    double low[2] = {1, 1}, high[2] = {-1, -1};
    for (int corner = 0; corner < 8; ++corner) {
        const Vec4f c = clip_from_world * Vec4f{corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                                                corner & 4 ? bounds.max.z : bounds.min.z, 1.0f};
        if (!(c.w > 0.0f)) return 1.0;
        const double at[2] = {static_cast<double>(c.x) / static_cast<double>(c.w), static_cast<double>(c.y) / static_cast<double>(c.w)};
        for (int axis = 0; axis < 2; ++axis) {
            low[axis] = std::min(low[axis], std::clamp(at[axis], -1.0, 1.0));
            high[axis] = std::max(high[axis], std::clamp(at[axis], -1.0, 1.0));
        }
    }
    return std::max(0.0, high[0] - low[0]) * std::max(0.0, high[1] - low[1]) / 4.0;
}

float environment_exposure(const Environment& environment) {
    const double level = environment_level(environment);
    if (environment.calibrated || !(level > 1e-18 && level < 1e18)) return 1.0f;
    return static_cast<float>(0.5 / level);
}

bool is_dark(const Ambient& ambient) { return ambient.sky_linear == Vec3f{} && ambient.ground_linear == Vec3f{}; }

/// Adds the light that the scene lacks. Returns the exposure.
float light_scene(Scene& scene, const Bounds& bounds, const Camera& camera, const AutoOptions& options) {
    if (scene.environment != nullptr) return environment_exposure(*scene.environment);
    const bool unknown_unit = !scene.calibrated && !scene.lights.empty();
    if (scene.lights.empty() && is_dark(scene.ambient) && options.add_lights) add_default_lights(scene, camera);
    if (options.ambient_linear)
        scene.ambient = {*options.ambient_linear, *options.ambient_linear};
    else if (unknown_unit && is_dark(scene.ambient))
        scene.ambient = soft_ambient(scene, bounds);
    return unknown_unit ? auto_exposure(scene, bounds) : 1.0f;
}

}  // namespace

Settings usual_settings() {
    const auto linear = [](int code) { return static_cast<float>(shading::linear_from_srgb(code / 255.0)); };
    Settings settings;
    settings.samples = 4;
    settings.background_linear = {linear(0x3a), linear(0x3f), linear(0x47), 1.0f};
    return settings;
}

const Camera* choose_camera(const Scene& scene, const Bounds& bounds) {
    if (scene.cameras.empty()) return nullptr;
    const Camera& first = scene.cameras.front();
    return bounds.empty || share_of_picture(first, bounds) >= kLeastShare ? &first : nullptr;
}

AutoSetup auto_setup(Scene& scene, const Bounds& bounds, int width, int height, const AutoOptions& options) {
    AutoSetup setup;
    const Camera* chosen = options.camera ? &*options.camera : options.frame ? nullptr : choose_camera(scene, bounds);
    setup.framed = chosen == nullptr;
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    setup.camera = chosen != nullptr ? *chosen : frame_scene(scene, bounds, aspect, options.view);
    setup.settings = usual_settings();
    const float exposure = light_scene(scene, bounds, setup.camera, options);
    setup.settings.exposure = options.exposure.value_or(exposure);
    return setup;
}

AutoSetup auto_setup(Scene& scene, int width, int height, const AutoOptions& options) {
    return auto_setup(scene, scene_bounds(scene), width, height, options);
}

}  // namespace halflit
