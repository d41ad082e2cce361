#include "halflit/scene.hpp"

#include "raster/built_in/studio_light.hpp"
#include "sh/fp_environment.hpp"
#include "sh/trig.hpp"
#include "shading/environment.hpp"

namespace halflit {
namespace {

/// Made once in a process.
std::shared_ptr<const shading::ImageLight> studio_light() {
    static const auto light = std::make_shared<const shading::ImageLight>(raster::studio_parts());
    return light;
}

std::shared_ptr<const shading::ImageLight> scaled_studio_light(float level) {
    shading::ImageLightParts parts = raster::studio_parts();
    for (float& value : parts.rgb) value *= level;
    for (Vec3d& coefficient : parts.radiance.c) coefficient = coefficient * static_cast<double>(level);
    const auto scale = [&](Vec3d& light) { light = light * static_cast<double>(level); };
    for (shading::LobeLight& light : parts.lobes) {
        for (Vec3d& bound : light.bounds->by_order) scale(bound);
        for (Vec3d& bound : light.errors->absolute) scale(bound);
        scale(light.errors->least), scale(light.bounds->beyond);
    }
    for (auto& value : parts.reflections.rgba)
        for (float& channel : value) channel *= level;
    return std::make_shared<const shading::ImageLight>(std::move(parts));
}

}  // namespace

std::shared_ptr<const Environment> studio_environment(const Camera& camera, double turn_rad, float level) {
    const FpEnvironment environment_of_host;
    // The way from the scene to the viewer; of a camera that looks straight down or up, the lower edge of its picture.
    const Mat4& m = camera.world_from_camera;
    const Vec4f back = m.c[2], up = m.c[1];
    const Vec3d level_back{back.x, 0, back.z}, level_up{up.x, 0, up.z};
    const bool steep = !(dot(level_back, level_back) > 1e-6 * dot(level_up, level_up));
    const Vec3d viewer = steep ? level_up * (back.y > 0.0f ? -1.0 : 1.0) : level_back;
    const double turn = angle_of(viewer.x, viewer.z) + turn_rad;
    const auto light = level == 1.0f ? studio_light() : scaled_studio_light(level);
    auto made = std::make_shared<Environment>(shading::make_environment(light, turn - turn == 0.0 ? turn : 0.0));
    const sh::EquirectView image = light->image();
    made->rgb.assign(image.rgb.begin(), image.rgb.end());
    made->width = image.width, made->height = image.height;
    made->calibrated = made->kept_light = true;
    made->studio_level = level;
    return made;
}

}  // namespace halflit
