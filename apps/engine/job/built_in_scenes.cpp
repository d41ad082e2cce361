#include "apps/engine/job/built_in_scenes.hpp"

#include "apps/engine/request/values.hpp"
#include "halflit/shapes.hpp"
#include "raster/built_in/hall_of_lamps.hpp"
#include "sh/trig.hpp"

#include <string>

namespace halflit::engine {
namespace {

constexpr std::string_view kSpherePrefix = "sphere:", kLightsPrefix = "lights:", kEndless = ":endless";

Camera touching_camera(double radius) {
    constexpr double kFovDeg = 35.0;
    // The ray at half the field of view is tangent to the sphere: sin(fov / 2) = radius / distance.
    const double distance = radius / sin_cos(kFovDeg / 2 * (kPi / 180.0)).sin;
    Camera camera;
    camera.name = "front";
    camera.world_from_camera = translation({0, 0, static_cast<float>(distance)});
    camera.fov_y_rad = static_cast<float>(kFovDeg * (kPi / 180.0));
    camera.near_z = static_cast<float>((distance - radius) / 2);
    return camera;
}

Scene sphere_scene(std::int64_t triangles) {
    Scene scene;
    scene.meshes.push_back(make_sphere_of(1.0f, triangles));
    scene.meshes[0].material = 0;
    scene.instances.push_back({0, {}});
    Material clay;
    clay.name = "clay";
    clay.base_color = {0.8f, 0.75f, 0.7f, 1.0f};
    clay.metallic = 0.0f;
    clay.roughness = 0.6f;
    clay.lobe = Lobe::sloan(0.5f);
    scene.materials.push_back(clay);
    Light key, rim;
    key.direction_ws = normalize_or({-1, -1, -1}, {0, -1, 0});
    key.color_linear = {0.9f, 0.9f, 0.9f};
    rim.direction_ws = normalize_or({2, 0, -1}, {0, -1, 0});
    rim.color_linear = {0.1f, 0.15f, 0.25f};
    scene.lights = {key, rim};
    scene.cameras.push_back(touching_camera(1.0));
    return scene;
}

}  // namespace

bool is_built_in_name(std::string_view name) {
    return name == "demo" || name.starts_with(kSpherePrefix) || name.starts_with(kLightsPrefix);
}

Result<std::optional<Scene>> built_in_scene(std::string_view name) {
    if (name == "demo") return demo_scene();
    if (name.starts_with(kLightsPrefix)) {
        const bool endless = name.ends_with(kEndless);
        const std::string_view number =
            name.substr(kLightsPrefix.size(), name.size() - kLightsPrefix.size() - (endless ? kEndless.size() : 0));
        const auto lights = parse_int(number, 1, raster::kMostHallLights);
        if (!lights) return fail(ErrorCode::usage, std::string(name) + ": " + lights.error().message);
        return raster::lights_scene(static_cast<int>(*lights), !endless);
    }
    if (!name.starts_with(kSpherePrefix)) return std::nullopt;
    const auto triangles = parse_int(name.substr(kSpherePrefix.size()), 12, std::int64_t{1} << 26);
    if (!triangles) return fail(ErrorCode::usage, std::string(name) + ": " + triangles.error().message);
    return sphere_scene(*triangles);
}

}  // namespace halflit::engine
